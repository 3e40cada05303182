//! `index.html`: the figures with their captions, on one self-contained page.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::error::ReportError;
use super::figure::Figure;
use crate::output_file::{Inputs, OutputFile, commit_all};

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 1040px; margin: 2rem auto; \
padding: 0 20px; }
h1 { margin-bottom: 0; } h2 { margin: 3rem 0 0.5rem; font-size: 1.3rem; }
figure { margin: 0; } figure svg { width: 100%; height: auto; } figcaption { max-width: 62rem; }
figcaption p { margin: 0.5rem 0; } table { border-collapse: collapse; margin: 1rem 0; } th, td { border-top: 1px solid #ccc; \
padding: 0.5rem 0.8rem 0.5rem 0; text-align: left; vertical-align: top; } th { width: 10rem; } td p { margin: 0 0 0.3rem; } \
nav li { margin: 0.15rem 0; } a { color: #0072b2; }
";

/// The answer to a question, in numbers, at the top of a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// What is asked, in a few words.
    pub question: &'static str,
    /// The answer with its worst points, a sentence or a few each.
    pub sentences: Vec<String>,
    /// Name of the figure that shows it.
    pub figure: &'static str,
}

/// A page of figures.
#[derive(Clone, Copy, Debug)]
pub struct Page<'p> {
    /// Title of the page.
    pub title: &'p str,
    /// The program that makes it, as it is called.
    pub maker: &'p str,
    /// What the figures say, in numbers.
    pub answers: &'p [Answer],
    /// The figures, in order.
    pub figures: &'p [Figure],
}

impl Page<'_> {
    /// Writes `index.html` and the numbers behind each figure into a folder, and returns the paths of the files.
    /// `inputs` are the files that were read, which are not overwritten.
    pub fn write(&self, folder: &Path, inputs: &Inputs) -> Result<Vec<PathBuf>, ReportError> {
        let mut paths = Vec::new();
        let mut files = Vec::new();
        let mut put = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            files.push(OutputFile::new(&path, "--out", inputs)?.filled(bytes)?);
            Ok::<PathBuf, ReportError>(path)
        };
        let mut drawn = Vec::new();
        for figure in self.figures {
            let drawing = |reason: String| ReportError::Drawing { name: figure.name, reason };
            drawn.push((figure, figure.chart.svg().map_err(|error| drawing(error.to_string()))?));
            paths.push(put(&format!("{}.csv", figure.name), &figure.csv)?);
        }
        paths.insert(0, put("index.html", self.html(&drawn).as_bytes())?);
        commit_all(files, &[])?;
        Ok(paths)
    }

    /// The answers as a table, each with a link to its figure.
    fn answers_html(&self) -> String {
        let mut table = String::new();
        for Answer { question, sentences, figure } in self.answers {
            // Writing to a string cannot fail.
            let _ = write!(table, "<tr><th>{}</th><td>", escaped(question));
            for sentence in sentences {
                let _ = write!(table, "<p>{}</p>", escaped(sentence));
            }
            let _ = writeln!(table, "</td><td><a href=\"#{figure}\">figure</a></td></tr>");
        }
        if table.is_empty() { table } else { format!("<table>\n{table}</table>\n") }
    }

    /// The page with all figures that were drawn.
    fn html(&self, figures: &[(&Figure, String)]) -> String {
        let Self { title, maker, .. } = self;
        let mut page = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            page,
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title} (frixel)</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <h1>{title}</h1>\n{}\
             <p>Made by <code>{maker}</code>, version {}. Equation and figure numbers are those of Argatov and Borodich, \
             <i>A macro model for electroadhesive contact of a soft finger with a touchscreen</i>. The numbers behind each picture \
             stand in a CSV file beside this page.</p>\n<nav>\n<ol>\n",
            self.answers_html(),
            env!("CARGO_PKG_VERSION")
        );
        for (figure, _) in figures {
            let _ = writeln!(page, "<li><a href=\"#{}\">{}</a></li>", figure.name, escaped(&figure.title));
        }
        page.push_str("</ol>\n</nav>\n");
        for (figure, svg) in figures {
            let (name, title) = (figure.name, escaped(&figure.title));
            let _ = write!(page, "<h2 id=\"{name}\">{title}</h2>\n<figure>\n{}\n<figcaption>\n", labelled(svg, &title));
            for paragraph in &figure.caption {
                let _ = writeln!(page, "<p>{}</p>", escaped(paragraph));
            }
            let _ = write!(page, "<p><a href=\"{name}.csv\">{name}.csv</a></p>\n</figcaption>\n</figure>\n");
        }
        page.push_str("</body>\n</html>\n");
        page
    }
}

/// Adds a title to a picture, for screen readers.
fn labelled(svg: &str, title: &str) -> String {
    svg.trim_end().replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{title}\" "), 1)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
