//! `frixel board safety`: the current through a finger on an electrode, by coating, voltage and carrier frequency.

use std::fmt::Write;

use anyhow::Result;
use clap::Args;
use frixel_hil_sim::Board;
use frixel_layers::HALF_PERIOD_MIN_TICKS;
use frixel_model::{
    Carrier, Coating, SINGLE_FAULT_CURRENT_MAX_A_PEAK, TOUCH_CURRENT_MAX_A_PEAK, TouchBound, TouchPath,
    VACUUM_PERMITTIVITY_F_PER_M, Waveform,
};
use frixel_scene::Screen;
use frixel_session::store::{LimitsError, RAIL_MAX, check_touched_board};

use crate::commands::argument;
use crate::commands::real_board::{behind, until_measured};
use crate::commands::terminal::print;
use crate::scene_file;

/// Largest contact of a fingertip, m2: that of the boards' worst-case electrode (assumed).
const CONTACT_M2: f64 = 2e-4;
/// A scratch, Ohm: a moist fingertip on bare metal through a scratch of some square millimetres (assumed).
const SCRATCH_OHM: f64 = 10e3;
/// The gap between a fingertip and the electrode, F (assumed).
const GAP_F: f64 = 150e-12;
/// Return paths of the finger's current (capacitances assumed).
const RETURN_PATHS: [(&str, ReturnPath); 3] = [
    ("return contact through 100 kOhm", ReturnPath::Contact(100e3)),
    ("no contact, the common isolated: 40 pF", ReturnPath::Air(40e-12)),
    ("no contact, the common on earth: the body's 150 pF", ReturnPath::Air(150e-12)),
];
/// Carriers of the tables, Hz: the slowest, the usual one and the fastest among them.
const CARRIERS_HZ: [f64; 6] = [125.0, 250.0, 500.0, 1_000.0, 2_000.0, 5_000.0];
/// Values per decade of E96, the series of 1 % resistors.
const E96: u32 = 96;
/// Decades of each of two equal series resistors, Ohm.
const SERIES_DECADES_OHM: [f64; 3] = [1e3, 1e4, 1e5];

#[derive(Debug, Args)]
pub(in crate::commands) struct SafetyArgs {
    /// The board whose limits and series resistance apply.
    #[arg(long, value_name = "NAME", default_value = Board::NAMED[0].0, value_parser = argument::board())]
    board: Board,
    /// Resistance between amplifier and electrode in place of the board's, kOhm.
    #[arg(long, value_name = "KOHM", value_parser = argument::positive, allow_negative_numbers = true)]
    series_kohm: Option<f64>,
    /// The screen whose coating is touched: a screen's file, or `example`.
    #[arg(long, value_name = "NAME|FILE", default_value = "example")]
    screen: String,
    /// The voltage for which to find the least series resistance, V rms.
    #[arg(long, value_name = "V", default_value_t = 150.0, value_parser = argument::positive, allow_negative_numbers = true)]
    voltage_v_rms: f64,
}

pub(super) fn run(args: &SafetyArgs) -> Result<()> {
    let gap_m = scene_file::profile::<Screen>(&args.screen)?.coating_gap_m();
    let board = behind(args.board, args.series_kohm)?;
    let series_ohm = f64::from(board.limits.series_resistance_ohm);
    let table = Table { board, series_ohm, capacitance_f: VACUUM_PERMITTIVITY_F_PER_M * CONTACT_M2 / gap_m };
    print(format!(
        "{}\n{}\n{}\n{}\n{}",
        table.assumptions(args),
        table.currents(),
        table.faults(),
        table.resistances(args.voltage_v_rms),
        table.return_paths(),
    ))
}

/// Inputs of the tables.
struct Table {
    board: Board,
    series_ohm: f64,
    /// Capacitance of the screen's coating to a fingertip, F.
    capacitance_f: f64,
}

impl Table {
    fn path(&self, coating: Coating) -> TouchPath {
        TouchPath { series_ohm: self.series_ohm, coating }
    }

    fn bound_v_peak(&self, carrier_hz: f64) -> f64 {
        TouchBound::behind(self.series_ohm as f32).stated_v_peak(carrier_hz as f32)
    }

