//! From a scene as written to a program as played: checks that need the board, other layers, or pictures.

use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::{Header, Layer as WireLayer, RECORDS_MAX, Record, Region};

use super::excess;
use super::file::Scene;
use super::layer::{Above, Kind, Layer, Rectangle};
use super::log::Log;
use super::mistake::{CompileError, Mistake};
use super::pool::Pool;
use super::program::Program;
use super::reach::{Reach, carrier};

/// Fewest ticks of half a carrier period that a board takes.
const HALF_PERIOD_MIN_TICKS: f64 = 4.0;
/// Below this charge leaks through skin and the felt friction falls (arXiv 2409.18725), Hz.
const LEAKAGE_HZ: f64 = 250.0;
/// What a default peak limit allows above the peak that the rms limit needs, so that rounding never makes it the
/// tighter one.
const PEAK_MARGIN: f64 = 1.001;
/// A layer may leave the screen by this much before it is refused: millimetres round, mm.
const OFF_SCREEN_MM: f64 = 1e-6;
/// Total friction this close to natural, relative to it, is natural: `mu F_N` rounds.
const NATURAL_ROUNDING: f64 = 1e-6;
const MM: f64 = 1e-3;

/// Compiles a scene for boards with these limits and this many ticks a second.
///
/// # Example
///
/// ```no_run
/// use frixel::scene::{Scene, compile};
/// # fn play(limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel::scene::CompileError> {
/// let scene = Scene::load("scenes/brick.toml".as_ref())?;
/// let program = compile(&scene, limits, 40_000)?;
/// println!("{} layers, up to {} N", program.records.len(), program.reach.friction_max_n());
/// # Ok(())
/// # }
/// ```
pub fn compile(scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
    let mut log = Log::new(&scene.source);
    let program = assemble(scene, limits, tick_hz, &mut log);
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
    let mut pool = Pool::new(scene.source.folder().clone(), limits.bitmap_pool_bytes);
    let mut records = Vec::new();
    for layer in &scene.layers {
        records.extend(record(scene, layer, &header, &reach, &mut pool, log, &mut notes));
    }
    if records.len() < scene.layers.len() {
        return None;
    }
    let titles = scene.layers.iter().map(|layer| layer.title.clone()).collect();
    let mut program =
        Program { header, records, bitmaps: pool.into_bitmaps(), titles, reach, half_period_ticks, notes };
    if log.is_empty() {
        excess::check(scene, &mut program, log);
    }
    Some(program)
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
    let peak_per_rms = carrier(shape, half_period_s, limits).peak_per_rms();
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
        prediction: scene.prediction,
    }
}

/// The current into the worst-case electrode at the largest voltage, as the board budgets it.
fn check_current(scene: &Scene, limits: &BoardLimits, header: &Header, log: &mut Log) {
    let carrier = carrier(header.carrier, 0.5 / f64::from(header.carrier_hz), limits);
    let drive_v_peak = f64::from(header.voltage_max_v_rms) * carrier.peak_per_rms();
    let capacitance_f = f64::from(limits.electrode_capacitance_max_f);
    let current = carrier.electrode_current(capacitance_f, drive_v_peak);
    for (kind, found_a, board_a, cure) in [
        (
            "rms",
            current.a_rms,
            limits.current_max_a_rms,
            "`frequency_hz` under [carrier], or `voltage_max_v_rms` under [drive]",
        ),
        ("peak", current.a_peak, limits.current_max_a_peak, "`voltage_max_v_rms` under [drive]"),
    ] {
        if found_a > f64::from(board_a) {
            let mistake =
                Mistake::CurrentAboveBoard { kind, found_ma: found_a * 1e3, board_ma: f64::from(board_a) * 1e3, cure };
            log.add(scene.carrier.places.table(), mistake);
        }
    }
}

