//! `index.html`: questions side by side, each with its plot and its table, and explanations below.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use frixel_chart::{Chart, Panel};

use super::error::ReportError;
use frixel_files::{Inputs, OutputFile, commit_all};

const STYLE: &str = "\
body { font: 15px/1.4 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 1rem auto; max-width: 1500px; \
padding: 0 16px; } h1 { font-size: 1.2rem; margin: 0; } h2 { font-size: 1.05rem; margin: 0 0 0.3rem; } p { margin: 0.4rem 0; }
main { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1.5rem; margin: 0.6rem 0; }
svg { width: 100%; height: auto; } table { border-collapse: collapse; font-size: 0.75rem; width: 100%; }
th, td { border-top: 1px solid #ccc; padding: 0.1rem 0.4rem 0.1rem 0; text-align: left; vertical-align: top; }
footer { max-width: 62rem; } a { color: #0072b2; }
";
/// Width of a plot and its height without the legend, in pixels: a third of a screen.
const WIDTH: u32 = 560;
const HEIGHT: u32 = 330;

/// A question with its answer.
pub(super) struct Section {
    /// Name of the CSV file, without its extension, and of the anchor.
    pub(super) name: &'static str,
    pub(super) question: &'static str,
    pub(super) panel: Panel,
    /// The table; its first row is the header.
    pub(super) table: Vec<Vec<String>>,
    /// Explanations below the tables, one paragraph each.
    pub(super) notes: Vec<String>,
    /// The numbers behind the plot; the first row is the header.
    pub(super) rows: Vec<Vec<String>>,
}

impl Section {
    fn csv(&self) -> Result<Vec<u8>, ReportError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in &self.rows {
            writer.write_record(row)?;
        }
        Ok(writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?)
    }

    fn svg(&self) -> Result<String, ReportError> {
        let panel = Panel { height: HEIGHT, ..self.panel.clone() };
        let chart = Chart { width: WIDTH, ..Chart::new(vec![panel], 1) };
        let drawn = chart.svg().map_err(|error| ReportError::Drawing { name: self.name, reason: error.to_string() })?;
        let label = format!("<svg role=\"img\" aria-label=\"{}\" ", escaped(self.question));
        Ok(drawn.trim_end().replacen("<svg ", &label, 1))
    }
}

/// A page of questions.
pub(super) struct Page<'p> {
    /// The finger whose run times were measured, in words.
    pub(super) finger: &'p str,
    /// Origin of the counts.
    pub(super) counts: &'p str,
    pub(super) sections: &'p [Section],
}

impl Page<'_> {
    /// Writes `index.html` and the numbers behind each plot into a folder, and returns the paths of the files. `inputs`
    /// are the files that were read, which are not overwritten.
    pub(super) fn write(&self, folder: &Path, inputs: &Inputs) -> Result<Vec<PathBuf>, ReportError> {
        let (mut paths, mut files) = (Vec::new(), Vec::new());
        let mut put = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            files.push(OutputFile::new(&path, "--out", inputs)?.filled(bytes)?);
            paths.push(path);
            Ok::<_, ReportError>(())
        };
        put("index.html", self.html()?.as_bytes())?;
        for section in self.sections {
            put(&format!("{}.csv", section.name), &section.csv()?)?;
        }
        commit_all(files, &[])?;
        Ok(paths)
    }

    fn html(&self) -> Result<String, ReportError> {
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>The contact model, its error and its cost (frixel)</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <h1>The contact model, its error and its cost</h1>\n<main>\n"
        );
        // Writing to a string cannot fail.
        for section in self.sections {
            let Section { name, question, .. } = section;
            let _ =
                writeln!(page, "<section id=\"{name}\">\n<h2>{}</h2>\n{}\n<table>", escaped(question), section.svg()?);
            for (number, row) in section.table.iter().enumerate() {
                let tag = if number == 0 { "th" } else { "td" };
                let cells: Vec<String> = row.iter().map(|cell| escaped(cell)).collect();
                let _ = writeln!(page, "<tr><{tag}>{}</{tag}></tr>", cells.join(&format!("</{tag}><{tag}>")));
            }
            let _ = writeln!(page, "</table>\n<p><a href=\"{name}.csv\">{name}.csv</a></p>\n</section>");
        }
        let _ = writeln!(page, "</main>\n<footer>");
        for section in self.sections {
            let _ = writeln!(page, "<h2>{}</h2>", escaped(section.question));
            for note in &section.notes {
                let _ = writeln!(page, "<p>{}</p>", escaped(note));
            }
        }
        let _ = writeln!(
            page,
            "<h2>Sources</h2>\n<p>The finger is {}. Instructions and bytes of flash were {}. Equation numbers are those of Argatov \
             and Borodich, <i>A macro model for electroadhesive contact of a soft finger with a touchscreen</i>. Made by \
             <code>frixel report</code>, version {}.</p>\n</footer>\n</body>\n</html>",
            escaped(self.finger),
            escaped(self.counts),
            env!("CARGO_PKG_VERSION")
        );
        Ok(page)
    }
}

/// A number for a CSV file, with enough digits to be read back exactly; not-a-number is an empty cell.
pub(super) fn cell(number: f64) -> String {
    match number {
        number if !number.is_finite() => String::new(),
        number if number.total_cmp(&0.0).is_eq() || (1e-4..1e6).contains(&number.abs()) => number.to_string(),
        number => format!("{number:e}"),
    }
}

/// An error with two significant digits, for display.
pub(super) fn digits(error: f64) -> String {
    if error.is_finite() { format!("{error:.1e}") } else { "no answer".to_owned() }
}

/// The cells of a text, separated by `|`.
pub(super) fn row(cells: &str) -> Vec<String> {
    cells.split('|').map(str::to_owned).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
