//! A figure: a picture, its caption, and the numbers behind it.

use frixel_chart::Chart;

/// A picture with its caption and the numbers behind it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of the figure, used for its CSV file (without the extension) and its anchor in the page.
    pub name: &'static str,
    /// Title above the picture.
    pub title: String,
    /// Paragraphs that explain the picture without any other text.
    pub caption: Vec<String>,
    /// The picture.
    pub chart: Chart,
    /// Content of the CSV file.
    pub csv: Vec<u8>,
}

/// A table with named columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Data<const COLUMNS: usize> {
    header: [&'static str; COLUMNS],
    rows: Vec<[Value; COLUMNS]>,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, written with enough digits to be read back exactly; not-a-number is an empty cell.
    Number(f64),
    /// A text, written unchanged.
    Text(String),
}

impl<const COLUMNS: usize> Data<COLUMNS> {
    /// A table without rows.
    pub fn new(header: [&'static str; COLUMNS]) -> Self {
        Self { header, rows: Vec::new() }
    }

    /// Appends a row.
    pub fn row(&mut self, cells: [Value; COLUMNS]) {
        self.rows.push(cells);
    }

    /// The table as a CSV file.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.header)?;
        for row in &self.rows {
            writer.write_record(row.iter().map(Value::text))?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}

impl Value {
    fn text(&self) -> String {
        match self {
            Self::Number(number) if !number.is_finite() => String::new(),
            Self::Number(number) if *number == 0.0 || (1e-4..1e6).contains(&number.abs()) => number.to_string(),
            Self::Number(number) => format!("{number:e}"),
            Self::Text(text) => text.clone(),
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<Option<f64>> for Value {
    fn from(number: Option<f64>) -> Self {
        Self::Number(number.unwrap_or(f64::NAN))
    }
}

impl From<usize> for Value {
    fn from(number: usize) -> Self {
        Self::Text(number.to_string())
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}
