//! From a request to a compiled scene.

use frixel_control::Board;
use frixel_hil_sim::TouchConfig;
use frixel_scene::{CompileError, FingerProfile, Program, Scene, Screen, compile, compile_draft, parse_touch_source};
use frixel_wire::hello::BoardLimits;
use thiserror::Error;

use crate::request::{Request, RequestError};

/// Why a request gives no program.
#[derive(Debug, Error)]
pub enum ProgramError {
    /// The request itself is wrong.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The scene or a profile has mistakes.
    #[error(transparent)]
    Compile(#[from] CompileError),
}

/// Compiles the scene of a request for boards with these limits and a tick rate in Hz, for the finger and the screen of
/// the request.
pub(crate) fn compiled(request: &Request, limits: &BoardLimits, tick_hz: u32) -> Result<Program, ProgramError> {
    Ok(compile(&scene(request)?, limits, tick_hz)?)
}

/// Compiles the scene of a request for maps and for the simulator in the page, which also show and play what a board
/// refuses. Returns the scene as well.
pub(crate) fn drafted(request: &Request) -> Result<(Scene, Program), ProgramError> {
    let scene = scene(request)?;
    let program = compile_draft(&scene, &Board::SIMULATOR.limits, Board::SIMULATOR.tick_hz)?;
    Ok((scene, program))
}

/// The simulated touch source of a request.
pub(crate) fn touch_source(request: &Request) -> Result<TouchConfig, ProgramError> {
    let Some(touch) = &request.touch else { return Ok(TouchConfig::REALISTIC) };
    match TouchConfig::bundled(touch) {
        Some(source) => Ok(source),
        None => Ok(parse_touch_source(touch, "touch source")?),
    }
}

/// The scene of a request, with its finger and its screen.
fn scene(request: &Request) -> Result<Scene, ProgramError> {
    let mut scene = Scene::parse_bytes(request.scene()?, &request.entry, &request.files)?;
    if let Some(screen) = &request.screen {
        scene = match Screen::bundled(screen) {
            Some(profile) => scene.with_screen(profile, screen),
            None => scene.with_screen(Screen::parse(screen, "screen")?, "screen"),
        };
    }
    if let Some(finger) = &request.finger {
        scene = match FingerProfile::bundled(finger) {
            Some(profile) => scene.with_finger(profile, finger),
            None => scene.with_finger(FingerProfile::parse(finger, "finger")?, "finger"),
        };
    }
    Ok(scene)
}
