//! The scene file as written, in the file's own units, each number within its range.

use std::collections::btree_map::{BTreeMap, Entry};

use frixel_layers::{Leader, Waveform};
use toml::de::DeTable;

use super::compile_error::CompileError;
use super::diagnostic::Diagnostic;
use super::fields::{Fields, PixelSize, all, parsed};
use super::file_kind::FileKind;
use super::files::{FileUnavailable, Files};
use super::finger::FingerProfile;
use super::grammar::KnownTable;
use super::include::{self, Gathered};
use super::layer::Layer;
use super::log::Log;
use super::mistake::FileMistake;
use super::pool::PictureFiles;
use super::scene_profiles::{self, ProfileSource, Profiles};
use super::screen::Screen;
use super::source::{Places, Source};
use super::stack::LayerTables;
use super::tables;

/// Version of the file format.
pub(super) const VERSION: u32 = 1;

/// A scene file that was read: all fields are known, have the right type and are in range. [`super::compile`] makes the
/// other checks.
///
/// Layers with mistakes in their own fields are absent; [`Self::mistakes`] lists their mistakes. The compiler can thus
/// check the remaining layers, and report all mistakes at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) source: Source,
    /// The mistakes of the absent layers.
    pub(super) mistakes: Vec<Diagnostic>,
    /// The pictures that layers name, including layers with mistakes, since these may be valid on another screen.
    pub(super) pictures: PictureFiles,
    pub(super) profiles: Profiles,
    pub(super) drive: Drive,
    pub(super) carrier: Carrier,
    pub(super) touch: Touch,
    pub(super) design: Option<Design>,
    pub(super) layers: Vec<Layer>,
}

/// `[drive]`
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drive {
    pub(super) voltage_max_v_rms: f64,
    pub(super) voltage_max_v_peak: Option<f64>,
    pub(super) slew_v_per_us: f64,
    pub(super) host_timeout_ms: f64,
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

/// Largest total size of a scene's pictures, bytes.
const PICTURES_MAX_BYTES: usize = 128 << 20;

/// Ratio of a pixel's sides from which on a design counts as stretched.
const STRETCH_MAX: f64 = 1.01;

/// `[design]`: the size in pixels of a drawing that covers the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Design {
    pub(super) width_px: f64,
    pub(super) height_px: f64,
    /// Offset of the table.
    place: usize,
}

impl Design {
    /// The size of a pixel on a screen.
    pub(super) fn pixel_on(self, screen: &Screen) -> PixelSize {
        PixelSize { width_mm: screen.width_mm / self.width_px, height_mm: screen.height_mm / self.height_px }
    }

    /// The note about a design whose proportions differ from the screen's, and its offset.
    pub(super) fn note_on(self, screen: &Screen) -> Option<(usize, String)> {
        let Self { width_px, height_px, place } = self;
        let PixelSize { width_mm, height_mm } = self.pixel_on(screen);
        let is_stretched = width_mm.max(height_mm) > STRETCH_MAX * width_mm.min(height_mm);
        is_stretched.then(|| {
            let note = format!(
                "design: {width_px} x {height_px} px are stretched to the screen's {} mm x {} mm: a pixel is \
                 {width_mm:.4} mm wide and {height_mm:.4} mm high",
                screen.width_mm, screen.height_mm
            );
            (place, note)
        })
    }
}

impl Scene {
    /// Reads the text or the bytes of a scene file. Messages call the file `name`. `files` provides the pictures,
    /// profiles and included files that it names.
    ///
    /// # Errors
    ///
    /// Fails if the file is of another kind or not TOML, or if a part outside the layers has mistakes.
    /// [`super::compile`] reports mistakes of layers together with its own.
    pub fn parse(text: impl AsRef<[u8]>, name: &str, files: &dyn Files) -> Result<Self, CompileError> {
        let text = FileKind::Scene.text(text.as_ref(), name)?;
        let Gathered { source, mistakes } = include::gather(name, text, files);
        let mut log = Log::new(&source);
        for (offset, mistake) in mistakes {
            log.add(offset, mistake);
        }
        let scene = read(files, &mut log);
        let mistakes = log.into_mistakes();
        let Some(mut scene) = scene else { return Err(CompileError::new(name.to_owned(), mistakes)) };
        scene.mistakes = mistakes;
        Ok(scene)
    }

    /// The scene with another finger, from a file or bundled profile called `name`.
    #[must_use]
    pub fn with_finger(mut self, finger: FingerProfile, name: &str) -> Self {
        self.profiles.finger = finger;
        self.profiles.finger_source = ProfileSource::Option(name.to_owned());
        self
    }

    /// The scene on another screen, from a file or bundled profile called `name`.
    #[must_use]
    pub fn with_screen(mut self, screen: Screen, name: &str) -> Self {
        self.profiles.screen = screen;
        self.profiles.screen_source = ProfileSource::Option(name.to_owned());
        if let Some(design) = self.design {
            // A pixel has another size on this screen.
            let mut log = Log::new(&self.source);
            let pixel_mm = design.pixel_on(&self.profiles.screen);
            if let Some(mut files) = files(&mut log) {
                let layer_tables = LayerTables::of(&mut files, &mut log);
                self.layers = layer_tables.read(Some(pixel_mm), &mut log);
            }
            self.mistakes = log.into_mistakes();
        }
        self
    }

    /// The mistakes of the layers that were not read, in the order of the file.
    pub fn mistakes(&self) -> &[Diagnostic] {
        &self.mistakes
    }

