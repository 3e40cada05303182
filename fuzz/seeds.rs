//! Writes the seed corpus of a target into a folder: `seeds TARGET FOLDER`.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use frixel_fuzz::{PLAN, compiled_scenes, recording_file};

fn main() -> Result<(), Box<dyn Error>> {
    let target = std::env::args().nth(1).ok_or("expected a target")?;
    let corpus = PathBuf::from(std::env::args_os().nth(2).ok_or("expected a folder")?);
    fs::create_dir_all(&corpus)?;
    let seeds = match target.as_str() {
        "parquet" => vec![("recording".to_owned(), recording_file())],
        "plan" => vec![("plan".to_owned(), PLAN.as_bytes().to_vec())],
        _ => compiled_scenes(),
    };
    for (name, bytes) in seeds {
        fs::write(corpus.join(name), bytes)?;
    }
    Ok(())
}
