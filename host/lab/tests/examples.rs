//! The examples, which `cargo test` builds beside the tests, run and print what they say.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An example that was built with this test program.
fn example(name: &str) -> PathBuf {
    let program = env::current_exe().unwrap();
    let folder = program.parent().and_then(Path::parent).unwrap().join("examples");
    let path = folder.join(format!("{name}{}", env::consts::EXE_SUFFIX));
    assert!(path.exists(), "{} is missing: run `cargo build --examples`", path.display());
    path
}

fn run(name: &str, arguments: &[&str]) -> Output {
    Command::new(example(name)).args(arguments).output().unwrap()
}

/// What an example prints when it succeeds.
fn printed(name: &str, arguments: &[&str]) -> String {
    let Output { status, stdout, stderr } = run(name, arguments);
    assert!(status.success(), "{name}: {}", String::from_utf8_lossy(&stderr));
    String::from_utf8(stdout).unwrap()
}

/// The number before `unit` in the line that begins with `start`.
fn number(text: &str, start: &str, unit: &str) -> f64 {
    let line = text
        .lines()
        .find(|line| line.starts_with(start) && line.contains(unit))
        .unwrap_or_else(|| panic!("no {start}: {text}"));
    let before = line.split(unit).next().unwrap();
    before.split_whitespace().last().and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("no number: {line}"))
}

#[test]
fn play() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/brick.toml");
    let text = printed("play", &[scene.to_str().unwrap()]);
    assert!(text.starts_with("3000 rows of a millisecond, 1 layers\n"), "{text}");
    // The example finger has 250 mN without voltage and 380 mN at the largest one.
    let (mean_mn, error_mn) = (number(&text, "", " mN felt"), number(&text, "", " mN rms"));
    assert!((250.0..380.0).contains(&mean_mn) && (1.0..60.0).contains(&error_mn), "{text}");

    for (arguments, sentence) in
        [(&[][..], "give the path of a scene"), (&["nowhere.toml"], "nowhere.toml: "), (&["Cargo.toml"], "Cargo.toml:")]
    {
        let Output { status, stderr, .. } = run("play", arguments);
        let said = String::from_utf8_lossy(&stderr);
        assert!(!status.success() && said.starts_with(sentence), "{arguments:?}: {said}");
    }
}

#[test]
fn stream() {
    let text = printed("stream", &[]);
    assert_eq!(
        text,
        "the closure gave 1000 samples, the board took 1000\n0 underruns, 0 gaps\ncommanded at most 350 mN\n"
    );
}

#[test]
fn live() {
    let text = printed("live", &[]);
    let commanded_mn = |t_s: &str| number(&text, &format!("{t_s} s  "), " mN commanded") as u32;
    let times = ["0.15", "0.35", "0.55", "0.62", "0.75"];
    // The finger has 250 mN without voltage: half a gain is half of what is above.
    assert_eq!(times.map(commanded_mn), [280, 340, 265, 340, 265], "{text}");
    assert_eq!(text.matches("Triggered").count(), 1, "{text}");
}

#[test]
fn touch() {
    let text = printed("touch", &[]);
    let error_mn = |name: &str| number(&text, name, " mN rms");
    assert!(error_mn("own:") > 0.0 && 2.0 * error_mn("own:") < error_mn("100:"), "{text}");
}
