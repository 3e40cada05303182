//! The limits of the drive, and the effect of raising them.

use frixel_layers::Header;
use frixel_model::{Carrier, TouchBound};
use frixel_wire::hello::BoardLimits;

use super::file::Scene;
use super::finger::{Elasticity, Evidence};
use super::log::Log;
use super::mistake::FitMistake;
use super::program::Program;
use super::reach::Reach;
use super::springs::SpringFit;
use super::warning::Warning;

/// Ratio of the default peak limit to the peak needed by the rms limit. It is above 1, so that rounding never makes the
/// peak limit the tighter one.
const PEAK_MARGIN: f64 = 1.001;

/// The peak voltage that a board allows at a carrier, in V, and the reason if the carrier lowers it.
fn board_v_peak(limits: &BoardLimits, carrier: &Carrier) -> (f64, &'static str) {
    let whole_v_peak = f64::from(limits.voltage_max_v_peak.min(limits.full_scale_v_peak));
    let touch_bound = TouchBound::behind(limits.series_resistance_ohm);
    let touch_v_peak = touch_bound.stated_v_peak(carrier.carrier_hz());
    if touch_v_peak < whole_v_peak {
        (touch_v_peak, " at this carrier (at most 0.7 mA through a bridged or thin coating)")
    } else {
        (whole_v_peak, "")
    }
}

/// The limits of the drive: the lowest of scene, screen and board.
pub(super) struct Voltage {
    pub(super) max_v_rms: f64,
    pub(super) max_v_peak: f64,
    pub(super) slew_v_per_us: f64,
    /// Crest factor of the carrier.
    peak_per_rms: f64,
    /// The largest rms voltage within limits that [drive] cannot change: those of screen, board and measurement.
    hard_max_v_rms: f64,
    /// The largest peak voltage of screen and board.
    hard_max_v_peak: f64,
}

impl Voltage {
    pub(super) fn of(scene: &Scene, limits: &BoardLimits, carrier: &Carrier, log: &mut Log) -> Self {
        let (drive, screen) = (&scene.drive, scene.screen());
        let (board_v_peak, why) = board_v_peak(limits, carrier);
        if let Some(found) = drive.voltage_max_v_peak.filter(|found| *found > board_v_peak) {
            log.add(
                drive.places.field("voltage_max_v_peak"),
                FitMistake::PeakAboveBoard { found, board: board_v_peak, why },
            );
        }
        let peak_per_rms = f64::from(carrier.peak_per_rms());
        let scene_max_v_rms = screen.voltage_max_v_rms.unwrap_or(f64::INFINITY).min(drive.voltage_max_v_rms);
        if scene_max_v_rms < drive.voltage_max_v_rms {
            let note = format!(
                "drive: the screen withstands {scene_max_v_rms} V rms, less than the {} V rms of the scene",
                drive.voltage_max_v_rms
            );
            log.note(drive.places.field("voltage_max_v_rms"), note);
        }
        let needed_v_peak = PEAK_MARGIN * peak_per_rms * scene_max_v_rms;
        let screen_v_peak = screen.voltage_max_v_peak.unwrap_or(f64::INFINITY);
        let max_v_peak = drive.voltage_max_v_peak.unwrap_or(needed_v_peak).min(screen_v_peak).min(board_v_peak);
        let max_v_rms = scene_max_v_rms.min(max_v_peak / peak_per_rms);
        if max_v_rms < scene_max_v_rms {
            let why = if max_v_peak >= board_v_peak { why } else { "" };
            // Without a peak voltage in the scene, its rms voltage seems to be driven; warn if it is not.
            if drive.voltage_max_v_peak.is_none() && drive.places.has("voltage_max_v_rms") {
                let whose = if max_v_peak >= board_v_peak { "board" } else { "screen" };
                log.warn(
                    drive.places.field("voltage_max_v_rms"),
                    Warning::RmsOutOfReach {
                        found: drive.voltage_max_v_rms,
                        whose,
                        max_v_peak,
                        why,
                        peak_per_rms,
                        max_v_rms,
                    },
                );
            } else {
                let note = format!(
                    "drive: {scene_max_v_rms} V rms would need {:.1} V peak; the limit of {max_v_peak} V peak{why} \
                     allows {max_v_rms:.1} V rms",
                    peak_per_rms * scene_max_v_rms,
                );
                log.note(drive.places.field("voltage_max_v_peak"), note);
            }
        }
        let slew_v_per_us = screen.slew_v_per_us.unwrap_or(f64::INFINITY).min(drive.slew_v_per_us);
        let hard_max_v_peak = screen_v_peak.min(board_v_peak);
        let measured_v_rms = match scene.finger().evidence {
            // A board refuses a scene that needs more.
            Evidence::Measured { voltage_max_v_rms, .. } => voltage_max_v_rms,
            _ => match &scene.finger().elasticity {
                Elasticity::Empirical(law) => law.voltage_max_v_rms(),
                Elasticity::WinklerFuss { .. } | Elasticity::Soft { .. } => f64::INFINITY,
            },
        };
        let screen_v_rms = screen.voltage_max_v_rms.unwrap_or(f64::INFINITY);
        let hard_max_v_rms = (hard_max_v_peak / peak_per_rms).min(screen_v_rms).min(measured_v_rms);
        Self { max_v_rms, max_v_peak, slew_v_per_us, peak_per_rms, hard_max_v_rms, hard_max_v_peak }
    }

