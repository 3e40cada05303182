//! Writes the compiled scenes of the gallery, those that have no pictures, for the fuzzer to start from.

use std::error::Error;
use std::fs;
use std::path::Path;

use frixel::scene_file;
use frixel_hil_sim::RigConfig;
use frixel_scene::compile;
// Its instrumentation calls the fuzzer.
use libfuzzer_sys as _;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let board = RigConfig::default().board;
    for entry in fs::read_dir(root.join("../scenes"))? {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let program = compile(&scene_file::load(&path)?, &board.limits, board.tick_hz)?;
        for target in ["scene_bytes", "scene_load"].iter().filter(|_| program.bitmaps.is_empty()) {
            let folder = root.join("corpus").join(target);
            fs::create_dir_all(&folder)?;
            fs::write(folder.join(path.file_stem().unwrap_or_default()), program.scene_bytes())?;
        }
    }
    Ok(())
}
