//! `repeat`: copies of a layer in columns and rows.

use super::super::fields::Fields;
use super::super::log::Log;
use super::super::mistake::FieldMistake;
use super::super::tables;
use super::Layer;
use crate::kinds::KindName;
use crate::titles::{LayerNumber, LayerTitle};

/// The copies of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repeat {
    columns: u32,
    rows: u32,
    dx_mm: f64,
    dy_mm: f64,
}

impl Repeat {
    const ONCE: Self = Self { columns: 1, rows: 1, dx_mm: 0.0, dy_mm: 0.0 };

    /// Reads the copies of a layer.
    pub(crate) fn read(layer: &mut Fields, log: &mut Log) -> Self {
        let Some(mut fields) = layer.table(log, &tables::layer::REPEAT) else { return Self::ONCE };
        fields.rename("this repeat".to_owned());
        let columns = fields.number_or_default(log, &tables::repeat::COLUMNS) as u32;
        let rows = fields.number_or_default(log, &tables::repeat::ROWS) as u32;
        let dx_mm = fields.length_mm(log, &tables::repeat::DX).unwrap_or_default();
        let dy_mm = fields.length_mm(log, &tables::repeat::DY).unwrap_or_default();
        let has_unknown = fields.has_unread();
        let places = fields.close(log);
        for (what, step, copies, step_mm) in [("columns", "dx_mm", columns, dx_mm), ("rows", "dy_mm", rows, dy_mm)] {
            // An unknown field is probably the spacing, misspelt.
            if copies > 1 && step_mm.abs() <= 0.0 && !has_unknown {
                log.add(places.field(step), FieldMistake::RepeatInPlace { what, step });
            }
        }
        Self { columns, rows, dx_mm, dy_mm }
    }

    /// Copies of a layer, row by row. Copies of a named layer have its name and a number from one.
    pub(crate) fn of(self, layer: &Layer, kind: KindName) -> Vec<Layer> {
        if self.columns * self.rows == 1 {
            return vec![layer.clone()];
        }
        let places = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        let copies = (1..).zip(places).map(|(copy, (column, row))| {
            let (x_mm, y_mm) = (f64::from(column) * self.dx_mm, f64::from(row) * self.dy_mm);
            let mut moved = layer.clone();
            let number = LayerNumber { copy: Some(copy), ..layer.number() };
            moved.is_copy = copy > 1;
            moved.family.clone_from(&layer.name);
            moved.name = layer.name.as_ref().map(|name| format!("{name} {copy}"));
            moved.title = LayerTitle::new(number, moved.name.as_deref(), kind.word());
            moved.region = moved.region.map(|region| region.moved_by(x_mm, y_mm));
            moved.kind.move_by(x_mm, y_mm);
            moved
        });
        copies.collect()
    }
}
