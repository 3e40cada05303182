//! Compiles a scene to a program, and makes the checks that need the board's limits, other layers, or pictures.

use frixel_layers::{HALF_PERIOD_MIN_TICKS, Header, Record, electric_friction_max_n};
use frixel_model::{Carrier, Ripple};
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::RECORDS_MAX;

use super::compile_error::CompileError;
use super::excess;
use super::file::Scene;
use super::finger::Elasticity;
use super::layer::Layer;
use super::layer_map::LayerMap;
use super::log::Log;
use super::lower::Lowering;
use super::mistake::{FieldMistake, FitMistake};
use super::optimise::optimise;
use super::played_finger::PlayedFinger;
use super::pool::Pool;
use super::program::Program;
use super::reach::{Reach, ReachError};
use super::screen::EFFECTIVE_GAP_MAX_UM;
use super::springs::SpringFit;
use super::tick_cost;
use super::titles::{LayerNumber, LayerTitle};
use super::voltage::Voltage;
use super::warning;

/// Carrier frequency below which charge leaks through skin and felt friction falls, Hz (arXiv 2409.18725).
const LEAKAGE_HZ: f64 = 250.0;
const MM: f64 = 1e-3;
/// Factor by which a draft lowers its largest voltage until the contact is narrower than the finger.
const NARROWER: f32 = 0.98;
/// Least `voltage_max_v_rms` of a scene, V.
const VOLTAGE_MIN_V_RMS: f32 = 1.0;

/// Compiles a scene for boards with these limits and a tick rate in Hz.
///
/// # Example
///
/// ```no_run
/// use std::collections::BTreeMap;
///
/// use frixel_scene::{Scene, compile};
/// # use frixel_wire::hello::BoardLimits;
/// # fn play(text: &str, png: Vec<u8>, limits: &BoardLimits) -> Result<(), frixel_scene::CompileError> {
/// let pictures = BTreeMap::from([("textures/brick.png".to_owned(), png)]);
/// let scene = Scene::parse(text, "brick.toml", &pictures)?;
/// let program = compile(&scene, limits, 40_000)?;
/// println!("{} layers, up to {} N", program.records.len(), program.reach.friction_max_n());
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// Returns all mistakes for which a board with these limits refuses the scene, including [`Scene::mistakes`].
pub fn compile(scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
    let mut log = Log::resuming(&scene.source, &scene.mistakes).of_refusals();
    match assemble(scene, limits, tick_hz, &mut log) {
        Some(program) if log.mistakes() == 0 => Ok(Program { diagnostics: log.into_diagnostics(), ..program }),
        _ => log.finish(None),
    }
}

/// Compiles a scene for a preview or a simulator, even if a board would refuse it. [`Program::refusals`] lists the
/// reasons; if there are any, the program is a draft.
///
/// A draft stays within reach: friction, voltage, carrier and current are clamped, pictures are made coarser until they
/// fit the board, and regions are cut off at the screen's edge. Layers that cannot be played are absent, and listed in
/// a note. A tick may exceed the board's time limit.
///
/// # Errors
///
/// Fails if the file cannot be read ([`Scene::mistakes`] is not empty), or if finger and coating have no contact model.
///
/// # Example
///
/// ```
/// use std::collections::BTreeMap;
///
/// use frixel_scene::{Scene, compile, compile_draft};
/// # fn draw(limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel_scene::CompileError> {
/// let text = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n";
/// let scene = Scene::parse(text, "heavy.toml", &BTreeMap::new())?;
/// assert!(compile(&scene, limits, 40_000).is_err());
/// let draft = compile_draft(&scene, limits, 40_000)?;
/// assert!(draft.is_draft());
/// # Ok(())
/// # }
/// ```
pub fn compile_draft(scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
    let mut log = Log::resuming(&scene.source, &scene.mistakes).of_refusals();
    match assemble(scene, limits, tick_hz, &mut log) {
        Some(program) if scene.mistakes.is_empty() => Ok(Program { diagnostics: log.into_diagnostics(), ..program }),
        _ => log.finish(None),
    }
}

