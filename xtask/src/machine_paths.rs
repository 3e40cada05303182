//! Folders of the build machine, which must not appear in distributed files.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{absolute, bytes, root, text_of};

/// Divides the flags in the variable below, so that they may have spaces.
const BETWEEN_FLAGS: char = '\x1f';
/// Flags of the compiler, for all that cargo compiles for the target.
const FLAGS: &str = "CARGO_ENCODED_RUSTFLAGS";
/// Flags that cargo would ignore in favour of those above.
const OTHER_FLAGS: &str = "RUSTFLAGS";

/// The folders that a compiler writes into programs: that of the compiler with the standard library, that of the
/// crates, and the checkout. One that is in another comes behind it. Each has the name that programs have in its place.
fn machine_paths() -> Result<Vec<(PathBuf, &'static str)>, String> {
    let sysroot = text_of(Command::new("rustc").current_dir(root()).args(["--print", "sysroot"]))?;
    let cargo_home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
    let checkout = absolute(&root())?;
    let mut paths = vec![
        (sysroot.trim().into(), "rust"),
        (cargo_home.ok_or("neither CARGO_HOME nor a home folder is known")?, "cargo"),
        (checkout, "frixel"),
    ];
    paths.sort_by_key(|(path, _)| path.as_os_str().len());
    Ok(paths)
}

/// Makes a build, by cargo or by a program that calls it, write other names in place of the machine's paths.
pub(crate) fn left_out(build: &mut Command) -> Result<&mut Command, String> {
    // The compiler takes the last one that fits.
    let paths = machine_paths()?.into_iter();
    let flags: Vec<String> =
        paths.map(|(path, name)| format!("--remap-path-prefix={}={name}", path.display())).collect();
    Ok(build.env(FLAGS, flags.join(&BETWEEN_FLAGS.to_string())).env_remove(OTHER_FLAGS))
}

/// Fails if a file names one of the machine's paths.
pub(crate) fn check(file: &Path) -> Result<(), String> {
    let paths: Vec<PathBuf> = machine_paths()?.into_iter().map(|(path, _)| path).collect();
    match first_of(&paths, &bytes(file)?) {
        Some(found) => Err(format!("{} names a path of this machine: {found}", file.display())),
        None => Ok(()),
    }
}

/// The first of these paths in some bytes, with what follows it.
fn first_of(paths: &[PathBuf], bytes: &[u8]) -> Option<String> {
    let begins = |path: &PathBuf| {
        let path = path.as_os_str().as_encoded_bytes();
        bytes.windows(path.len().max(1)).position(|window| window == path)
    };
    let at = paths.iter().filter_map(begins).min()?;
    let text: Vec<u8> = bytes.get(at..)?.iter().copied().take_while(u8::is_ascii_graphic).take(200).collect();
    Some(String::from_utf8_lossy(&text).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_of_the_machine_is_found_within_bytes() {
        let paths = ["/home/ada/frixel", "/home/ada/.cargo"].map(PathBuf::from);
        let bytes = b"\x00\x7fELF/home/ada/.cargo/registry/src/clap/lib.rs\x00/home/ada/frixel/a.rs";
        assert_eq!(first_of(&paths, bytes).as_deref(), Some("/home/ada/.cargo/registry/src/clap/lib.rs"));
        assert_eq!(first_of(&paths, b"cargo/registry/src/clap/lib.rs /home/ada"), None);
    }

    #[test]
    fn the_checkout_and_the_crates_are_paths_of_the_machine() {
        let mut names: Vec<&str> = machine_paths().unwrap().into_iter().map(|(_, name)| name).collect();
        names.sort_unstable();
        assert_eq!(names, ["cargo", "frixel", "rust"]);
        assert!(check(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml").as_path()).is_ok());
    }
}