    fn assumptions(&self, args: &SafetyArgs) -> String {
        let Self { board, series_ohm, capacitance_f } = self;
        let limits = &board.limits;
        let until_measured = until_measured(board).map_or_else(String::new, |said| format!("; {said}"));
        let capacitance_max_f = f64::from(limits.electrode_capacitance_max_f);
        // A hundredth is within the error of a capacitance meter.
        let too_thin = if *capacitance_f > 1.01 * capacitance_max_f {
            format!(
                ", above the {:.2} nF of the board's edges: it fails the coating test (docs/board/safety.md)",
                1e9 * capacitance_max_f
            )
        } else {
            String::new()
        };
        [
            ("board", format!("{}, at most {} V peak{until_measured}", board.kind, limits.voltage_max_v_peak)),
            ("series", format!("{} kOhm between amplifier and electrode", 1e-3 * series_ohm)),
            ("screen", format!("{}: {:.2} nF to a fingertip of 2 cm2{too_thin}", args.screen, 1e9 * capacitance_f)),
            (
                "person",
                "500 Ohm, and 1.5 kOhm beside 0.22 uF for the skin; currents are weighted for perception and reaction \
                 (IEC 60990:2016, Fig. 4, unread), and the return path has no resistance"
                    .to_owned(),
            ),
            (
                "allowed",
                format!(
                    "{:.1} mA peak in normal use (IEC 61010-1:2010, 6.3.1, unread), {:.0} mA peak in a single-fault \
                     condition (6.3.2, unread)",
                    1e3 * TOUCH_CURRENT_MAX_A_PEAK,
                    1e3 * SINGLE_FAULT_CURRENT_MAX_A_PEAK
                ),
            ),
            (
                "bound",
                "the largest peak voltage that passes no more than that, for any coating, thin or bridged, and any \
                 envelope; the board refuses a scene above it, or above its own limit in the first line"
                    .to_owned(),
            ),
        ]
        .iter()
        .fold(String::new(), |text, (name, value)| text + &format!("{name:8} {value}\n"))
    }

    fn check_built(&self, series_ohm: f64) -> Result<(), LimitsError> {
        check_touched_board(&self.board.behind(series_ohm as f32).limits)
    }

    /// Carriers that the board can have, Hz.
    fn carriers_hz(&self) -> impl Iterator<Item = f64> {
        let fastest_hz = f64::from(self.board.tick_hz) / f64::from(2 * HALF_PERIOD_MIN_TICKS);
        CARRIERS_HZ.into_iter().filter(move |carrier_hz| *carrier_hz <= fastest_hz)
    }

    /// Currents at the bound, and at the board's largest voltage.
    fn currents(&self) -> String {
        let intact = Coating::Intact { capacitance_f: self.capacitance_f };
        let scratched = Coating::Scratched { capacitance_f: self.capacitance_f, leak_ohm: SCRATCH_OHM };
        let mut text = String::from(
            "Weighted current, mA peak: a steady square carrier, and the worst envelope\n carrier     drive       intact    \
             scratched    bridged      worst coating\n",
        );
        let largest_v_peak = f64::from(self.board.limits.voltage_max_v_peak);
        for carrier_hz in self.carriers_hz() {
            let worst = TouchPath::worst_coating(self.series_ohm, carrier_hz);
            let bound_v_peak = self.bound_v_peak(carrier_hz);
            let bound = Some(("bound", bound_v_peak)).filter(|_| bound_v_peak < largest_v_peak);
            for (name, drive_v_peak) in bound.into_iter().chain([("", largest_v_peak)]) {
                let cells = [self.path(intact), self.path(scratched), self.path(Coating::Bridged), worst].map(|path| {
                    format!(
                        "{:.2} {:.2}",
                        1e3 * path.steady(drive_v_peak, carrier_hz).weighted_a_peak,
                        1e3 * path.any_envelope_a_peak(drive_v_peak, carrier_hz)
                    )
                });
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "{carrier_hz:5.0} Hz  {drive_v_peak:5.1} V {name:5}  {:11}  {:11}  {:11}  {:9} {}",
                    cells[0],
                    cells[1],
                    cells[2],
                    cells[3],
                    coating_text(worst.coating)
                );
            }
        }
        text + &format!("A scratch has {} kOhm here.\n", 1e-3 * SCRATCH_OHM)
    }

    /// Currents of single faults beside a bridged coating.
    fn faults(&self) -> String {
        let full_scale_v = f64::from(self.board.limits.full_scale_v_peak);
        let rail_v = f64::from(RAIL_MAX) * full_scale_v;
        let (usual_hz, direct_hz) = (1_000.0, 1.0);
        let bridged = |series_ohm: f64, drive_v_peak: f64, carrier_hz: f64| {
            let path = TouchPath { series_ohm, coating: Coating::Bridged };
            1e3 * path.any_envelope_a_peak(drive_v_peak, carrier_hz)
        };
        format!(
            "Faults beside a bridged coating, mA peak of {:.0}\n{:.2}  one of two equal series resistors shorted, at the \
             bound at 1 kHz\n{:.2}  the amplifier stuck at a rail of {rail_v:.0} V\n{:.2}  both (the amplifier's own \
             current limit is the hardware for it)\n",
            1e3 * SINGLE_FAULT_CURRENT_MAX_A_PEAK,
            bridged(0.5 * self.series_ohm, self.bound_v_peak(usual_hz).min(full_scale_v), usual_hz),
            bridged(self.series_ohm, rail_v, direct_hz),
            bridged(0.5 * self.series_ohm, rail_v, direct_hz),
        )
    }

    /// Parts of the drive's voltage and of the force that are left at the finger's gap, by return path.
    fn return_paths(&self) -> String {
        let mut text = format!(
            "Voltage across the finger's gap, of {:.0} pF, and force there, in % of what the model takes\n",
            1e12 * GAP_F
        );
        for (name, path) in RETURN_PATHS {
            for carrier_hz in [CARRIERS_HZ[1], CARRIERS_HZ[3]] {
                let part = path.gap_part(GAP_F, self.series_ohm, carrier_hz);
                let _ = writeln!(text, "{carrier_hz:5.0} Hz  {:3.0} {:3.0}  {name}", 100.0 * part, 100.0 * part * part);
            }
        }
        text
    }

    /// The least series resistance at which a voltage is within the bound, by carrier.
    fn resistances(&self, voltage_v_rms: f64) -> String {
        let mut text = format!(
            "Least series resistance for {voltage_v_rms} V rms at the electrode, of two equal E96 resistors, edges of {:.2} nF \
             included\n",
            1e9 * self.board.limits.electrode_capacitance_max_f
        );
        for carrier_hz in self.carriers_hz() {
            let found = series_ohm()
                .filter(|series_ohm| self.check_built(*series_ohm).is_ok())
                .map(|series_ohm| Behind::new(&self.board, series_ohm, carrier_hz, voltage_v_rms))
                .find(|behind| behind.drive_v_peak <= behind.bound_v_peak);
            let full_scale_v_peak = f64::from(self.board.limits.full_scale_v_peak);
            let said = match found {
                Some(found) if found.drive_v_peak <= full_scale_v_peak => found.to_string(),
                _ => format!("none: the edges need more than the amplifier's {full_scale_v_peak} V peak"),
            };
            let _ = writeln!(text, "{carrier_hz:5.0} Hz  {said}");
        }
        text
    }
}

