//! Compiles a scene to a program, and makes the checks that need the board's limits, other layers, or pictures.

use frixel_layers::{Header, Record, electric_friction_max_n};
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::RECORDS_MAX;

use super::compile_error::CompileError;
use super::excess;
use super::file::Scene;
use super::layer_map::LayerMap;
use super::log::Log;
use super::lower::Lowering;
use super::mistake::Mistake;
use super::optimise::optimise;
use super::pool::Pool;
use super::program::Program;
use super::reach::{Reach, carrier};
use super::tick_cost;

/// Least number of ticks in half a carrier period that a board accepts.
const HALF_PERIOD_MIN_TICKS: f64 = 4.0;
/// Carrier frequency below which charge leaks through skin and felt friction falls, Hz (arXiv 2409.18725).
const LEAKAGE_HZ: f64 = 250.0;
/// Ratio of the default peak limit to the peak that the rms limit needs. It is above 1, so that rounding never makes
/// the peak limit the tighter one.
const PEAK_MARGIN: f64 = 1.001;
const MM: f64 = 1e-3;

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
pub fn compile(scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
    let mut log = Log::new(&scene.source);
    let program = assemble(scene, limits, tick_hz, &mut log);
    if let Some(program) = program.as_ref().filter(|_| log.is_empty()) {
        tick_cost::check(scene, program, limits.tick_cycles_max, &mut log);
    }
    log.finish(program)
}

fn assemble(scene: &Scene, limits: &BoardLimits, tick_hz: u32, log: &mut Log) -> Option<Program> {
    let mut notes = Vec::new();
    let half_period_ticks = half_period_ticks(scene, tick_hz, log, &mut notes)?;
    let header = header(scene, limits, f64::from(half_period_ticks) / f64::from(tick_hz), log, &mut notes);
    check_current(scene, limits, &header, log);
    let reach = match Reach::of(&header) {
        Ok(reach) => reach,
        Err(error) => {
            log.add(scene.coating.places.table(), Mistake::Model { reason: error.to_string() });
            return None;
        }
    };
    let layers_max = RECORDS_MAX.min(usize::from(limits.records_max));
    if let Some(layer) = scene.layers.get(layers_max) {
        log.add(layer.places.table(), Mistake::TooManyLayers { number: layers_max + 1, max: layers_max });
        return None;
    }
    let pool = Pool::new(&scene.pictures, limits.bitmap_pool_bytes);
    let mut lowering = Lowering::new(scene, &header, &reach, tick_hz, pool, log);
    // Lower every layer, so that the mistakes of all are reported.
    let records: Vec<Option<Record>> = scene.layers.iter().map(|layer| lowering.record(layer)).collect();
    let lowered = lowering.finish();
    notes.extend(lowered.notes);
    let titles = scene.layers.iter().map(|layer| layer.title.clone()).collect();
    let mut program = Program {
        header,
        records: records.into_iter().collect::<Option<_>>()?,
        points: lowered.points,
        bitmaps: lowered.bitmaps,
        titles,
        layers: LayerMap::default(),
        reach,
        half_period_ticks,
        notes,
        optimisations: lowered.optimisations,
    };
    if log.is_empty() {
        excess::check(scene, &mut program, log);
        let live: Vec<bool> = scene.layers.iter().map(|layer| layer.live).collect();
        optimise(&mut program, &live);
        let Program { header, records, points, .. } = &mut program;
        if header.layers_fixed {
            header.electric_friction_max_n = electric_friction_max_n(header, records, points);
        }
    }
    program.layers = layer_map(scene, &program.titles);
    Some(program)
}

/// Maps layers to records. Only a layer that the host may change is certain to have its own record; others may have
/// been merged.
fn layer_map(scene: &Scene, titles: &[String]) -> LayerMap {
    let record = |title: &String| (0..).zip(titles).find_map(|(record, other)| (other == title).then_some(record));
    let records = scene.layers.iter().map(|layer| record(&layer.title).filter(|_| layer.live));
    LayerMap::new(scene.layers.iter().zip(records).map(|(layer, record)| (layer.name.clone(), record)))
}