fn record(
    scene: &Scene,
    layer: &Layer,
    header: &Header,
    reach: &Reach,
    pool: &mut Pool,
    log: &mut Log,
    notes: &mut Vec<String>,
) -> Option<Record> {
    let electric = |friction_n| electric_n(layer.above, friction_n, reach.natural_friction_n);
    let mut place = layer.region;
    let wire_layer = match &layer.kind {
        Kind::Constant { friction_n } => WireLayer::Constant { electric_friction_n: electric(*friction_n) },
        Kind::Grating { wave, wavelength_mm, angle_deg, phase_deg, low_n, high_n } => {
            let (cycles_per_m_x, cycles_per_m_y) = wave_vector(*wavelength_mm, *angle_deg);
            WireLayer::Grating {
                wave: *wave,
                cycles_per_m_x,
                cycles_per_m_y,
                phase_turns: (phase_deg / 360.0).rem_euclid(1.0) as f32,
                trough_n: electric(*low_n),
                crest_n: electric(*high_n),
            }
        }
        Kind::Bitmap(bitmap) => {
            let (placed, crc32) = pool.place(layer, bitmap, log, notes)?;
            place = place.or(Some(placed));
            WireLayer::Bitmap {
                crc32,
                x_m: (bitmap.x_mm * MM) as f32,
                y_m: (bitmap.y_mm * MM) as f32,
                pitch_m: (bitmap.pitch_mm * MM) as f32,
                black_n: electric(bitmap.black_n),
                white_n: electric(bitmap.white_n),
            }
        }
    };
    let region = place.map_or(Region::Screen, |rectangle| {
        check_on_screen(scene, layer, rectangle, log);
        region(rectangle, header)
    });
    Some(Record { region, blend: layer.blend, gain: layer.gain as f32, layer: wire_layer })
}

/// Friction above natural, as the wire has it.
fn electric_n(above: Above, friction_n: f64, natural_friction_n: f64) -> f32 {
    let electric_n = match above {
        Above::Natural => friction_n,
        Above::Zero => friction_n - natural_friction_n,
    };
    let rounding = above == Above::Zero && electric_n.abs() <= NATURAL_ROUNDING * natural_friction_n;
    if rounding { 0.0 } else { electric_n as f32 }
}

/// Cycles per metre along x and y. Right angles are exact.
fn wave_vector(wavelength_mm: f64, angle_deg: f64) -> (f32, f32) {
    let cycles_per_m = 1.0 / (wavelength_mm * MM);
    let angle = angle_deg.to_radians();
    let exact = |part: f64| if part.abs() < 1e-12 { 0.0 } else { part };
    ((cycles_per_m * exact(libm::cos(angle))) as f32, (cycles_per_m * exact(libm::sin(angle))) as f32)
}

fn check_on_screen(scene: &Scene, layer: &Layer, rectangle: Rectangle, log: &mut Log) {
    let (screen_width_mm, screen_height_mm) = (scene.screen.width_mm, scene.screen.height_mm);
    let past = [
        ("left", -rectangle.x_mm),
        ("top", -rectangle.y_mm),
        ("right", rectangle.x_mm + rectangle.width_mm - screen_width_mm),
        ("bottom", rectangle.y_mm + rectangle.height_mm - screen_height_mm),
    ];
    let furthest = past.into_iter().max_by(|(_, one), (_, other)| one.total_cmp(other));
    if let Some((edge, beyond_mm)) = furthest.filter(|(_, beyond_mm)| *beyond_mm > OFF_SCREEN_MM) {
        let field = if layer.region.is_some() { "region" } else { "x_mm" };
        // Rounded to a micrometre, upwards, so that it is enough.
        let beyond_mm = (beyond_mm * 1e3 - 1e-6).ceil() / 1e3;
        let layer_title = layer.title.clone();
        log.add(
            layer.places.field(field),
            Mistake::OffScreen { layer: layer_title, edge, beyond_mm, screen_width_mm, screen_height_mm },
        );
    }
}

/// The whole screen where the rectangle covers it: that costs the board nothing.
fn region(rectangle: Rectangle, header: &Header) -> Region {
    let (x_m, width_m) = stretch(rectangle.x_mm, rectangle.width_mm, header.screen_width_m);
    let (y_m, height_m) = stretch(rectangle.y_mm, rectangle.height_mm, header.screen_height_m);
    if x_m <= 0.0 && y_m <= 0.0 && width_m >= header.screen_width_m && height_m >= header.screen_height_m {
        return Region::Screen;
    }
    Region::Rectangle { x_m, y_m, width_m, height_m }
}

/// Start and length of a stretch in metres, shortened by the few bits that rounding would put past the screen's end.
fn stretch(start_mm: f64, length_mm: f64, screen_m: f32) -> (f32, f32) {
    let start_m = ((start_mm * MM) as f32).max(0.0);
    let room_m = f64::from(screen_m) - f64::from(start_m);
    let rounded_m = room_m as f32;
    let room_m = if f64::from(rounded_m) > room_m { rounded_m.next_down() } else { rounded_m };
    (start_m, ((length_mm * MM) as f32).min(room_m))
}
