//! Compilation of the scene of a request.

use frixel_control::Board;
use frixel_hil_sim::TouchConfig;
use frixel_scene::{CompileError, FingerProfile, Profile, Program, Scene, Screen, compile, compile_draft};
use frixel_wire::hello::BoardLimits;
use thiserror::Error;

use crate::request::{Request, RequestError};

/// Why a request cannot be compiled.
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
    Ok(request.touch.as_deref().map_or(Ok(TouchConfig::REALISTIC), given)?)
}

/// The scene of a request, with its finger and its screen.
fn scene(request: &Request) -> Result<Scene, ProgramError> {
    let mut scene = Scene::parse(request.scene()?, &request.entry, &request.files)?;
    if let Some(screen) = &request.screen {
        scene = scene.with_screen(given(screen)?, name_of::<Screen>(screen));
    }
    if let Some(finger) = &request.finger {
        scene = scene.with_finger(given(finger)?, name_of::<FingerProfile>(finger));
    }
    Ok(scene)
}

/// A profile of a request: the name of a bundled one, or the text of a file.
fn given<P: Profile>(given: &str) -> Result<P, CompileError> {
    P::bundled(given).map_or_else(|| P::parse(given, P::KIND.word()), Ok)
}

/// Its name in messages.
fn name_of<P: Profile>(given: &str) -> &str {
    if P::bundled(given).is_some() { given } else { P::KIND.word() }
}