/// Compiles everything that is valid, and logs all mistakes. `None` if finger and coating have no contact model.
fn assemble(scene: &Scene, limits: &BoardLimits, tick_hz: u32, log: &mut Log) -> Option<Program> {
    // Consequences of another mistake are not reported.
    let mut unreported = log.scratch();
    let mistakes = log.mistakes();
    let half_period_ticks = half_period_ticks(scene, tick_hz, log);
    let half_period_s = f64::from(half_period_ticks) / f64::from(tick_hz);
    let is_carrier_valid = log.mistakes() == mistakes;
    let carrier = Carrier::new(scene.carrier.waveform, half_period_ticks, tick_hz, limits.edge_time_constant_s);
    let ripple = carrier.ripple();
    let mut voltage = Voltage::of(scene, limits, &carrier, log);
    let mistakes = log.mistakes();
    voltage.end_with_law(scene, log);
    voltage.limit_current(scene, limits, &carrier, if is_carrier_valid { &mut *log } else { &mut unreported });
    let effective_gap_um = effective_gap_um(scene, log);
    let contact = SpringFit::of(scene.finger(), effective_gap_um * 1e-6, voltage.max_v_rms);
    let springs = contact.map_err(|mistake| log.add(scene.profiles.place, mistake)).ok()?;
    let spring_mistake = springs.mistake();
    let are_springs_valid = spring_mistake.is_none();
    if let Some(mistake) = spring_mistake {
        log.add(scene.profiles.place, mistake);
    }
    if springs.deviation > 0.0 {
        let note = format!(
            "finger: played as springs of {:.4e} Pa/m, which differ from the soft finger by at most {:.1} % of the reach",
            springs.stiffness_pa_per_m,
            100.0 * springs.deviation
        );
        log.note(scene.profiles.place, note);
    }
    let mut header = header(scene, &voltage, &springs, effective_gap_um, half_period_s);
    let reach = reach(scene, &mut header, ripple, if are_springs_valid { &mut *log } else { &mut unreported })?;
    // The reach is unknown if drive, finger or coating have other mistakes.
    let is_reach_known = log.mistakes() == mistakes;
    let (finger, note) = PlayedFinger::of(&scene.profiles);
    if let Some(note) = note {
        log.note(scene.profiles.place, note);
    }
    if let Some((place, note)) = scene.design.and_then(|design| design.note_on(scene.screen())) {
        log.note(place, note);
    }
    let layers_max = RECORDS_MAX.min(usize::from(limits.records_max));
    if let Some(layer) = scene.layers.get(layers_max) {
        let has_copies = scene.layers.iter().any(|layer| layer.is_copy);
        let (count, max) = (scene.layers.len(), layers_max);
        log.add(layer.places.table(), FitMistake::TooManyLayers { count, has_copies, max });
    }
    let pool = Pool::new(scene, limits.bitmap_pool_bytes);
    let mut lowering = Lowering::new(scene, &header, &reach, tick_hz, pool, log);
    // Lower every layer, so that the mistakes of all are reported.
    let (layers, records) = records(scene.layers.iter().take(layers_max), &mut lowering);
    let (points, bitmaps) = lowering.finish();
    note_absent_layers(scene, &layers, log);
    let titles = layers.iter().map(|layer| layer.title.clone()).collect();
    let mut program = Program {
        header,
        records,
        points,
        bitmaps,
        titles,
        start: Vec::new(),
        patterns: Vec::new(),
        layers: LayerMap::default(),
        reach,
        carrier,
        finger,
        saturates: scene.drive.saturate,
        diagnostics: Vec::new(),
    };
    if is_reach_known {
        let raise = |friction_n| voltage.raised_for(scene, &program, friction_n);
        excess::check(scene, &layers, &raise, &program, log);
    }
    for warning in warning::of(scene, &program) {
        log.warn(scene.profiles.place, warning);
    }
    for (layer, warning) in warning::of_layers(&scene.layers) {
        log.warn_about(layer, warning);
    }
    optimise(&mut program, &layers, log);
    let Program { header, records, points, .. } = &mut program;
    if header.layers_fixed {
        header.electric_friction_max_n = electric_friction_max_n(header, records, points);
    }
    program.layers = layer_map(scene, &program.titles);
    tick_cost::check(scene, &program, limits.core, limits.tick_cycles_max, log);
    Some(program)
}

/// Returns the layers that can be played, and their records. A mistake of the first copy of a layer is not repeated for
/// the other copies.
fn records<'s>(layers: impl Iterator<Item = &'s Layer>, lowering: &mut Lowering) -> (Vec<&'s Layer>, Vec<Record>) {
    let mut mistaken = None;
    let record = |layer: &'s Layer| {
        let table = layer.places.table();
        if layer.is_copy && mistaken == Some(table) {
            return None;
        }
        let mistakes = lowering.mistakes();
        let record = lowering.record(layer);
        if lowering.mistakes() > mistakes {
            mistaken = Some(table);
        }
        record.map(|record| (layer, record))
    };
    layers.filter_map(record).unzip()
}

/// Notes the layers that are absent from a draft, at the first of them.
fn note_absent_layers(scene: &Scene, played: &[&Layer], log: &mut Log) {
    let is_absent = |layer: &&Layer| !played.iter().any(|other| std::ptr::eq(*other, *layer));
    let absent: Vec<&Layer> = scene.layers.iter().filter(is_absent).collect();
    if let [first, ..] = absent[..] {
        let titles: Vec<&str> = absent.iter().map(|layer| layer.title.as_str()).collect();
        log.note(first.places.table(), format!("absent from this draft: {}", titles.join(", ")));
    }
}

