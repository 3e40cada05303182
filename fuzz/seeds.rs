//! Writes compiled scenes into the folder that its argument names.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use frixel_fuzz::compiled_scenes;

fn main() -> Result<(), Box<dyn Error>> {
    let corpus = PathBuf::from(std::env::args_os().nth(1).ok_or("expected a folder")?);
    fs::create_dir_all(&corpus)?;
    for (name, bytes) in compiled_scenes() {
        fs::write(corpus.join(name), bytes)?;
    }
    Ok(())
}