fn half_period_ticks(scene: &Scene, tick_hz: u32, log: &mut Log, notes: &mut Vec<String>) -> Option<u32> {
    let found = scene.carrier.frequency_hz;
    let ticks = f64::from(tick_hz) / (2.0 * found);
    if ticks < HALF_PERIOD_MIN_TICKS {
        let max = f64::from(tick_hz) / (2.0 * HALF_PERIOD_MIN_TICKS);
        log.add(scene.carrier.places.field("frequency_hz"), Mistake::CarrierTooFast { found, tick_hz, max });
        return None;
    }
    let whole = ticks.round();
    let rounded_hz = f64::from(tick_hz) / (2.0 * whole);
    if (rounded_hz - found).abs() > 1e-6 * found {
        notes.push(format!("carrier: {found} Hz rounded to {rounded_hz:.3} Hz, {whole} ticks for each half period"));
    }
    if found < LEAKAGE_HZ {
        notes.push(format!(
            "carrier: {found} Hz is below {LEAKAGE_HZ} Hz, where charge leaks through skin and less friction is felt"
        ));
    }
    Some(whole as u32)
}

fn header(scene: &Scene, limits: &BoardLimits, half_period_s: f64, log: &mut Log, notes: &mut Vec<String>) -> Header {
    let drive = &scene.drive;
    let shape = scene.carrier.shape;
    let board_v_peak = f64::from(limits.voltage_max_v_peak.min(limits.full_scale_v_peak));
    let peak_per_rms = f64::from(carrier(shape, half_period_s, limits).peak_per_rms());
    let v_peak = match drive.voltage_max_v_peak {
        Some(found) if found > board_v_peak => {
            log.add(drive.places.field("voltage_max_v_peak"), Mistake::PeakAboveBoard { found, board: board_v_peak });
            board_v_peak
        }
        Some(v_peak) => v_peak,
        None => (PEAK_MARGIN * peak_per_rms * drive.voltage_max_v_rms).min(board_v_peak),
    };
    let v_rms = drive.voltage_max_v_rms.min(v_peak / peak_per_rms);
    if v_rms < drive.voltage_max_v_rms {
        notes.push(format!(
            "drive: {} V rms would need {:.1} V peak; the limit of {v_peak} V peak allows {v_rms:.1} V rms",
            drive.voltage_max_v_rms,
            peak_per_rms * drive.voltage_max_v_rms
        ));
    }
    Header {
        screen_width_m: (scene.screen.width_mm * MM) as f32,
        screen_height_m: (scene.screen.height_mm * MM) as f32,
        finger_radius_m: (scene.finger.radius_mm * MM) as f32,
        stiffness_pa_per_m: scene.finger.stiffness_pa_per_m as f32,
        friction_coefficient: scene.finger.friction_coefficient as f32,
        normal_load_n: scene.finger.normal_load_n as f32,
        effective_gap_m: (scene.coating.effective_gap_um * 1e-6) as f32,
        voltage_max_v_rms: v_rms as f32,
        voltage_max_v_peak: v_peak as f32,
        slew_v_per_s: (drive.slew_v_per_us * 1e6) as f32,
        carrier_hz: (0.5 / half_period_s) as f32,
        host_timeout_s: (drive.host_timeout_ms * 1e-3) as f32,
        carrier: shape,
        autonomous: drive.autonomous,
        prediction: scene.touch.prediction,
        leader: scene.touch.leader,
        layers_fixed: !scene.layers.iter().any(|layer| layer.live),
        electric_friction_max_n: None,
    }
}

/// Checks the current into the worst-case electrode at the largest voltage against the board's limit.
fn check_current(scene: &Scene, limits: &BoardLimits, header: &Header, log: &mut Log) {
    let carrier = carrier(header.carrier, 0.5 / f64::from(header.carrier_hz), limits);
    let drive_v_peak = header.voltage_max_v_rms * carrier.peak_per_rms();
    let current = carrier.electrode_current(limits.electrode_capacitance_max_f, drive_v_peak);
    for (kind, found_a, board_a, cure) in [
        (
            "rms",
            current.a_rms,
            limits.current_max_a_rms,
            "`frequency_hz` under [carrier], or `voltage_max_v_rms` under [drive]",
        ),
        ("peak", current.a_peak, limits.current_max_a_peak, "`voltage_max_v_rms` under [drive]"),
    ] {
        if found_a > board_a {
            let mistake = Mistake::CurrentAboveBoard {
                kind,
                found_ma: f64::from(found_a) * 1e3,
                board_ma: f64::from(board_a) * 1e3,
                cure,
            };
            log.add(scene.carrier.places.table(), mistake);
        }
    }
}
