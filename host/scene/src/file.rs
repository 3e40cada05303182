//! The scene file as a person writes it, in the file's own units, each number within its range.

use frixel_layers::Leader;
use toml::de::DeTable;

use super::compile_error::CompileError;
use super::fields::Fields;
use super::grammar::KnownTable;
use super::kinds::Kind;
use super::layer::Layer;
use super::log::Log;
use super::mistake::Mistake;
use super::pictures::Pictures;
use super::pool::PictureBytes;
use super::source::{Places, Source};
use super::tables;

/// Version of the file format.
pub(super) const VERSION: u32 = 1;

/// Largest effective gap that a board takes.
const EFFECTIVE_GAP_MAX_UM: f64 = 10_000.0;

/// A scene file that was read: all fields are known, of the right type and in range. [`super::compile`] makes the other
/// checks.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) source: Source,
    pub(super) pictures: PictureBytes,
    pub(super) screen: Screen,
    pub(super) coating: Coating,
    pub(super) finger: Finger,
    pub(super) drive: Drive,
    pub(super) carrier: Carrier,
    pub(super) touch: Touch,
    pub(super) layers: Vec<Layer>,
}

/// `[screen]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screen {
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
}

/// `[coating]` or several `[[coating]]`, reduced to one effective gap.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coating {
    pub(super) effective_gap_um: f64,
    pub(super) places: Places,
}

/// `[finger]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Finger {
    pub(super) radius_mm: f64,
    pub(super) stiffness_pa_per_m: f64,
    pub(super) friction_coefficient: f64,
    pub(super) normal_load_n: f64,
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
    pub(super) shape: frixel_layers::Carrier,
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
    /// Reads the text of a scene file. Messages call the file `name`; `pictures` provides the pictures that the file
    /// names.
    pub fn parse(text: &str, name: &str, pictures: &dyn Pictures) -> Result<Self, CompileError> {
        let source = Source::new(name, text);
        let mut log = Log::new(&source);
        let scene = match DeTable::parse(text) {
            Ok(table) => read(Fields::new("the scene", 0, table.into_inner()), &mut log, &source),
            Err(error) => {
                log.add(error.span().map_or(0, |span| span.start), Mistake::Syntax(error.message().to_owned()));
                None
            }
        };
        let mut scene = log.finish(scene)?;
        scene.pictures = scene.picture_names().map(|name| (name.to_owned(), pictures.png(name))).collect();
        Ok(scene)
    }

    /// Reads the bytes of a scene file. See [`Self::parse`].
    pub fn parse_bytes(bytes: &[u8], name: &str, pictures: &dyn Pictures) -> Result<Self, CompileError> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::parse(text, name, pictures),
            Err(error) => {
                let text = String::from_utf8_lossy(bytes.get(..error.valid_up_to()).unwrap_or_default());
                let source = Source::new(name, &text);
                let mut log = Log::new(&source);
                log.add(error.valid_up_to(), Mistake::NotUtf8);
                log.finish(None)
            }
        }
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
        let _ = read(Fields::new("the scene", 0, table.into_inner()), &mut log, &source);
    }
    log.into_described()
}

fn read(mut fields: Fields, log: &mut Log, source: &Source) -> Option<Scene> {
    let version = fields.number(log, &tables::scene::VERSION);
    let screen = fields.table(log, &tables::scene::SCREEN).and_then(|fields| screen(fields, log));
    let coating = coating(&mut fields, log);
    let finger = fields.table(log, &tables::scene::FINGER).and_then(|fields| finger(fields, log));
    let drive = drive(fields.table(log, &tables::scene::DRIVE).unwrap_or_else(|| absent("[drive]")), log);
    let carrier = carrier(fields.table(log, &tables::scene::CARRIER).unwrap_or_else(|| absent("[carrier]")), log);
    let touch = touch(fields.table(log, &tables::scene::TOUCH).unwrap_or_else(|| absent("[touch]")), log);
    let tables = fields.tables(log, &tables::scene::LAYER).unwrap_or_default();
    // Read every layer, so that the mistakes of all are reported.
    let layers: Vec<Option<Layer>> = (1..).zip(tables).map(|(number, table)| Layer::read(table, number, log)).collect();
    let places = fields.close(log);
    if let Some(found) = version.filter(|found| found.total_cmp(&f64::from(VERSION)).is_ne()) {
        log.add(places.field("version"), Mistake::Version { found, expected: VERSION });
    }
    Some(Scene {
        source: source.clone(),
        pictures: PictureBytes::new(),
        screen: screen?,
        coating: coating?,
        finger: finger?,
        drive,
        carrier,
        touch,
        layers: layers.into_iter().collect::<Option<_>>()?,
    })
}