/// Series resistances of two equal E96 resistors, in ascending order. Firmware is built for whole kOhm only.
fn series_ohm() -> impl Iterator<Item = f64> {
    let halves = SERIES_DECADES_OHM.into_iter().flat_map(|decade_ohm| {
        let of_decade = move |step| 0.01 * decade_ohm * (100.0 * 10_f64.powf(f64::from(step) / f64::from(E96))).round();
        (0..E96).map(of_decade)
    });
    let kohm = halves.map(|half_ohm| 2e-3 * half_ohm);
    kohm.filter(|kohm| (kohm - kohm.round()).abs() < 1e-6).map(|kohm| 1e3 * kohm.round())
}

/// A return path of the finger's current, to the amplifier's common.
enum ReturnPath {
    /// The return contact, Ohm.
    Contact(f64),
    /// Through the air and the supply's insulation, F.
    Air(f64),
}

impl ReturnPath {
    /// Part of the drive's voltage that is across a gap of this capacitance, at the frequency of the carrier's first
    /// harmonic.
    fn gap_part(&self, gap_f: f64, series_ohm: f64, carrier_hz: f64) -> f64 {
        let gap_ohm = 1.0 / (core::f64::consts::TAU * carrier_hz * gap_f);
        let (resistance_ohm, reactance_ohm) = match self {
            Self::Contact(ohm) => (series_ohm + ohm, gap_ohm),
            Self::Air(farad) => (series_ohm, gap_ohm * (1.0 + gap_f / farad)),
        };
        gap_ohm / resistance_ohm.hypot(reactance_ohm)
    }
}

/// A square carrier behind a series resistance.
struct Behind {
    series_ohm: f64,
    edge_time_constant_s: f64,
    /// Peak at the amplifier for the voltage at the electrode, V.
    drive_v_peak: f64,
    bound_v_peak: f64,
    /// Part of the mean square that the edges take.
    edges_part: f64,
}

impl Behind {
    fn new(board: &Board, series_ohm: f64, carrier_hz: f64, voltage_v_rms: f64) -> Self {
        let edge_time_constant_s = board.behind(series_ohm as f32).limits.edge_time_constant_s;
        let half_period_ticks = (0.5 * f64::from(board.tick_hz) / carrier_hz).round() as u32;
        let carrier = Carrier::new(Waveform::Square, half_period_ticks, board.tick_hz, edge_time_constant_s);
        let peak_per_rms = f64::from(carrier.peak_per_rms());
        Self {
            series_ohm,
            edge_time_constant_s: edge_time_constant_s.into(),
            drive_v_peak: voltage_v_rms * peak_per_rms,
            bound_v_peak: TouchBound::behind(series_ohm as f32).stated_v_peak(carrier_hz as f32),
            edges_part: 1.0 - 1.0 / (peak_per_rms * peak_per_rms),
        }
    }
}

impl std::fmt::Display for Behind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { series_ohm, edge_time_constant_s, drive_v_peak, bound_v_peak, edges_part } = self;
        write!(
            f,
            "{:4.0} kOhm: {drive_v_peak:.1} V peak of {bound_v_peak:.1} V; edges of {:.0} us take {:.0} % of the mean square",
            1e-3 * series_ohm,
            1e6 * edge_time_constant_s,
            100.0 * edges_part
        )
    }
}

fn coating_text(coating: Coating) -> String {
    match coating {
        Coating::Bridged => "bridged".to_owned(),
        Coating::Intact { capacitance_f } | Coating::Scratched { capacitance_f, .. } => {
            format!("{:.1} nF", 1e9 * capacitance_f)
        }
    }
}
