//! `frixel demo`: the bundled brick texture on the simulator.

use std::path::Path;

use super::error::CommandError;
use super::profiles::ProfileArgs;
use super::{DemoArgs, PlayArgs, play};

/// The scene and its picture are embedded in the executable, so that the demo needs no files.
const SCENE: &str = include_str!("../../../../scenes/brick.toml");
const PICTURE: &[u8] = include_bytes!("../../../../scenes/textures/brick.png");

pub(super) fn run(args: &DemoArgs) -> Result<(), CommandError> {
    let scene = args.out.join("brick.toml");
    write(&scene, SCENE.as_bytes())?;
    write(&args.out.join("textures/brick.png"), PICTURE)?;
    play::run(&PlayArgs {
        scene: scene.clone(),
        profiles: ProfileArgs::default(),
        port: "sim".into(),
        stroke: None,
        seconds: None,
        out: args.out.clone(),
        json: false,
        seed: 1,
        csv_hz: 1000,
        arm: false,
        watch: false,
        stream: None,
        stream_hz: None,
    })?;
    println!("change a copy of {} and play that: frixel play COPY.toml", scene.display());
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(CommandError::writing(folder))?;
    }
    std::fs::write(path, bytes).map_err(CommandError::writing(path))
}
