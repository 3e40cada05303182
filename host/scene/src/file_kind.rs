//! The kind of a file, by its content, for the sentence about a file of the wrong kind.

use std::collections::BTreeSet;

use thiserror::Error;

use super::compile_error::CompileError;
use super::log::Log;
use super::mistake::FileMistake;
use super::picture::is_picture;
use super::source::Source;

/// First and last bytes of a Parquet file.
pub const PARQUET: &[u8; 4] = b"PAR1";
/// First bytes of a zip.
const ZIP: &[u8] = b"PK\x03\x04";
/// Tables that only scenes have.
const OF_SCENES: [&str; 8] = ["layer", "defaults", "drive", "carrier", "touch", "design", "finger", "screen"];
/// A field that files of each kind have above their tables, in the order in which they are tried.
const OF_KINDS: [(&str, FileKind); 7] = [
    ("scenario", FileKind::Scenario),
    ("scenes", FileKind::Plan),
    ("people", FileKind::Plan),
    ("version", FileKind::Scene),
    ("friction_coefficient", FileKind::Finger),
    ("reports_per_s", FileKind::TouchSource),
    ("width_mm", FileKind::Screen),
];
/// Two columns that tables of each kind have.
const OF_TABLES: [([&str; 2], FileKind); 2] =
    [(["voltage_v_rms", "normal_force_n"], FileKind::Calibration), (["t_s", "x_mm"], FileKind::Stroke)];

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A scene.
    Scene,
    /// A finger profile.
    Finger,
    /// A screen.
    Screen,
    /// A touch source.
    TouchSource,
    /// A plan of a sweep.
    Plan,
    /// A scenario.
    Scenario,
    /// A PNG or JPEG file.
    Picture,
    /// A Parquet file.
    Recording,
    /// A CSV table of voltage and forces.
    Calibration,
    /// A CSV table of a finger's path, such as `felt.csv`.
    Stroke,
    /// Another CSV table.
    Table,
    /// A zip, such as a project of the studio.
    Zip,
}

/// A file is of another kind than expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{}: {}", self.finding(), self.advice())]
pub struct WrongKind {
    /// Kind of the file.
    pub found: FileKind,
    /// Expected kind.
    pub expected: FileKind,
}

impl WrongKind {
    /// The kind, and the expected kind.
    pub fn finding(self) -> String {
        format!("this is a {}; expected a {}", self.found.name(), self.expected.name())
    }

    /// How to use a file of this kind.
    pub fn advice(self) -> &'static str {
        self.found.use_of()
    }
}

impl FileKind {
    /// Whether files of this kind are TOML text.
    pub fn is_toml(self) -> bool {
        matches!(self, Self::Scene | Self::Finger | Self::Screen | Self::TouchSource | Self::Plan | Self::Scenario)
    }

