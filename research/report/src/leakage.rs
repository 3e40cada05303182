//! The drive voltage that is just felt, over its frequency, with and without charge that leaks through the skin.
use core::f64::consts::TAU;
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, RGBColor};

use frixel_felt::perception::texture_threshold_n;
use frixel_hil_sim::{
    AmplifierConfig, Drive, FingerState, FingertipConfig, Point, Stroke, World, WorldConfig, example_finger,
};
use frixel_wire::dac_code::DacCode;

/// Frequencies of the voltage; friction has twice as many, for which thresholds are known up to 500 Hz.
const DRIVES_HZ: [f64; 9] = [15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 180.0, 240.0];
/// The highest frequency with a threshold, in Hz.
const FELT_MAX_HZ: f64 = 500.0;
const SPEED_M_PER_S: f64 = 0.05;
/// Amplitudes that are tried, in volts, peak, and how often their range is halved in its logarithm.
const VOLTAGES_V_PEAK: (f64, f64) = (1.0, 1_000.0);
const HALVINGS: u32 = 12;
/// Periods of the drive that are felt, after as many in which the lag settles.
const PERIODS: f64 = 3.0;
/// The two readings of what leaks, in Hz: none, and the corner that arXiv 2409.18725 names.
const LEAKAGES_HZ: [(f64, &str, RGBColor); 2] = [
    (0.0, "no leakage", PALETTE[0]),
    (FingertipConfig::REALISTIC.leakage_hz, "first-order leakage at 250 Hz", PALETTE[1]),
];
const WAVES: [(&str, Wave, Line, Mark); 2] =
    [("sine", |turns| (TAU * turns).sin(), Line::Solid, Mark::Disc), ("square", square, Line::Dashed, Mark::Square)];

/// A wave of amplitude 1 over turns.
type Wave = fn(f64) -> f64;

fn square(turns: f64) -> f64 {
    if turns.fract() < 0.5 { 1.0 } else { -1.0 }
}

/// A drive of one shape and frequency on the example finger.
struct Stimulus {
    wave: Wave,
    drive_hz: f64,
    leakage_hz: f64,
}

impl Stimulus {
    /// Electric friction, tick by tick, through amplifier, leakage, contact model and lag.
    fn felt_n(&self, amplitude_v_peak: f64) -> Result<Vec<f64>, Box<dyn Error>> {
        let full_scale_v_peak = VOLTAGES_V_PEAK.1;
        let config = WorldConfig {
            full_scale_v_peak,
            amplifier: AmplifierConfig { saturation_v_peak: full_scale_v_peak, ..AmplifierConfig::IDEAL },
            fingertip: FingertipConfig { leakage_hz: self.leakage_hz, ..FingertipConfig::IDEAL },
            ..WorldConfig::IDEAL
        };
        let start = Point { x_m: 0.01, y_m: 0.03 };
        let stroke = Stroke::constant_speed(start, Point { x_m: 0.11, ..start }, SPEED_M_PER_S)?;
        let mut world = World::new(config, stroke, 1)?;
        world.set_own_finger(example_finger()?);
        let tick_hz = f64::from(config.tick_hz);
        let ticks = (PERIODS * tick_hz / self.drive_hz).round() as u32;
        let mut felt = Vec::new();
        for tick in 0..2 * ticks {
            let time_s = f64::from(tick) / tick_hz;
            let x_m = start.x_m + SPEED_M_PER_S * time_s;
            world.place_finger(FingerState { x_m, y_m: start.y_m, speed_m_per_s: SPEED_M_PER_S });
            let part = amplitude_v_peak / full_scale_v_peak * (self.wave)(self.drive_hz * time_s);
            let dac_code = DacCode::from_bits((part * f64::from(i16::MAX)).round() as i16);
            let electric_friction_n = world.apply(Drive { dac_code, amplifier_enable: true }).electric_friction_n;
            if tick >= ticks {
                felt.push(electric_friction_n);
            }
        }
        Ok(felt)
    }

    /// The largest amplitude of a harmonic over its threshold: the person feels the strongest.
    fn over_threshold(&self, amplitude_v_peak: f64) -> Result<f64, Box<dyn Error>> {
        let felt = self.felt_n(amplitude_v_peak)?;
        let mut most = 0.0_f64;
        for harmonic in 1..=(FELT_MAX_HZ / (2.0 * self.drive_hz)) as u32 {
            let Some(threshold_n) = texture_threshold_n(2.0 * self.drive_hz * f64::from(harmonic)) else { continue };
            let turns = 2.0 * PERIODS * f64::from(harmonic) / felt.len() as f64;
            let (cosine, sine) = felt.iter().enumerate().fold((0.0, 0.0), |(cosine, sine), (tick, friction_n)| {
                let angle = TAU * turns * tick as f64;
                (cosine + friction_n * angle.cos(), sine + friction_n * angle.sin())
            });
            most = most.max(2.0 * cosine.hypot(sine) / felt.len() as f64 / threshold_n);
        }
        Ok(most)
    }

    /// The amplitude that is just felt, in volts, peak; not-a-number where the largest is not.
    fn threshold_v_peak(&self) -> Result<f64, Box<dyn Error>> {
        let (mut low, mut high) = VOLTAGES_V_PEAK;
        if self.over_threshold(high)? < 1.0 {
            return Ok(f64::NAN);
        }
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if self.over_threshold(middle)? < 1.0 { low = middle } else { high = middle }
        }
        Ok((low * high).sqrt())
    }
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let mut data = Data::new(["leakage_hz", "wave", "drive_hz", "threshold_v_peak"]);
    let mut panel = Panel::new(
        "Example finger, 50 mm/s",
        Axis::log("frequency of the voltage, Hz", 10.0..300.0),
        Axis::log("voltage that is just felt, V peak", 1.0..1e3),
    );
    for (leakage_hz, reading, colour) in LEAKAGES_HZ {
        for (name, wave, line, mark) in WAVES {
            let mut points = Vec::new();
            for drive_hz in DRIVES_HZ {
                let threshold_v_peak = Stimulus { wave, drive_hz, leakage_hz }.threshold_v_peak()?;
                data.row([leakage_hz.into(), name.into(), drive_hz.into(), threshold_v_peak.into()]);
                if threshold_v_peak.is_finite() {
                    points.push((drive_hz, threshold_v_peak));
                }
            }
            panel.add(&format!("{name}, {reading}"), Look { colour, line, mark }, points);
        }
    }
    Ok(Figure {
        name: "threshold-over-frequency",
        title: "Voltage that is just felt, over its frequency, with and without leakage".to_owned(),
        caption: vec![
            "A voltage goes through the simulator's amplifier, leakage (a first-order high-pass, or none), the contact model of \
             the example finger at 0.5 N and the lag of its friction at 50 mm/s. It is felt when a harmonic of the \
             friction reaches the threshold of touch at its frequency (Bolanowski 1988, 10.1121/1.397184, recalled; a \
             factor of 3 either way). Friction has twice the frequency of the voltage."
                .to_owned(),
            "Published: thresholds over 15 to 1920 Hz are U-shaped, and those of a square wave are below those of a sine \
             under 60 Hz, alike above (Vardar, Güçlü, Basdogan 2016, 10.1007/978-3-319-42321-0_18, abstract read; the \
             volts unread). With the leakage, a sine of 15 Hz needs more than any of these studies applied; without \
             it, a square wave has no friction that alternates but at its edges. Each reading contradicts a part."
                .to_owned(),
        ],
        chart: Chart::new(vec![panel], 1),
        csv: data.csv()?,
    })
}
