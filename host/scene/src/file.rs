//! The scene file as a person writes it, in the file's own units, each number within its range.

use std::collections::BTreeMap;

use frixel_layers::{Leader, Waveform};
use toml::de::DeTable;

use super::compile_error::{CompileError, Located};
use super::fields::{Fields, read_text_partly};
use super::files::Files;
use super::finger::FingerProfile;
use super::grammar::KnownTable;
use super::kinds::Kind;
use super::layer::Layer;
use super::log::Log;
use super::mistake::Mistake;
use super::pool::PictureBytes;
use super::profiles::{self, ProfileSource, Profiles};
use super::screen::Screen;
use super::source::{Places, Source};
use super::tables;

/// Version of the file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    /// Screen, coating and finger are embedded, and the coating contains the skin.
    One,
    /// Screen and finger are apart.
    Two,
}

/// A scene file that was read: all fields are known, of the right type and in range. [`super::compile`] makes the other
/// checks.
///
/// A layer whose own fields have mistakes is absent, and [`Self::mistakes`] has them, so that the compiler can check the
/// layers beside it, and report all mistakes at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) source: Source,
    /// The mistakes of the layers that are absent.
    pub(super) mistakes: Vec<Located>,
    pub(super) pictures: PictureBytes,
    pub(super) version: Version,
    /// Offset of the version, or of the file if it is absent.
    pub(super) version_place: usize,
    pub(super) profiles: Profiles,
    pub(super) drive: Drive,
    pub(super) carrier: Carrier,
    pub(super) touch: Touch,
    pub(super) layers: Vec<Layer>,
}

/// `[drive]`
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drive {
    pub(super) voltage_max_v_rms: f64,
    pub(super) voltage_max_v_peak: Option<f64>,
    pub(super) slew_v_per_us: f64,
    pub(super) host_timeout_ms: f64,
    pub(super) autonomous: bool,
    pub(super) saturate: bool,
    pub(super) places: Places,
}

/// `[carrier]`
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Carrier {
    pub(super) waveform: Waveform,
    pub(super) frequency_hz: f64,
    pub(super) places: Places,
}

/// `[touch]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touch {
    pub(super) prediction: bool,
    pub(super) leader: Leader,
}

impl Scene {
    /// Reads the text of a scene file. Messages call the file `name`; `files` provides the pictures and profiles that
    /// the file names.
    ///
    /// # Errors
    ///
    /// The text is not TOML, or a part of it outside of the layers has mistakes. Mistakes of layers alone do not fail
    /// here: [`super::compile`] reports them, with its own.
    pub fn parse(text: &str, name: &str, files: &dyn Files) -> Result<Self, CompileError> {
        let read = |fields: Fields, log: &mut Log, source: &Source| read(fields, files, log, source);
        let (scene, mistakes) = read_text_partly(text, name, "the scene", read);
        let Some(mut scene) = scene else { return Err(CompileError { file: name.to_owned(), mistakes }) };
        scene.mistakes = mistakes;
        scene.pictures = scene.picture_names().map(|name| (name.to_owned(), files.bytes(name))).collect();
        Ok(scene)
    }

    /// Reads the bytes of a scene file. See [`Self::parse`].
    pub fn parse_bytes(bytes: &[u8], name: &str, files: &dyn Files) -> Result<Self, CompileError> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::parse(text, name, files),
            Err(error) => {
                let text = String::from_utf8_lossy(bytes.get(..error.valid_up_to()).unwrap_or_default());
                let source = Source::new(name, &text);
                let mut log = Log::new(&source);
                log.add(error.valid_up_to(), Mistake::NotUtf8);
                log.finish(None)
            }
        }
    }

    /// The scene with another finger, from a file or bundled profile called `name`. A scene of version 1 is refused,
    /// because its coating contains the skin of its own finger.
    pub fn with_finger(mut self, finger: FingerProfile, name: &str) -> Result<Self, CompileError> {
        self.refuse_version_one("finger")?;
        self.profiles.finger = finger;
        self.profiles.finger_source = ProfileSource::Option(name.to_owned());
        Ok(self)
    }

    /// The scene on another screen, from a file or bundled profile called `name`. A scene of version 1 is refused,
    /// because its coating contains the skin of its finger.
    pub fn with_screen(mut self, screen: Screen, name: &str) -> Result<Self, CompileError> {
        self.refuse_version_one("screen")?;
        self.profiles.screen = screen;
        self.profiles.screen_source = ProfileSource::Option(name.to_owned());
        Ok(self)
    }

    /// The screen, for a finger other than the scene's own. A scene of version 1 is refused, because its coating contains
    /// the skin of its own finger.
    pub fn screen_without_skin(&self) -> Result<&Screen, CompileError> {
        self.refuse_version_one("finger")?;
        Ok(&self.profiles.screen)
    }

    fn refuse_version_one(&self, what: &'static str) -> Result<(), CompileError> {
        let mut log = Log::new(&self.source);
        if self.version == Version::One {
            let file = self.source.name().to_owned();
            log.add(self.version_place, Mistake::VersionOneProfile { what, file });
        }
        log.finish(Some(()))
    }

    /// The mistakes of the layers that were not read, in the order of the file.
    pub fn mistakes(&self) -> &[Located] {
        &self.mistakes
    }

    /// The screen that the scene is compiled for.
    pub fn screen(&self) -> &Screen {
        &self.profiles.screen
    }

    /// The finger that the scene is compiled for.
    pub fn finger(&self) -> &FingerProfile {
        &self.profiles.finger
    }

    /// The names of the pictures of the scene's layers, as written in the file.
    pub fn picture_names(&self) -> impl Iterator<Item = &str> {
        self.layers.iter().filter_map(|layer| match &layer.kind {
            Kind::Bitmap(bitmap) => Some(bitmap.picture.as_str()),
            _ => None,
        })
    }
}

