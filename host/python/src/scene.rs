//! Scenes: read, compiled, checked and drawn.

use std::collections::BTreeMap;
use std::path::PathBuf;

use frixel_felt::check::SceneCheck;
use frixel_felt::judge::Advice;
use frixel_felt::{FrictionMap, Preview};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_lab::input::{KeptFiles, SceneFolder};
use frixel_play::{board_costs, judge};
use frixel_scene::{CompileError, Program, Scene as ParsedScene, compile, compile_draft};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use super::error::{raised, scene_error};
use super::profile::ProfileText;
use super::signals::interruptible;

/// Pictures and profiles by their names in a scene.
pub(crate) type NamedFiles = BTreeMap<String, Vec<u8>>;

/// A scene without mistakes, compiled for the simulated board: clamped where a board refuses it.
#[pyclass(frozen, module = "frixel._frixel")]
pub(crate) struct Scene {
    parsed: ParsedScene,
    program: Program,
    files: NamedFiles,
    finger: Option<ProfileText>,
    screen: Option<ProfileText>,
}

impl Scene {
    /// The parsed scene, with its screen and finger.
    pub(crate) fn parsed(&self) -> &ParsedScene {
        &self.parsed
    }

    /// The finger in place of the scene's own.
    pub(crate) fn own_finger(&self) -> Option<&ProfileText> {
        self.finger.as_ref()
    }

    /// The screen in place of the scene's own.
    pub(crate) fn own_screen(&self) -> Option<&ProfileText> {
        self.screen.as_ref()
    }

    /// The compiled scene, clamped where a board refuses it.
    pub(crate) fn program(&self) -> &Program {
        &self.program
    }
}

#[pymethods]
impl Scene {
    /// Reads the bytes of a scene. `name` is its name in messages. The files that it names are taken from `files`, or
    /// else from `folder`.
    #[new]
    #[pyo3(signature = (text, name, folder, files, finger, screen))]
    fn new(
        py: Python<'_>,
        text: Vec<u8>,
        name: String,
        folder: Option<PathBuf>,
        files: NamedFiles,
        finger: Option<ProfileText>,
        screen: Option<ProfileText>,
    ) -> PyResult<Self> {
        let screen = screen.map(|screen| Ok::<_, PyErr>((screen.read(py)?, screen))).transpose()?;
        let finger = finger.map(|finger| Ok::<_, PyErr>((finger.read(py)?, finger))).transpose()?;
        let read = py.detach(|| {
            let files = KeptFiles::new(folder.map(SceneFolder), files);
            let mut parsed = ParsedScene::parse(&text, &name, &files)?;
            let (mut own_finger, mut own_screen) = (None, None);
            if let Some((screen, text)) = screen {
                parsed = parsed.with_screen(screen, text.name());
                own_screen = Some(text);
            }
            if let Some((finger, text)) = finger {
                parsed = parsed.with_finger(finger, text.name());
                own_finger = Some(text);
            }
            let board = RigConfig::default().board;
            let program = compile_draft(&parsed, &board.limits, board.tick_hz)?;
            let files = files.into_kept();
            Ok::<_, CompileError>(Self { parsed, program, files, finger: own_finger, screen: own_screen })
        });
        read.map_err(|error| scene_error(py, &error))
    }

    /// The files that were read with the scene.
    #[getter]
    fn files(&self) -> NamedFiles {
        self.files.clone()
    }

    /// Width and height of the screen, mm.
    #[getter]
    fn screen_mm(&self) -> (f64, f64) {
        (self.parsed.screen().width_mm, self.parsed.screen().height_mm)
    }

    /// Titles of the layers, from the bottom.
    #[getter]
    fn layers(&self) -> Vec<String> {
        self.program.titles.iter().map(ToString::to_string).collect()
    }

    /// Friction that the drive can reach on the finger, N: without voltage, and at the largest voltage.
    #[getter]
    fn reach_n(&self) -> (f64, f64) {
        (self.program.reach.friction_min_n(), self.program.reach.friction_max_n())
    }

    /// Reasons for which a board refuses the scene, one sentence each.
    #[getter]
    fn refusals(&self) -> Vec<String> {
        self.program.refusals().map(ToString::to_string).collect()
    }

    /// Reasons to doubt the scene, and what was rounded or clamped, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.program.warnings().chain(self.program.notes()).collect()
    }

    /// The output of `frixel check --json`.
    fn check(&self, py: Python<'_>, touch: Option<ProfileText>, with_board: bool) -> PyResult<String> {
        let touch = touch.map(|touch| touch.read(py)).transpose()?;
        let world = WorldOptions { touch, ..WorldOptions::default() };
        let rig = RigConfig::default();
        let program = py.detach(|| compile(&self.parsed, &rig.board.limits, rig.board.tick_hz));
        let program = program.map_err(|error| scene_error(py, &error))?;
        let json = interruptible(py, |goes_on| {
            let costs = board_costs(&program, &rig).map_err(|error| error.to_string())?;
            let judgement = judge(&program, &rig, &world, Advice::Sought, goes_on);
            let judgement = judgement.map_err(|error| error.to_string())?;
            let check = SceneCheck::of(&program, &rig.board.limits, &costs, judgement);
            Ok((if with_board { check.with_board(&program, rig.board.kind) } else { check }).to_json())
        })?;
        json.map_err(|error: String| raised(py, "PlayError", (error,)))
    }

    /// Electric friction over the screen, N, as rows from the top, within a size in pixels; and its caption.
    fn map<'py>(
        &self,
        py: Python<'py>,
        width: u32,
        height: u32,
        speed_m_per_s: f64,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Vec<String>)> {
        let FrictionMap { grid, mut parts_of_reach, caption } = interruptible(py, |goes_on| {
            FrictionMap::new(&self.program, &Preview { speed_m_per_s, map_max: (width, height) }, goes_on)
        })?;
        for part in &mut parts_of_reach {
            *part *= self.program.reach.electric_friction_max_n;
        }
        let map = PyArray1::from_vec(py, parts_of_reach).reshape([grid.height, grid.width])?;
        Ok((map, caption))
    }
}