    /// Limits the drive to the range of an empirical law, which is never extrapolated. A scene that asks for more is
    /// refused.
    pub(super) fn end_with_law(&mut self, scene: &Scene, log: &mut Log) {
        let Elasticity::Empirical(law) = &scene.finger().elasticity else { return };
        let measured_v_rms = law.voltage_max_v_rms();
        if self.max_v_rms > measured_v_rms {
            let (places, found_v_rms) = (&scene.drive.places, self.max_v_rms);
            let place = places.field("voltage_max_v_rms");
            if places.has("voltage_max_v_rms") {
                log.add(place, FitMistake::BeyondLaw { found_v_rms, measured_v_rms });
            } else {
                log.note(
                    place,
                    format!("drive: limited to {measured_v_rms} V rms, the largest measured voltage of this finger"),
                );
            }
            self.max_v_rms = measured_v_rms;
        }
    }

    /// Checks the current into the worst-case electrode at the largest voltage, and lowers the voltage to the board's
    /// current limits.
    pub(super) fn limit_current(&mut self, scene: &Scene, limits: &BoardLimits, carrier: &Carrier, log: &mut Log) {
        let drive_v_peak = self.max_v_rms as f32 * carrier.peak_per_rms();
        let current = carrier.electrode_current(limits.electrode_capacitance_max_f, drive_v_peak);
        let rms_cure = "`frequency_hz` under [carrier], or `voltage_max_v_rms` under [drive]";
        let mut factor = f64::INFINITY;
        for (kind, found_a, board_a, cure) in [
            ("rms", current.a_rms, limits.current_max_a_rms, rms_cure),
            ("peak", current.a_peak, limits.current_max_a_peak, "`voltage_max_v_rms` under [drive]"),
        ] {
            let (found_ma, board_ma) = (f64::from(found_a) * 1e3, f64::from(board_a) * 1e3);
            factor = factor.min(board_ma / found_ma);
            if found_a > board_a {
                log.add(scene.carrier.places.table(), FitMistake::CurrentAboveBoard { kind, found_ma, board_ma, cure });
            }
        }
        // Both currents are proportional to the voltage.
        self.hard_max_v_rms = self.hard_max_v_rms.min(self.max_v_rms * factor);
        self.max_v_rms *= factor.min(1.0);
    }

    /// The limits of [drive] to raise, with the smallest whole volts that reach an electric friction; empty if other
    /// limits prevent it. `program` is the compiled scene.
    pub(super) fn raised_for(&self, scene: &Scene, program: &Program, friction_n: f64) -> Vec<(&'static str, f64)> {
        let header = &program.header;
        let ripple = program.carrier.ripple();
        let reaches = |v_rms: f64| {
            let gap_m = f64::from(header.effective_gap_m);
            // A soft finger has other springs at another voltage.
            let springs =
                SpringFit::of(scene.finger(), gap_m, v_rms).ok().filter(|springs| springs.mistake().is_none())?;
            let stiffness_pa_per_m = springs.stiffness_pa_per_m as f32;
            let header = Header { voltage_max_v_rms: v_rms as f32, stiffness_pa_per_m, ..*header };
            let reach = Reach::of(&header, ripple).ok()?;
            Some(reach.electric_friction_max_n >= friction_n)
        };
        let (least, most) = (self.max_v_rms.ceil() as u32, self.hard_max_v_rms.floor() as u32);
        let reached_at = (least..=most).map(f64::from).find(|v_rms| reaches(*v_rms) == Some(true));
        let Some(v_rms) = reached_at else { return Vec::new() };
        let v_peak = (PEAK_MARGIN * self.peak_per_rms * v_rms).ceil().min(self.hard_max_v_peak);
        let drive = &scene.drive;
        [
            ("voltage_max_v_rms", v_rms, drive.voltage_max_v_rms),
            ("voltage_max_v_peak", v_peak, drive.voltage_max_v_peak.unwrap_or(f64::INFINITY)),
        ]
        .into_iter()
        .filter_map(|(field, to, from)| (to > from).then_some((field, to)))
        .collect()
    }
}
