//! Writes the seed corpus of each target to `FOLDER/TARGET`, and prints the targets with their numbers of inputs:
//! `seeds FOLDER`.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use frixel_fuzz::TARGETS;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("expected a folder")?);
    for target in TARGETS {
        let corpus = folder.join(target.name);
        fs::create_dir_all(&corpus)?;
        for (name, bytes) in (target.seeds)() {
            fs::write(corpus.join(name), bytes)?;
        }
        println!("{} {}", target.name, target.inputs);
    }
    Ok(())
}
