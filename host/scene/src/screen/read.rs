//! Reads the fields of a screen.

use super::{Screen, Slab};
use crate::fields::{Fields, all};
use crate::log::Log;
use crate::mistake::FieldMistake;
use crate::tables::{coating, screen};

/// Largest effective gap that a board accepts ([`frixel_layers::Header::check`]).
pub(in super::super) const EFFECTIVE_GAP_MAX_UM: f64 = 10_000.0;

/// Reads a whole table, that of a file or `[screen]` of a scene.
pub(in super::super) fn read(mut fields: Fields, log: &mut Log) -> Option<Screen> {
    let name = fields.text(log, &screen::NAME);
    let width_mm = fields.number(log, &screen::WIDTH_MM);
    let height_mm = fields.number(log, &screen::HEIGHT_MM);
    let has_coating = fields.has(screen::COATING.name);
    let slabs = fields.tables(log, &screen::COATING).and_then(|slabs| coating_of(slabs, &fields, log));
    let coating = if has_coating { slabs } else { Some(vec![Slab::EXAMPLE]) };
    let voltage_max_v_rms = fields.number(log, &screen::VOLTAGE_MAX_V_RMS);
    let voltage_max_v_peak = fields.number(log, &screen::VOLTAGE_MAX_V_PEAK);
    let slew_v_per_us = fields.number(log, &screen::SLEW_V_PER_US);
    fields.close(log);
    Some(Screen {
        name,
        width_mm: width_mm?,
        height_mm: height_mm?,
        coating: coating?,
        voltage_max_v_rms,
        voltage_max_v_peak,
        slew_v_per_us,
    })
}

/// Reads slabs in series. An empty list is a mistake of the enclosing table.
fn coating_of(slabs: Vec<Fields>, around: &Fields, log: &mut Log) -> Option<Vec<Slab>> {
    if slabs.is_empty() {
        log.add(
            around.places().table(),
            FieldMistake::MissingField { field: "coating", other: None, table: around.table_name().to_owned() },
        );
    }
    let mut places = Vec::new();
    let read = |mut fields: Fields| {
        let thickness_um = fields.number(log, &coating::THICKNESS_UM);
        let permittivity = fields.number(log, &coating::PERMITTIVITY);
        places.push(fields.close(log).table());
        Some(Slab { thickness_um: thickness_um?, permittivity: permittivity? })
    };
    let slabs = all(slabs.into_iter().map(read))?;
    let place = *places.first()?;
    let found = slabs.iter().fold(0.0, |sum, slab| sum + slab.thickness_um / slab.permittivity);
    if found > EFFECTIVE_GAP_MAX_UM {
        let (field, max) = ("thickness_um / permittivity, summed", EFFECTIVE_GAP_MAX_UM);
        log.add(place, FieldMistake::OutOfRange { field, found, min: 0.0, max, unit: " um" });
    }
    Some(slabs)
}
