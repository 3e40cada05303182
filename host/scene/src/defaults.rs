//! `[defaults]`: checks the shared fields of layers, used or not.

use toml::de::DeTable;

use super::fields::{Fields, PixelSize};
use super::kinds::KindName;
use super::layer;
use super::log::Log;
use super::mistake::FieldMistake;
use super::nearest::Nearest;
use super::stack::LAYER_FIELDS;
use super::tables::layer::{KIND, NAME};

/// The table in messages.
const TABLE: &str = "[defaults]";

/// Refuses defaults that no kind of layer has, and returns the valid names that they probably stand for.
pub(super) fn check_names(defaults: &DeTable, log: &mut Log) -> Vec<String> {
    let mut meant = Vec::new();
    for name in defaults.keys() {
        let (place, field) = (name.span().start, name.get_ref());
        if *field == NAME.name {
            log.add(place, FieldMistake::NoDefault { field: NAME.name });
        } else if !LAYER_FIELDS.iter().any(|known| *field == known.field.name) {
            let nearest = Nearest::new(field, LAYER_FIELDS.iter().map(|known| known.field.name));
            meant.extend(nearest.suggestion.clone());
            let field = field.clone().into_owned();
            log.add(place, FieldMistake::UnknownField { field, table: TABLE.to_owned(), nearest });
        }
    }
    meant
}

/// Refuses default values that no kind of layer accepts. A layer that uses the default has the same mistake.
pub(super) fn check_values(defaults: &DeTable, pixel_mm: Option<PixelSize>, log: &mut Log) {
    for (name, value) in defaults {
        let mut refused = None;
        let mut is_taken = false;
        let kinds = KindName::ALL.iter().flat_map(|(_, kind)| layer::UNITS.map(|unit| (*kind, unit)));
        for (kind, unit) in kinds {
            let mut scratch = log.scratch();
            let only = DeTable::from_iter([(name.clone(), value.clone())]);
            let mut fields = Fields::new(TABLE, name.span().start, only).with_pixels(pixel_mm);
            let _ = fields.choice(&mut scratch, &KIND, KindName::ALL);
            layer::read_fields(&mut fields, kind, unit, &mut scratch);
            if fields.has(name.get_ref()) {
                // The kind does not have this field.
                continue;
            }
            if scratch.mistakes() == 0 {
                is_taken = true;
                break;
            }
            refused.get_or_insert(scratch);
        }
        if let Some(scratch) = refused.filter(|_| !is_taken) {
            log.extend(scratch);
        }
    }
}
