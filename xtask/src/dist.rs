//! `cargo xtask dist FOLDER`: what is handed on to those who have no checkout.
//!
//! | file | what |
//! |---|---|
//! | `frixel` | the command for Linux, static |
//! | `images/*.elf` | the firmware of each board; those of the emulated ones are what `frixel play --port qemu` and `--port pico` run |
//! | `images/pico-rig` | the emulator of the Pico, with the programs that `frixel play --port pico` runs by node |
//! | `frixel-*.whl` | the Python module, with its widget |
//! | `frixel-studio.html` | the page |
//! | `site` | the page, `<frixel-scene>` and the gallery for a web server |
//! | `docs`, `scenes`, `README.md` | what there is to read, and scenes to start from |
//! | `LICENCES.txt` | the licences of all of it; wheel and page have their own inside as well |
//! | `SHA256SUMS` | for `sha256sum --check` |
//!
//! No file names a folder of the build machine: [`machine_paths`] replaces them, and checks the files.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

use sha2::{Digest, Sha256};

use crate::command::{
    IMAGES_TARGET_FOLDER, M0_PLUS, M4F, M33, MUSL, bytes, cargo_in, copy, empty_folder, files_below, remove, root, run,
    target_folder, text, write,
};
use crate::licences::{self, Program};
use crate::{machine_paths, needs, pico_rig, studio};

/// Nearly as fast as `release`, and built in a third of the time.
const PROFILE: &str = "wheel";
/// The folder of the Python module.
const PYTHON: &str = "host/python";
/// Text in the wheel, beside frixel's own licences.
const WHEEL_LICENCES: &str = "LICENCES.txt";
/// Folders of the repository that are handed on as they are.
const READ: [&str; 2] = ["docs", "scenes"];
/// Program and file of each image, and what it is compiled from.
const IMAGES: [(&str, &str, Program); 6] = [
    ("board-mps2-an386", "board-mps2-an386.elf", board("firmware/board-mps2-an386", M4F, &[])),
    ("board-nucleo-g474re", "board-nucleo-g474re.elf", NUCLEO),
    ("bring-up", "board-nucleo-g474re-bring-up.elf", NUCLEO),
    ("self-test", "board-nucleo-g474re-self-test.elf", NUCLEO),
    ("board-pico", "board-pico-2.elf", board(PICO, M33, &[])),
    (
        "board-pico",
        "board-pico.elf",
        // As `hil-sim/src/emulated/image.rs` has them.
        board(PICO, M0_PLUS, &["--no-default-features", "--features", "rp2040,everything"]),
    ),
];
const NUCLEO: Program = board("firmware/board-nucleo-g474re", M4F, &[]);
const PICO: &str = "firmware/board-pico";
/// Folder of the emulator of the Pico among the images.
const PICO_RIG: &str = "pico-rig";
const COMMAND: Program = Program { folder: ".", package: Some("frixel"), target: Some(MUSL), features: &[] };
/// The Python module, and the page's module in its widget.
const WHEEL: [Program; 2] = [MODULE, licences::PAGE];
const MODULE: Program = Program { folder: ".", package: Some("frixel-python"), target: None, features: &[] };

/// The programs of a board's folder.
const fn board(folder: &'static str, target: &'static str, features: &'static [&'static str]) -> Program {
    Program { folder, package: None, target: Some(target), features }
}

/// Makes the folder, which must be empty or new.
pub(crate) fn make(folder: &str) -> Result<(), String> {
    let folder = empty_folder(folder)?;
    needs::require(&["python3", "node", "npm"])?;
    let images = folder.join("images");

    command(&folder)?;
    for (program, file, Program { folder: sources, target, features, .. }) in IMAGES {
        let target = target.unwrap_or_default();
        let build_args = ["build", "--release", "--locked", "--target-dir", IMAGES_TARGET_FOLDER, "--bin", program];
        let mut build = cargo_in(sources);
        build.args(build_args).args(["--target", target]).args(features);
        run(file, machine_paths::left_out(&mut build)?)?;
        let built = root().join(sources).join(IMAGES_TARGET_FOLDER).join(target).join("release").join(program);
        copy(&built, &images.join(file))?;
    }
    pico_rig::copy_to(&images.join(PICO_RIG))?;
    // The page's build also makes the widget in the wheel.
    copy(&studio::build()?, &folder.join("frixel-studio.html"))?;
    studio::build_site(&folder.join("site").to_string_lossy(), None)?;
    wheel(&folder)?;
    for name in READ {
        for file in files_below(&root().join(name))? {
            copy(&file, &folder.join(file.strip_prefix(root()).unwrap_or(&file)))?;
        }
    }
    copy(&root().join("README.md"), &folder.join("README.md"))?;
    let boards = IMAGES.map(|(_, _, program)| program);
    let programs = [[COMMAND].as_slice(), &WHEEL, &boards].concat();
    let emulator = format!("rp2040js, the emulator of the Pico (MIT)\n\n{}", pico_rig::licence()?);
    write(&folder.join("LICENCES.txt"), &licences::of_dist(&programs, emulator)?)?;
    for file in files_below(&folder)? {
        machine_paths::check(&file)?;
    }
    write(&folder.join("SHA256SUMS"), &checksums(&folder)?)?;
    println!("{}", folder.display());
    Ok(())
}