/// The known fields of the tables of a text.
pub(super) fn describe(text: &str) -> Vec<KnownTable> {
    let source = Source::new("", text);
    let mut log = Log::describing(&source);
    if let Ok(table) = DeTable::parse(text) {
        // Ignore mistakes in the text; only the known fields count.
        let _ = read(Fields::new("the scene", 0, table.into_inner()), &BTreeMap::new(), &mut log, &source);
    }
    log.into_described()
}

fn read(mut fields: Fields, files: &dyn Files, log: &mut Log, source: &Source) -> Option<Scene> {
    let version_place = fields.place(tables::scene::VERSION.name);
    let version = version(&mut fields, log);
    let profiles = match version {
        Version::One => profiles::read_v1(&mut fields, log),
        Version::Two => profiles::read_v2(&mut fields, files, log),
    };
    let drive = drive(fields.table(log, &tables::scene::DRIVE).unwrap_or_else(|| absent("[drive]")), log);
    let carrier = carrier(fields.table(log, &tables::scene::CARRIER).unwrap_or_else(|| absent("[carrier]")), log);
    let touch = touch(fields.table(log, &tables::scene::TOUCH).unwrap_or_else(|| absent("[touch]")), log);
    let tables = fields.tables(log, &tables::scene::LAYER).unwrap_or_default();
    // Mistakes outside of the layers make it impossible to say what the layers ask for.
    fields.close(log);
    let head_is_valid = log.mistakes() == 0;
    // Read every layer, so that the mistakes of all are reported.
    let mut layers = Vec::new();
    for (number, table) in (1..).zip(tables) {
        let mistakes = log.mistakes();
        let copies = Layer::read(table, number, log);
        layers.extend(copies.filter(|_| log.mistakes() == mistakes).into_iter().flatten());
    }
    let profiles = profiles.filter(|_| head_is_valid)?;
    Some(Scene {
        source: source.clone(),
        mistakes: Vec::new(),
        pictures: PictureBytes::new(),
        version,
        version_place,
        profiles,
        drive,
        carrier,
        touch,
        layers,
    })
}

/// The version of the file. If it is absent or unknown, the version that the file's tables are of, so that the other
/// mistakes can be found.
fn version(fields: &mut Fields, log: &mut Log) -> Version {
    let place = fields.place(tables::scene::VERSION.name);
    let found = fields.number(log, &tables::scene::VERSION);
    match found {
        Some(1.0) => Version::One,
        Some(2.0) => Version::Two,
        found => {
            if let Some(found) = found {
                log.add(place, Mistake::Version { found });
            }
            if fields.has(tables::scene::COATING_V1.name) { Version::One } else { Version::Two }
        }
    }
}

/// A table that is absent from the file: every field has its default.
fn absent(name: &str) -> Fields<'static> {
    Fields::new(name, 0, DeTable::new())
}

fn drive(mut fields: Fields, log: &mut Log) -> Drive {
    let voltage_max_v_rms = fields.number_or_default(log, &tables::drive::VOLTAGE_MAX_V_RMS);
    let voltage_max_v_peak = fields.number(log, &tables::drive::VOLTAGE_MAX_V_PEAK);
    let slew_v_per_us = fields.number_or_default(log, &tables::drive::SLEW_V_PER_US);
    let host_timeout_ms = fields.number_or_default(log, &tables::drive::HOST_TIMEOUT_MS);
    let autonomous = fields.flag(log, &tables::drive::AUTONOMOUS);
    let saturate = fields.flag(log, &tables::drive::SATURATE);
    let places = fields.close(log);
    Drive { voltage_max_v_rms, voltage_max_v_peak, slew_v_per_us, host_timeout_ms, autonomous, saturate, places }
}

fn carrier(mut fields: Fields, log: &mut Log) -> Carrier {
    let waveforms = [("square", Waveform::Square), ("sine", Waveform::Sine)];
    let waveform = fields.choice(log, &tables::carrier::SHAPE, &waveforms).unwrap_or_default();
    let frequency_hz = fields.number_or_default(log, &tables::carrier::FREQUENCY_HZ);
    let places = fields.close(log);
    Carrier { waveform, frequency_hz, places }
}

fn touch(mut fields: Fields, log: &mut Log) -> Touch {
    let prediction = fields.flag(log, &tables::touch::PREDICTION);
    let rules = [("first", Leader::First), ("latest", Leader::Latest)];
    let leader = fields.choice(log, &tables::touch::LEADER, &rules).unwrap_or_default();
    fields.close(log);
    Touch { prediction, leader }
}