    /// The screen for which the scene is compiled.
    pub fn screen(&self) -> &Screen {
        &self.profiles.screen
    }

    /// Width and height of a pixel of the scene's design on its screen, mm.
    pub fn pixel_mm(&self) -> Option<[f64; 2]> {
        let PixelSize { width_mm, height_mm } = self.design?.pixel_on(self.screen());
        Some([width_mm, height_mm])
    }

    /// The finger for which the scene is compiled.
    pub fn finger(&self) -> &FingerProfile {
        &self.profiles.finger
    }
}

/// The known fields of the tables of a text.
pub(super) fn describe(text: &str) -> Vec<KnownTable> {
    let source = Source::new("", text);
    let mut log = Log::describing(&source);
    // Ignore mistakes in the text; only the known fields count.
    let _ = read(&BTreeMap::new(), &mut log);
    log.into_described()
}

/// The fields of the scene file and of the files that it includes; `None` if one of them is not TOML.
fn files<'s>(log: &mut Log<'s>) -> Option<Vec<Fields<'s>>> {
    let files = log.source().files().iter();
    let fields = files.map(|file| {
        let table = if file.start == 0 { "the scene" } else { &file.name };
        parsed(file, log).map(|values| Fields::new(table, file.start, values))
    });
    all(fields)
}

fn read(named: &dyn Files, log: &mut Log) -> Option<Scene> {
    let mut files = files(log)?;
    if !have_version(&mut files, log) {
        return None;
    }
    let (fields, included) = files.split_first_mut()?;
    // The included files have been read.
    let _ = fields.texts(log, &tables::scene::INCLUDE);
    for file in included {
        join(fields, file, log);
    }
    let profiles = scene_profiles::read(fields, named, log);
    let drive = drive(fields.table(log, &tables::scene::DRIVE).unwrap_or_else(|| absent("[drive]")), log);
    let carrier = carrier(fields.table(log, &tables::scene::CARRIER).unwrap_or_else(|| absent("[carrier]")), log);
    let touch = touch(fields.table(log, &tables::scene::TOUCH).unwrap_or_else(|| absent("[touch]")), log);
    let design = fields.table(log, &tables::scene::DESIGN).and_then(|fields| design(fields, log));
    let layer_tables = LayerTables::of(&mut files, log);
    for file in files {
        file.close(log);
    }
    // Mistakes outside the layers make the target friction of the layers unknown.
    let head_is_valid = log.mistakes() == 0;
    let example = Screen::example();
    let screen = profiles.as_ref().map_or(&example, |profiles| &profiles.screen);
    let pictures = pictures(layer_tables.pictures(log), named);
    let layers = layer_tables.read(design.map(|design| design.pixel_on(screen)), log);
    let profiles = profiles.filter(|_| head_is_valid)?;
    Some(Scene {
        source: log.source().clone(),
        mistakes: Vec::new(),
        pictures,
        profiles,
        drive,
        carrier,
        touch,
        design,
        layers,
    })
}

/// Reads the pictures of these names, except those that would exceed [`PICTURES_MAX_BYTES`].
fn pictures(names: Vec<String>, files: &dyn Files) -> PictureFiles {
    let mut pictures = PictureFiles::new();
    let mut left = PICTURES_MAX_BYTES;
    for name in names {
        let Entry::Vacant(entry) = pictures.entry(name) else { continue };
        let file = files.shared(entry.key()).and_then(|file| match left.checked_sub(file.bytes.len()) {
            Some(rest) => {
                left = rest;
                Ok(file)
            }
            None => Err(FileUnavailable::Unreadable {
                reason: format!("the pictures of a scene have at most {PICTURES_MAX_BYTES} bytes together"),
            }),
        });
        entry.insert(file);
    }
    pictures
}

/// Moves the tables of an included file into the scene, which may have each table only once.
fn join<'i>(scene: &mut Fields<'i>, file: &mut Fields<'i>, log: &mut Log) {
    use tables::scene::{CARRIER, DESIGN, DRIVE, FINGER, SCREEN, TOUCH};
    let _ = file.texts(log, &tables::scene::INCLUDE);
    for field in [SCREEN, FINGER, DRIVE, CARRIER, TOUCH, DESIGN] {
        scene.adopt(file, &field, log);
    }
}

fn design(mut fields: Fields, log: &mut Log) -> Option<Design> {
    let width_px = fields.number(log, &tables::design::WIDTH_PX);
    let height_px = fields.number(log, &tables::design::HEIGHT_PX);
    let place = fields.close(log).table();
    Some(Design { width_px: width_px?, height_px: height_px?, place })
}

/// Reports the files of another version, whose other fields are ignored, and returns whether there are none. A file
/// without a version is read, to report its other mistakes too.
fn have_version(files: &mut [Fields], log: &mut Log) -> bool {
    let mut all = true;
    for fields in files {
        let place = fields.place(tables::scene::VERSION.name);
        let found = fields.number(log, &tables::scene::VERSION);
        if let Some(found) = found.filter(|found| found.to_bits() != f64::from(VERSION).to_bits()) {
            log.add(place, FileMistake::Version { found });
            all = false;
        }
    }
    all
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
    let saturate = fields.flag(log, &tables::drive::SATURATE);
    let places = fields.close(log);
    Drive { voltage_max_v_rms, voltage_max_v_peak, slew_v_per_us, host_timeout_ms, saturate, places }
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
