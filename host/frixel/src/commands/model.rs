//! `frixel model`: evaluates the contact model over rows of CSV.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use frixel::input::{self, Bounded};
use frixel::model_csv::{self, CsvError, Precision, Summary};

use super::error::CommandError;
use super::terminal::note;

#[derive(Debug, Subcommand)]
pub(super) enum ModelCommand {
    /// Voltage to friction, row by row.
    ///
    /// Reads CSV with a header row, columns in any order, SI units. `variant` is one of `wf-upper`, `wf-lower`,
    /// `wf-loaded`, `wf-finite`, `soft-upper`, `soft-lower`, `soft-loaded`. Every row needs `radius_m`, `coating_m`,
    /// `permittivity`, `friction_coefficient` and `voltage_v` (rms). Fingers on springs (wf) need `stiffness_pa_per_m`;
    /// soft ones `modulus_pa`, `stress_exponent`, `shape_constant`; the loaded ones `normal_force_n`, which `wf-lower`
    /// and `wf-finite` take as well; `wf-finite` needs `outer_radius_m`. What a variant does not need is not read.
    ///
    /// Writes the same columns, and behind them `sigma0_pa`, `contact_radius_m`, `effective_stiffness_pa_per_m`,
    /// `friction_n` and `status`: `ok`, `no-contact` (pulled off: radius and friction are zero), or `invalid` with the
    /// reason.
    Eval(FileArgs),
    /// Friction to voltage, row by row.
    ///
    /// Reads what `eval` reads, with `friction_n` (the total) or `electric_friction_n` (what the voltage adds, exact
    /// where the total would cancel) in place of `voltage_v`: the one that a row fills in.
    ///
    /// Writes the same columns, and behind them `voltage_v` (rms) and `status`: `ok`, `below-natural` (less than the
    /// finger has at no voltage), `unstable` (a contact below pull-off), or `invalid` with the reason.
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
    /// What to compute in, from the cells' digits to the answer's.
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

pub(super) fn run(command: &ModelCommand) -> Result<(), CommandError> {
    type Transform = fn(Precision, Box<dyn Read>, Box<dyn Write>) -> Result<Summary, CsvError>;
    let (args, transform): (_, Transform) = match command {
        ModelCommand::Eval(args) => (args, model_csv::eval),
        ModelCommand::Invert(args) => (args, model_csv::invert),
    };
    let input = open(args.input.as_deref())?;
    let output = create(args)?;
    match transform(args.precision.into(), input, output) {
        Ok(summary) => return judge(&summary),
        // Ignore a closed standard output.
        Err(CsvError::Write(error)) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(source) => {
            let (path, stream) = match source {
                CsvError::Write(_) => (&args.output, "standard output"),
                _ => (&args.input, "standard input"),
            };
            let input = path.as_ref().map_or(stream.to_owned(), |path| path.display().to_string());
            return Err(CommandError::ModelCsv { input, source });
        }
    }
    Ok(())
}

fn open(path: Option<&Path>) -> Result<Box<dyn Read>, CommandError> {
    match path {
        Some(path) => Ok(Box::new(input::open(path, input::CSV_MAX_BYTES).map_err(CommandError::reading(path))?)),
        None => Ok(Box::new(Bounded::new(io::stdin().lock(), input::CSV_MAX_BYTES))),
    }
}

fn create(args: &FileArgs) -> Result<Box<dyn Write>, CommandError> {
    let Some(path) = &args.output else { return Ok(Box::new(io::stdout().lock())) };
    let same_file = |input: &PathBuf| {
        input.canonicalize().is_ok_and(|input| path.canonicalize().is_ok_and(|output| input == output))
    };
    if args.input.as_ref().is_some_and(same_file) {
        return Err(CommandError::OutputIsInput { path: path.clone() });
    }
    let file = File::options().write(true).create(true).truncate(false).open(path);
    Ok(Box::new(Kept { file: file.map_err(CommandError::writing(path))?, begun: false }))
}

/// A file that is truncated only at the first write, so that rejected input does not destroy its contents.
struct Kept {
    file: File,
    begun: bool,
}

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if !self.begun {
            // Only regular files have a length to truncate; devices and pipes do not.
            if self.file.metadata()?.is_file() {
                self.file.set_len(0)?;
            }
            self.begun = true;
        }
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Notes what the contact cannot mean. Fails if a row has no answer.
fn judge(summary: &Summary) -> Result<(), CommandError> {
    let rows = |count: u64| if count == 1 { "1 row has".to_owned() } else { format!("{count} rows have") };
    if summary.beyond_finger_rows > 0 {
        let rows = rows(summary.beyond_finger_rows);
        note(format_args!(
            "frixel: {rows} a contact radius above the finger's radius, where the model is not valid: is a skin gap missing \
             from the coating?"
        ));
    }
    match summary.invalid_rows {
        0 => Ok(()),
        invalid => Err(CommandError::InvalidRows { rows: rows(invalid) }),
    }
}
