//! Target amount of a layer, in one of three units; the field's name states the unit.

use super::super::fields::Fields;
use super::super::grammar::AmountFields;
use super::super::log::Log;
use super::super::mistake::FieldMistake;
use super::super::source::Places;
use super::super::tables::{HIGH, LOW};

/// The target amount of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Amount {
    /// Friction, N.
    Newtons(f64),
    /// A fraction of the largest friction that the drive can add here.
    Fraction(f64),
    /// A factor, for a layer that multiplies the layers below it.
    Factor(f64),
}

/// The units that the amounts of a layer may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Newtons or fractions.
    Friction,
    /// Factors.
    Factor,
}

/// All units.
pub(crate) const UNITS: [Unit; 2] = [Unit::Friction, Unit::Factor];

impl Amount {
    /// Reads an amount, in the unit of the layer's amounts.
    pub(crate) fn read(fields: &mut Fields, amount: &AmountFields, unit: Unit, log: &mut Log) -> Option<Self> {
        let AmountFields { newtons, fraction, factor } = amount;
        if unit == Unit::Factor {
            return fields.number(log, factor).map(Self::Factor);
        }
        let [newtons, fraction] = fields.in_either_unit(log, newtons, fraction);
        let newtons = fields.number(log, &newtons).map(Self::Newtons);
        let fraction = fields.number(log, &fraction).map(Self::Fraction);
        newtons.or(fraction)
    }

    /// Whether this amount is larger than another one; `false` if the two cannot be compared.
    pub(crate) fn is_above(self, other: Self) -> bool {
        match (self, other) {
            (Self::Newtons(one), Self::Newtons(other))
            | (Self::Fraction(one), Self::Fraction(other))
            | (Self::Factor(one), Self::Factor(other)) => one > other,
            _ => false,
        }
    }

    pub(crate) fn number(self) -> f64 {
        match self {
            Self::Newtons(number) | Self::Fraction(number) | Self::Factor(number) => number,
        }
    }
}

/// The least and the largest amount of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LowHigh {
    pub(crate) low: Amount,
    pub(crate) high: Amount,
}

impl LowHigh {
    /// Reads both, and reports a mistake if the least amount is above the largest.
    pub(crate) fn read(
        fields: &mut Fields,
        [low, high]: [&AmountFields; 2],
        unit: Unit,
        log: &mut Log,
    ) -> Option<Self> {
        let read = [low, high].map(|amount| Amount::read(fields, amount, unit, log));
        let [Some(least), Some(largest)] = read else { return None };
        if least.is_above(largest) {
            let places = fields.places();
            let (low_name, high_name) = (places.first_of(low.names()), places.first_of(high.names()));
            let (low, high) = (least.number(), largest.number());
            log.add(places.field(low_name), FieldMistake::LowAboveHigh { low_name, low, high_name, high });
        }
        Some(Self { low: least, high: largest })
    }

    /// The field of the largest amount, or of the least.
    pub(crate) fn extreme(most: bool, places: &Places) -> &'static str {
        places.first_of(if most { HIGH } else { LOW }.names())
    }
}
