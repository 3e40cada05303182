//! `frixel model`: evaluates the contact model over rows of CSV.

use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::error::reading;
use crate::input::{self, Bounded};
use anyhow::{Result, bail};
use clap::{Args, Subcommand, ValueEnum};
use frixel_files::{Inputs, OutputFile};
use frixel_lab::model_csv::{self, CsvError, Precision, Summary};

use super::terminal::{note, note_understood};

#[derive(Debug, Subcommand)]
pub(super) enum ModelCommand {
    /// Voltage to friction, row by row.
    ///
    /// Reads CSV with a header row, columns in any order, SI units. `variant` is one of `wf-upper`, `wf-lower`,
    /// `wf-loaded`, `wf-finite`, `soft-upper`, `soft-lower`, `soft-loaded`. Every row needs `radius_m`, `coating_m`,
    /// `permittivity`, `friction_coefficient` and `voltage_v` (rms). Fingers on springs (wf) need `stiffness_pa_per_m`;
    /// soft ones `modulus_pa`, `stress_exponent`, `shape_constant`; the loaded ones `normal_force_n`, which `wf-lower`
    /// and `wf-finite` take as well; `wf-finite` needs `outer_radius_m`. Other columns are not read.
    ///
    /// Writes the same columns, and behind them `sigma0_pa`, `contact_radius_m`, `effective_stiffness_pa_per_m`,
    /// `friction_n` and `status`: `ok`, `no-contact` (pulled off: radius and friction are zero), `wider-than-finger`
    /// (the model is not valid), or `invalid` with the reason. These replace columns of the same names.
    Eval(FileArgs),
    /// Friction to voltage, row by row.
    ///
    /// Reads what `eval` reads, with `friction_n` (the total) or `electric_friction_n` (what the voltage adds, exact
    /// where the total would cancel) in place of `voltage_v`: the one that a row fills in.
    ///
    /// Writes the same columns, and behind them `voltage_v` (rms) and `status`: `ok`, `below-natural` (less than the
    /// finger has at no voltage), `unstable` (a contact below pull-off), `wider-than-finger` (the model is not valid),
    /// or `invalid` with the reason. These replace columns of the same names.
    Invert(FileArgs),
}

#[derive(Debug, Args)]
pub(super) struct FileArgs {
    /// CSV file to read; without it, standard input.
    #[arg(long, value_name = "FILE.csv")]
    input: Option<PathBuf>,
    /// CSV file to write; without it, standard output.
    #[arg(long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Floating-point type of the computation, from the cells' digits to the answer's.
    #[arg(long, value_enum, default_value_t = PrecisionName::F64)]
    precision: PrecisionName,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum PrecisionName {
    F64,
    F32,
}

impl From<PrecisionName> for Precision {
    fn from(name: PrecisionName) -> Self {
        match name {
            PrecisionName::F64 => Self::F64,
            PrecisionName::F32 => Self::F32,
        }
    }
}

pub(super) fn run(command: &ModelCommand) -> Result<()> {
    let (ModelCommand::Eval(args) | ModelCommand::Invert(args)) = command;
    let input = open(args.input.as_deref())?;
    let output = args.output.as_deref().unwrap_or(Path::new("-"));
    let output = OutputFile::new(output, "--output", &Inputs::new(&args.input))?;
    let mut writer = output.create()?;
    let precision = args.precision.into();
    let transformed = match command {
        ModelCommand::Eval(_) => model_csv::eval(precision, input, &mut writer),
        ModelCommand::Invert(_) => model_csv::invert(precision, input, &mut writer),
    };
    match transformed {
        Ok(summary) => {
            writer.commit()?;
            note_understood(args.input.as_deref().unwrap_or(Path::new("-")), summary.understood.as_deref());
            return judge(&summary);
        }
        // Ignore a closed standard output.
        Err(CsvError::Write(error)) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(CsvError::Write(error)) => return Err(error.into()),
        Err(CsvError::Table(error)) => {
            let input = args.input.as_ref().map_or("standard input".to_owned(), |path| path.display().to_string());
            bail!("{input}: {error}");
        }
    }
    Ok(())
}

fn open(path: Option<&Path>) -> Result<Box<dyn Read>> {
    match path {
        Some(path) => Ok(Box::new(input::open(path, input::CSV_MAX_BYTES).map_err(reading(path))?)),
        None => Ok(Box::new(Bounded::new(io::stdin().lock(), input::CSV_MAX_BYTES))),
    }
}

/// Notes contacts that are wider than the finger. Fails if a row has no answer.
fn judge(summary: &Summary) -> Result<()> {
    let rows = |count: u64| if count == 1 { "1 row has".to_owned() } else { format!("{count} rows have") };
    if let Some(doubt) = model_csv::wider_than_finger(summary.beyond_finger_rows) {
        note(format_args!("frixel: {doubt}"));
    }
    match summary.invalid_rows {
        0 => Ok(()),
        invalid => bail!("{} no answer; the column `status` gives the reason", rows(invalid)),
    }
}
