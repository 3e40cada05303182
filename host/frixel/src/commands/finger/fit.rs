//! `frixel finger fit`: a finger's profile from measured friction.

use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use crate::commands::error::reading;
use crate::input::{self, Bounded};
use crate::output::draw_fit_svg;
use anyhow::{Result, anyhow, bail};
use chrono::Utc;
use clap::{Args, ValueEnum};
use frixel_files::{Inputs, OutputFile, commit_all};
use frixel_lab::fit::{self, DataSummary, Division, EmpiricalFit, Fit, Settings};
use frixel_lab::table::Reading;
use frixel_model::Waveform;
use frixel_play::TO_THE_END;
use frixel_scene::{Experiment, FingerProfile};

use crate::commands::argument::{self, positive};
use crate::commands::profiles::screen;
use crate::commands::terminal::{note_understood, print_line, say};

/// Voltage at which electric friction is stated if none is given, in volts rms.
const STATED_V_RMS: f64 = 150.0;
/// Carrier frequency of a calibration, in Hz.
const CARRIER_HZ: f64 = 1e3;

#[derive(Debug, Args)]
pub(in crate::commands) struct FitArgs {
    /// The recording: CSV with the columns `voltage_v_rms,normal_force_n,friction_n` and optionally
    /// `time_s,stroke,speed_mm_s`, in any order; `-` for standard input. A header may state another unit, as in
    /// `friction_mn`. A paper's table of means, with `friction_se_n` or `friction_sd_n` and `n`, is accepted as well
    /// (docs/design/outputs.md).
    #[arg(value_name = "DATA.csv")]
    data: PathBuf,
    /// The finger profile to write. Residual plots of the contact model go beside it, into a file of the same name that
    /// ends in .svg; with another law, those of an earlier fit are removed.
    #[arg(short, long, value_name = "FINGER.toml")]
    output: Option<PathBuf>,
    /// Law of the voltage: `contact`, the model, which refuses data that contradict it; or `empirical`, a power law or
    /// a table of up to 16 voltages, for this screen and load.
    #[arg(long, value_enum, default_value_t = Law::Contact, hide_possible_values = true)]
    law: Law,
    /// Print one JSON object in place of the summary.
    #[arg(long)]
    json: bool,
    /// The screen that friction was measured on: a bundled name or a screen file (docs/design/scenes.md). The profile
    /// holds for this screen. Default: the example screen.
    #[arg(long, value_name = "SCREEN")]
    screen: Option<String>,
    /// Voltage at which the contact model's electric friction is stated, in volts rms. Default: 150. An empirical law
    /// is stated at the highest voltage of the data.
    #[arg(long, value_name = "V_RMS", value_parser = positive)]
    voltage: Option<f64>,
    /// Normal load of the profile, in newtons. Default: the median of the data.
    #[arg(long, value_name = "N", value_parser = positive)]
    load: Option<f64>,
    /// Carrier frequency of the measurement, in Hz: 125 to 5000, with edges of 20 us. Default: 1000, as of `frixel finger
    /// calibrate`. For the contact model only.
    #[arg(long, value_name = "HZ", value_parser = carrier_hz)]
    carrier_hz: Option<f64>,
    /// The carrier of the measurement was a sine. Default: a square wave. For the contact model only.
    #[arg(long)]
    sine: bool,
    /// Strokes to leave out, by their names in the column `stroke`.
    #[arg(long, value_name = "STROKE", value_delimiter = ',')]
    without: Vec<String>,
    /// How friction was measured, in a few words for the profile. Default: `load cell, strokes with the drive switched
    /// on and off`, or `means with their errors`.
    #[arg(long, value_name = "TEXT")]
    method: Option<String>,
    /// Seed of the bootstrap that gives the intervals.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Laws of the voltage that can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Law {
    /// The contact model, which refuses data that contradict it.
    Contact,
    /// A power of the voltage that is fitted to the data, or a table of at most 16 measured voltages: for a finger that
    /// the contact model does not describe, on this screen, under this load and up to the highest voltage of the data.
    Empirical,
}

/// A finger, fitted by one of the laws.
enum Fitted {
    Contact(Box<Fit>),
    Empirical(Box<EmpiricalFit>),
}

impl Fitted {
    fn profile(&self, experiment: Experiment) -> FingerProfile {
        match self {
            Self::Contact(fit) => fit::profile(fit, experiment),
            Self::Empirical(fit) => fit.profile(experiment),
        }
    }

    fn words(&self, screen: &str) -> String {
        match self {
            Self::Contact(fit) => fit::words(fit, screen),
            Self::Empirical(fit) => fit.words(),
        }
    }

    fn json(&self) -> serde_json::Value {
        match self {
            Self::Contact(fit) => fit.json(),
            Self::Empirical(fit) => fit.json(),
        }
    }

    fn data(&self) -> &DataSummary {
        match self {
            Self::Contact(fit) => &fit.data,
            Self::Empirical(fit) => &fit.data,
        }
    }
}

