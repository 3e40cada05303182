//! The examples, which `cargo test` builds beside the tests, run and print what they say.

use std::env;
use std::path::Path;
use std::process::Command;

#[test]
fn the_examples_print_what_they_show() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/brick.toml");
    for (name, arguments, shown) in [
        ("play", vec![scene.to_str().unwrap()], "3000 rows of a millisecond, 1 layers\n"),
        ("stream", vec![], "0 underruns, 0 gaps\ncommanded at most 350 mN\n"),
        ("live", vec![], "Triggered"),
        ("touch", vec![], "own:"),
    ] {
        // Beside the folder of this program.
        let program = env::current_exe().unwrap();
        let folder = program.parent().and_then(Path::parent).unwrap().join("examples");
        let output = Command::new(folder.join(name)).args(arguments).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && text.contains(shown), "{name}: {text}");
    }
}