    /// The kind of a file, by its whole content or the beginning of it; `None` if it has no mark of any kind. A text
    /// with mistakes still has a kind.
    ///
    /// ```
    /// use frixel_scene::FileKind;
    ///
    /// assert_eq!(FileKind::of(b"friction_coefficient = 0.5"), Some(FileKind::Finger));
    /// let error = FileKind::Scene.check(b"friction_coefficient = 0.5").unwrap_err().to_string();
    /// assert_eq!(error, "this is a finger profile; expected a scene: pass it with --finger");
    /// ```
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if is_picture(bytes) {
            return Some(Self::Picture);
        }
        if bytes.starts_with(PARQUET) {
            return Some(Self::Recording);
        }
        if bytes.starts_with(ZIP) {
            return Some(Self::Zip);
        }
        let text = String::from_utf8_lossy(bytes);
        let text = text.trim_start_matches('\u{feff}');
        Self::of_toml(text).or_else(|| Self::of_table(text))
    }

    /// The kind of tables that have a column.
    pub fn of_column(name: &str) -> Option<Self> {
        OF_TABLES.into_iter().find(|(columns, _)| columns.contains(&name)).map(|(_, kind)| kind)
    }

    /// Checks that a file is not known to be of another kind.
    pub fn check(self, bytes: &[u8]) -> Result<(), WrongKind> {
        match Self::of(bytes) {
            Some(found) if found != self => Err(WrongKind { found, expected: self }),
            _ => Ok(()),
        }
    }

    /// The text of a file of this kind. Messages call the file `name`.
    ///
    /// # Errors
    ///
    /// Fails if the file is of another kind, or not UTF-8.
    pub fn text<'b>(self, bytes: &'b [u8], name: &str) -> Result<&'b str, CompileError> {
        let (valid, mistake) = match (self.check(bytes), std::str::from_utf8(bytes)) {
            (Err(wrong), _) => ("".into(), FileMistake::from(wrong)),
            (Ok(()), Ok(text)) => return Ok(text),
            (Ok(()), Err(error)) => {
                (String::from_utf8_lossy(bytes.get(..error.valid_up_to()).unwrap_or_default()), FileMistake::NotUtf8)
            }
        };
        let source = Source::new(name, &valid);
        let mut log = Log::new(&source);
        log.add(valid.len(), mistake);
        log.finish(None)
    }

    /// Its name in messages.
    pub(super) fn name(self) -> &'static str {
        if self == Self::Finger { "finger profile" } else { self.word() }
    }

    /// The kind as a noun.
    pub fn word(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Finger => "finger",
            Self::Screen => "screen",
            Self::TouchSource => "touch source",
            Self::Plan => "plan of a sweep",
            Self::Scenario => "scenario",
            Self::Picture => "picture",
            Self::Recording => "recording in Parquet",
            Self::Calibration => "calibration",
            Self::Stroke => "recorded stroke",
            Self::Table => "CSV table",
            Self::Zip => "zip",
        }
    }

    /// Advice on how to use it.
    pub fn use_of(self) -> &'static str {
        match self {
            Self::Scene => "play it with `frixel play`",
            Self::Finger => "pass it with --finger",
            Self::Screen => "pass it with --screen",
            Self::TouchSource => "pass it with --touch",
            Self::Plan => "play it with `frixel sweep`",
            Self::Scenario => "run it with `frixel sim --scenario`",
            Self::Picture => "make a scene of it with `frixel new NAME --picture FILE`",
            Self::Recording => "play it again with `frixel replay`",
            Self::Calibration => "fit it with `frixel finger fit`",
            Self::Stroke => "pass it with --stroke",
            Self::Table => "name the file that you mean",
            Self::Zip => "open it in the studio, or unpack it",
        }
    }

    fn of_toml(text: &str) -> Option<Self> {
        let mut fields = BTreeSet::new();
        let mut is_above_tables = true;
        for line in text.lines().map(str::trim) {
            let rest = line.trim_start_matches('[');
            let name = rest.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next().unwrap_or_default();
            // Lists of numbers have lines in brackets, too.
            if rest.len() < line.len() && name.starts_with(char::is_alphabetic) {
                if OF_SCENES.contains(&name) {
                    return Some(Self::Scene);
                }
                is_above_tables = false;
            } else if is_above_tables && line.contains('=') {
                fields.insert(name);
            }
        }
        // The fields of a layer without its line `[[layer]]` have a width, too.
        let (_, kind) = OF_KINDS.into_iter().find(|(field, _)| fields.contains(field))?;
        (kind != Self::Screen || !fields.contains("kind")).then_some(kind)
    }

    /// The kind of a table, whose header and first row have the same separators.
    fn of_table(text: &str) -> Option<Self> {
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let (header, row) = (lines.next()?, lines.next()?);
        let count = |line: &str, separator: char| line.matches(separator).count();
        let separator = [',', ';', '\t'].into_iter().find(|separator| count(header, *separator) > 0)?;
        let names: Vec<&str> = header.split(separator).map(|name| name.trim().trim_matches('"')).collect();
        let is_table = count(header, separator) == count(row, separator)
            && !header.contains('=')
            && names.iter().all(|name| name.starts_with(char::is_alphabetic));
        let kind = OF_TABLES.into_iter().find(|(columns, _)| columns.iter().all(|column| names.contains(column)));
        is_table.then_some(kind.map_or(Self::Table, |(_, kind)| kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_file_is_known_by_its_content() {
        for (content, kind) in [
            ("# mine\nversion = 1\n", FileKind::Scene),
            ("width_mm = 5\n[[layer]]\nkind = constant", FileKind::Scene),
            ("[finger]\nradius_mm = 8\n", FileKind::Scene),
            ("intervals_n = [\n  [0.1, 0.2],\n]\nfriction_coefficient = 0.5\n", FileKind::Finger),
            ("width_mm = 120\n", FileKind::Screen),
            ("reports_per_s = 100\nlatency_ms = \n", FileKind::TouchSource),
            ("people = 40\n[parameters]\nversion = [1]\n", FileKind::Plan),
            ("scenario = 1\nscene = \"a.toml\"\n", FileKind::Scenario),
            ("\u{feff}scenario = 1\n", FileKind::Scenario),
            ("voltage_v_rms,normal_force_n,friction_n\n0,0.5,0.2\n", FileKind::Calibration),
            ("# felt\nt_s;x_mm;y_mm\n0,0;1,0;2,0\n", FileKind::Stroke),
            ("\"time (s)\"\tforce\n0\t1\n", FileKind::Table),
            ("PAR1\0", FileKind::Recording),
            ("PK\u{3}\u{4}", FileKind::Zip),
        ] {
            assert_eq!(FileKind::of(content.as_bytes()), Some(kind), "{content}");
        }
        assert_eq!(FileKind::of(b"\x89PNG\r\n\x1a\n"), Some(FileKind::Picture));
        for content in ["", "radius_mm = 8\n", "kind = \"grating\"\nwidth_mm = 5\n", "hello, world\n", "a, b\n1\n"] {
            assert_eq!(FileKind::of(content.as_bytes()), None, "{content}");
        }
    }
}