pub(super) fn run(args: &FitArgs) -> Result<()> {
    let path = &args.data;
    if let (Law::Empirical, Some(found)) = (args.law, args.voltage) {
        bail!(
            "--voltage {found} is for the contact model, and an empirical law always states friction at the highest \
             voltage of the data: leave --voltage out"
        );
    }
    if args.law == Law::Empirical && (args.carrier_hz.is_some() || args.sine) {
        bail!(
            "--carrier-hz and --sine correct the contact model, and an empirical law needs no correction, since it \
             holds for the carrier of its measurement: leave them out"
        );
    }
    let (screen_name, screen) = screen(args.screen.as_deref())?;
    let outputs = args.output.as_deref().map(|output| Outputs::new(args, path, output)).transpose()?;
    let settings = Settings {
        voltage_v_rms: args.voltage.unwrap_or(STATED_V_RMS),
        normal_load_n: args.load,
        coating_gap_m: screen.coating_gap_m(),
        ripple: fit::measured_ripple(if args.sine { Waveform::Sine } else { Waveform::Square }, args.carrier_hz()),
        without: args.without.clone(),
        seed: args.seed,
    };
    let refused = |error| anyhow!("{}: {error}", path.display());
    let Reading { value: data, understood } = fit::data(open(path)?).map_err(refused)?;
    note_understood(path, understood.as_deref());
    let fit = match args.law {
        Law::Contact => fit::fit_data(data, &settings, TO_THE_END).map(|fit| Fitted::Contact(Box::new(fit))),
        Law::Empirical => fit::fit_empirical(data, &settings, TO_THE_END).map(|fit| Fitted::Empirical(Box::new(fit))),
    };
    let fit = fit.map_err(refused)?;
    if let Some(outputs) = &outputs {
        outputs.write(args, path, &fit, &screen_name)?;
    }
    let text = if args.json { fit.json().to_string() } else { fit.words(&screen_name) };
    let text = text.trim_end_matches('\n');
    match &outputs {
        Some(outputs) if args.json => say(&outputs.profile, text),
        Some(outputs) => say(&outputs.profile, format_args!("{text}\n  {:<22} {}", "wrote", outputs.names(args.law))),
        None => print_line(text),
    }
}

impl FitArgs {
    fn carrier_hz(&self) -> f64 {
        self.carrier_hz.unwrap_or(CARRIER_HZ)
    }
}

fn carrier_hz(text: &str) -> Result<f64, String> {
    let [least, most] = fit::CARRIERS_HZ;
    argument::number(text, least..=most, &format!("a number of Hz from {least} to {most}"))
}

/// How friction was measured, as far as the data show.
fn method_of(division: Division) -> &'static str {
    match division {
        Division::Means => "means with their errors",
        Division::Column | Division::Motion | Division::Blocks => {
            "load cell, strokes with the drive switched on and off"
        }
    }
}

/// The profile, and the residual plots beside it if it is a file.
struct Outputs {
    profile: OutputFile,
    plots: Option<OutputFile>,
}

impl Outputs {
    fn new(args: &FitArgs, data: &PathBuf, path: &Path) -> Result<Self> {
        let inputs = Inputs::new([data].into_iter().chain(args.screen.as_ref().map(PathBuf::from).as_ref()));
        let profile = OutputFile::new(path, "-o", &inputs)?;
        if !profile.is_file() {
            return Ok(Self { profile, plots: None });
        }
        let plots = OutputFile::new(&path.with_extension("svg"), "-o", &inputs)?;
        plots.check_apart_from(&profile)?;
        Ok(Self { profile, plots: Some(plots) })
    }

    fn write(&self, args: &FitArgs, data: &Path, fit: &Fitted, screen: &str) -> Result<()> {
        let simulated = if fit.data().preparation.is_simulated { "simulated " } else { "" };
        let method = args.method.clone().unwrap_or_else(|| {
            let waveform = if args.sine { "sine" } else { "square" };
            let is_stated = args.sine || args.carrier_hz.is_some();
            let stated = format!(" under a {waveform} carrier of {} Hz", args.carrier_hz());
            let carrier = if is_stated { &stated } else { "" };
            format!("{simulated}{}{carrier}", method_of(fit.data().division))
        });
        let date = Utc::now().date_naive().to_string();
        let experiment = Experiment { date, method, screen: screen.to_owned() };
        let mut written = vec![self.profile.filled(fit.profile(experiment).to_toml().as_bytes())?];
        if let (Some(plots), Fitted::Contact(fit)) = (&self.plots, fit) {
            let drawn = draw_fit_svg(&format!("{}, fitted", data.display()), fit)?;
            written.push(plots.filled(drawn.as_bytes())?);
            return Ok(commit_all(written, &[])?);
        }
        // With another law, plots of an earlier fit do not belong to the new profile.
        Ok(commit_all(written, self.plots.as_slice())?)
    }

    fn names(&self, law: Law) -> String {
        let plots = self.plots.as_ref().filter(|_| law == Law::Contact);
        let files = [Some(&self.profile), plots].into_iter().flatten();
        files.map(|file| file.path().display().to_string()).collect::<Vec<_>>().join(", ")
    }
}

fn open(path: &Path) -> Result<Box<dyn Read>> {
    if path == Path::new("-") {
        return Ok(Box::new(Bounded::new(io::stdin().lock(), input::CSV_MAX_BYTES)));
    }
    Ok(Box::new(BufReader::new(input::open(path, input::CSV_MAX_BYTES).map_err(reading(path))?)))
}