/// The command, without anything that a system has to bring.
fn command(folder: &Path) -> Result<(), String> {
    let build = ["build", "--locked", "--profile", PROFILE, "--target", MUSL, "--package", "frixel", "--bin", "frixel"];
    run("command", machine_paths::left_out(cargo_in(".").args(build))?)?;
    copy(&target_folder().join(MUSL).join(PROFILE).join("frixel"), &folder.join("frixel"))
}

/// The Python module, with the licences of what is in it.
fn wheel(folder: &Path) -> Result<(), String> {
    let environment = target_folder().join("dist-environment");
    let requirements = text(&root().join(PYTHON).join("requirements.txt"))?;
    let maturin = requirements.lines().find(|line| line.starts_with("maturin==")).ok_or("no maturin is required")?;
    run("virtual environment", Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    let installed = ["install", "--quiet", "--disable-pip-version-check", maturin];
    run("maturin", Command::new(environment.join("bin/pip")).args(installed))?;
    let licences = root().join(PYTHON).join(WHEEL_LICENCES);
    write(&licences, &licences::of_wheel(&WHEEL)?)?;
    let mut build = Command::new(environment.join("bin/maturin"));
    build.current_dir(root().join(PYTHON)).env("CARGO_TARGET_DIR", target_folder().join("python"));
    build.args(["build", "--quiet", "--locked", "--profile", PROFILE, "--out"]).arg(folder);
    let built = machine_paths::left_out(&mut build).and_then(|build| run("wheel", build));
    fs::remove_file(&licences).map_err(|error| format!("{}: {error}", licences.display()))?;
    built?;
    let mut files = files_below(folder)?.into_iter();
    let wheel = files.find(|file| file.extension().is_some_and(|kind| kind == "whl")).ok_or("no wheel was built")?;
    check_unpacked(&environment, &wheel)
}

/// Looks into a wheel, whose files are compressed.
fn check_unpacked(environment: &Path, wheel: &Path) -> Result<(), String> {
    let unpacked = environment.join("unpacked");
    remove(&unpacked)?;
    let mut python = Command::new(environment.join("bin/python"));
    run("wheel's files", python.args(["-m", "zipfile", "--extract"]).arg(wheel).arg(&unpacked))?;
    files_below(&unpacked)?.iter().try_for_each(|file| machine_paths::check(file))
}

/// The lines of `sha256sum` for every file of a folder.
fn checksums(folder: &Path) -> Result<String, String> {
    let mut lines = String::new();
    for path in files_below(folder)? {
        // Writing to a string cannot fail.
        for byte in Sha256::digest(bytes(&path)?) {
            let _ = write!(lines, "{byte:02x}");
        }
        let _ = writeln!(lines, "  {}", path.strip_prefix(folder).unwrap_or(&path).display());
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = root().join(format!("target/dist-of-test-{name}-{}", std::process::id()));
        fs::create_dir_all(folder.join("images")).unwrap();
        folder
    }

    #[test]
    fn checksums_are_those_of_sha256sum() {
        let folder = folder("sums");
        fs::write(folder.join("images/b"), "abc").unwrap();
        fs::write(folder.join("a"), "").unwrap();
        let sums = checksums(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        // The digest of nothing, and the example of FIPS 180-4.
        assert_eq!(
            sums,
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855  a\n\
             ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  images/b\n"
        );
    }

    #[test]
    fn a_folder_with_files_is_left_as_it_is() {
        let folder = folder("full");
        fs::write(folder.join("mine"), "").unwrap();
        let said = make(folder.to_str().unwrap()).unwrap_err();
        let left = files_below(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert!(said.ends_with("has files in it: give a new folder, or empty it"), "{said}");
        assert_eq!(left.len(), 1);
    }

    /// The licences of everything that is compiled into what is handed on, without building it.
    #[test]
    fn the_licences_name_crates_of_every_program() {
        let text = licences::of_dist(&[COMMAND, MODULE, licences::PAGE], String::new()).unwrap();
        for expected in
            ["clap 4", "pyo3 0", "heapless 0", "musl, the C library", "uplot ", "Apache License", "flatbuffers 25"]
        {
            assert!(text.contains(expected), "{expected}");
        }
        let wheel = licences::of_wheel(&WHEEL).unwrap();
        assert!(wheel.contains("pyo3 0") && !wheel.contains("clap 4") && !wheel.contains("musl, the C library"));
        assert!(wheel.contains("uplot "), "the scripts of the widget");
    }
}