/// A table that is absent from the file: every field has its default.
fn absent(name: &str) -> Fields<'static> {
    Fields::new(name, 0, DeTable::new())
}

fn screen(mut fields: Fields, log: &mut Log) -> Option<Screen> {
    let width_mm = fields.number(log, &tables::screen::WIDTH_MM);
    let height_mm = fields.number(log, &tables::screen::HEIGHT_MM);
    fields.close(log);
    Some(Screen { width_mm: width_mm?, height_mm: height_mm? })
}

/// The effective gap of slabs in series: the sum of thickness over permittivity.
fn coating(scene: &mut Fields, log: &mut Log) -> Option<Coating> {
    let slabs = scene.tables(log, &tables::scene::COATING)?;
    if slabs.is_empty() {
        log.add(0, Mistake::MissingField { field: "coating", table: "the scene".to_owned() });
    }
    let mut effective_gap_um = Some(0.0);
    let mut first = None;
    for mut slab in slabs {
        let thickness_um = slab.number(log, &tables::coating::THICKNESS_UM);
        let permittivity = slab.number(log, &tables::coating::PERMITTIVITY);
        let gap_um = thickness_um.zip(permittivity).map(|(thickness_um, permittivity)| thickness_um / permittivity);
        effective_gap_um = effective_gap_um.zip(gap_um).map(|(sum, gap)| sum + gap);
        let places = slab.close(log);
        first.get_or_insert(places);
    }
    let (effective_gap_um, places) = effective_gap_um.zip(first)?;
    if effective_gap_um > EFFECTIVE_GAP_MAX_UM {
        let (field, max) = ("thickness_um / permittivity, summed", EFFECTIVE_GAP_MAX_UM);
        let mistake = Mistake::OutOfRange { field, found: effective_gap_um, min: 0.0, max, unit: " um" };
        log.add(places.table(), mistake);
    }
    Some(Coating { effective_gap_um, places })
}

fn finger(mut fields: Fields, log: &mut Log) -> Option<Finger> {
    let radius_mm = fields.number(log, &tables::finger::RADIUS_MM);
    let stiffness_pa_per_m = fields.number(log, &tables::finger::STIFFNESS_PA_PER_M);
    let friction_coefficient = fields.number(log, &tables::finger::FRICTION_COEFFICIENT);
    let normal_load_n = fields.number(log, &tables::finger::NORMAL_LOAD_N);
    fields.close(log);
    Some(Finger {
        radius_mm: radius_mm?,
        stiffness_pa_per_m: stiffness_pa_per_m?,
        friction_coefficient: friction_coefficient?,
        normal_load_n: normal_load_n?,
    })
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
    use frixel_layers::Carrier::{Sine, Square};
    let shape = fields.choice(log, &tables::carrier::SHAPE, &[("square", Square), ("sine", Sine)]).unwrap_or(Square);
    let frequency_hz = fields.number_or_default(log, &tables::carrier::FREQUENCY_HZ);
    let places = fields.close(log);
    Carrier { shape, frequency_hz, places }
}

fn touch(mut fields: Fields, log: &mut Log) -> Touch {
    let prediction = fields.flag(log, &tables::touch::PREDICTION);
    let rules = [("first", Leader::First), ("latest", Leader::Latest)];
    let leader = fields.choice(log, &tables::touch::LEADER, &rules).unwrap_or_default();
    fields.close(log);
    Touch { prediction, leader }
}