/// Maps layers to records. Only a live layer is certain to have its own record; others may have been merged.
fn layer_map(scene: &Scene, titles: &[LayerTitle]) -> LayerMap {
    let record = |number: LayerNumber| {
        (0..).zip(titles).find_map(|(record, title)| (title.number() == number).then_some(record))
    };
    let records = scene.layers.iter().map(|layer| record(layer.number()).filter(|_| layer.live));
    LayerMap::new(scene.layers.iter().zip(records))
}

/// Ticks in half a carrier period; of the fastest possible carrier if the scene's is too fast.
fn half_period_ticks(scene: &Scene, tick_hz: u32, log: &mut Log) -> u32 {
    let place = scene.carrier.places.field("frequency_hz");
    let found = scene.carrier.frequency_hz;
    let ticks = f64::from(tick_hz) / (2.0 * found);
    if ticks < f64::from(HALF_PERIOD_MIN_TICKS) {
        let max = f64::from(tick_hz) / f64::from(2 * HALF_PERIOD_MIN_TICKS);
        log.add(place, FitMistake::CarrierTooFast { found, tick_hz, max });
        return HALF_PERIOD_MIN_TICKS;
    }
    let whole = ticks.round();
    let rounded_hz = f64::from(tick_hz) / (2.0 * whole);
    if (rounded_hz - found).abs() > 1e-6 * found {
        let note = format!("carrier: {found} Hz rounded to {rounded_hz:.3} Hz, {whole} ticks for each half period");
        log.note(place, note);
    }
    if found < LEAKAGE_HZ {
        let note = format!(
            "carrier: {found} Hz is below {LEAKAGE_HZ} Hz, where charge leaks through skin and less friction is felt"
        );
        log.note(place, note);
    }
    whole as u32
}

/// Effective gap of coating and skin, limited to the board's largest.
fn effective_gap_um(scene: &Scene, log: &mut Log) -> f64 {
    let found = scene.screen().coating_gap_um() + scene.finger().skin_gap_um;
    if found > EFFECTIVE_GAP_MAX_UM {
        let (field, max) = ("thickness_um / permittivity + skin_gap_um, summed", EFFECTIVE_GAP_MAX_UM);
        log.add(scene.profiles.place, FieldMistake::OutOfRange { field, found, min: 0.0, max, unit: " um" });
    }
    found.min(EFFECTIVE_GAP_MAX_UM)
}

/// Returns the reach. Lowers the header's voltage until the contact is narrower than the finger.
fn reach(scene: &Scene, header: &mut Header, ripple: Ripple, log: &mut Log) -> Option<Reach> {
    let error = match Reach::of(header, ripple) {
        Ok(reach) => return Some(reach),
        Err(error) => error,
    };
    let mistake = match error {
        ReachError::TooWide { contact_m } => FitMistake::ContactWiderThanFinger {
            voltage_v_rms: f64::from(header.voltage_max_v_rms),
            contact_mm: contact_m / MM,
            radius_mm: scene.finger().radius_mm,
            gap_um: 1e6 * f64::from(header.effective_gap_m),
        },
        error => FitMistake::Model { reason: error.to_string() },
    };
    log.add(scene.profiles.place, mistake);
    let voltages_v_rms = std::iter::successors(Some(header.voltage_max_v_rms), |voltage| Some(NARROWER * voltage));
    voltages_v_rms.take_while(|voltage| *voltage >= VOLTAGE_MIN_V_RMS).find_map(|voltage_max_v_rms| {
        header.voltage_max_v_rms = voltage_max_v_rms;
        Reach::of(header, ripple).ok()
    })
}

fn header(scene: &Scene, voltage: &Voltage, springs: &SpringFit, effective_gap_um: f64, half_period_s: f64) -> Header {
    let (screen, finger, drive) = (scene.screen(), scene.finger(), &scene.drive);
    let law = match &finger.elasticity {
        Elasticity::Empirical(law) => law.of_scene(),
        Elasticity::WinklerFuss { .. } | Elasticity::Soft { .. } => None,
    };
    Header {
        screen_width_m: (screen.width_mm * MM) as f32,
        screen_height_m: (screen.height_mm * MM) as f32,
        finger_radius_m: (finger.radius_mm * MM) as f32,
        stiffness_pa_per_m: springs.stiffness_pa_per_m as f32,
        friction_coefficient: finger.friction_coefficient as f32,
        normal_load_n: finger.normal_load_n as f32,
        effective_gap_m: if law.is_some() { 0.0 } else { (effective_gap_um * 1e-6) as f32 },
        voltage_max_v_rms: voltage.max_v_rms as f32,
        voltage_max_v_peak: voltage.max_v_peak as f32,
        slew_v_per_s: (voltage.slew_v_per_us * 1e6) as f32,
        carrier_hz: (0.5 / half_period_s) as f32,
        host_timeout_s: (drive.host_timeout_ms * 1e-3) as f32,
        waveform: scene.carrier.waveform,
        prediction: scene.touch.prediction,
        leader: scene.touch.leader,
        layers_fixed: !scene.layers.iter().any(|layer| layer.live),
        electric_friction_max_n: None,
        law,
    }
}
