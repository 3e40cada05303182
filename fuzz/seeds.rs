//! Writes the compiled scenes of the gallery, those that have no pictures, into the folder that its argument names.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use frixel::scene_file;
use frixel_hil_sim::RigConfig;
use frixel_scene::compile;

fn main() -> Result<(), Box<dyn Error>> {
    let corpus = PathBuf::from(std::env::args_os().nth(1).ok_or("expected a folder")?);
    fs::create_dir_all(&corpus)?;
    let board = RigConfig::default().board;
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let program = compile(&scene_file::load(&path)?, &board.limits, board.tick_hz)?;
            if program.bitmaps.is_empty() {
                fs::write(corpus.join(path.file_stem().unwrap_or_default()), program.scene_bytes())?;
            }
        }
    }
    Ok(())
}
