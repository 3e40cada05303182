//! What a layer asks for, in one of three units that stand in the field's name.

use super::super::fields::{Fields, Range};
use super::super::log::Log;
use super::super::mistake::Mistake;

const FRICTION_N: Range = Range::new(-100.0, 100.0, " N");
const FRACTION: Range = Range::new(-1.0, 1.0, "");
pub(super) const FACTOR: Range = Range::new(-100.0, 100.0, "");

/// What a layer asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) enum Amount {
    /// Friction, N.
    Newtons(f64),
    /// A fraction of the most that the drive can add here.
    Fraction(f64),
    /// A plain factor, of a layer that is multiplied.
    Factor(f64),
}

/// What the amounts of a layer may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Newtons or fractions.
    Friction,
    /// Factors.
    Factor,
}

/// The fields that an amount may stand in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Names {
    pub(super) newtons: &'static str,
    pub(super) fraction: &'static str,
    pub(super) factor: &'static str,
}

macro_rules! names {
    ($stem:literal) => {
        Names {
            newtons: concat!($stem, "_n"),
            fraction: concat!($stem, "_fraction"),
            factor: concat!($stem, "_factor"),
        }
    };
}

impl Names {
    pub(super) const FRICTION: Self = names!("friction");
    pub(super) const LOW: Self = names!("low");
    pub(super) const HIGH: Self = names!("high");
    pub(super) const BLACK: Self = names!("black");
    pub(super) const WHITE: Self = names!("white");
    pub(super) const RIDGE: Self = names!("ridge");
    pub(super) const RIM: Self = names!("rim");
    pub(super) const FACE: Self = names!("face");
    pub(super) const CLICK: Self = names!("click");

    /// All names, so that the one in use can be found among a layer's fields.
    pub(super) fn all(self) -> [&'static str; 3] {
        [self.newtons, self.fraction, self.factor]
    }
}

impl Amount {
    /// Reads an amount that has to be there.
    pub(super) fn read(fields: &mut Fields, names: Names, unit: Unit, log: &mut Log) -> Option<Self> {
        match unit {
            Unit::Factor => fields.require(names.factor),
            Unit::Friction if !fields.has(names.fraction) => fields.require(names.newtons),
            Unit::Friction => {}
        }
        Self::optional(fields, names, unit, log)
    }

    /// Reads an amount that may be left out.
    pub(super) fn optional(fields: &mut Fields, names: Names, unit: Unit, log: &mut Log) -> Option<Self> {
        if unit == Unit::Factor {
            return fields.optional_number(log, names.factor, FACTOR).map(Self::Factor);
        }
        fields.either(names.newtons, names.fraction);
        if fields.has(names.newtons) && fields.has(names.fraction) {
            let mistake = Mistake::TwoUnits { one: names.newtons, other: names.fraction };
            log.add(fields.place(names.fraction), mistake);
        }
        let newtons = fields.optional_number(log, names.newtons, FRICTION_N).map(Self::Newtons);
        let fraction = fields.optional_number(log, names.fraction, FRACTION).map(Self::Fraction);
        newtons.or(fraction)
    }

    /// Whether it is more than another amount, where that can be told.
    pub(super) fn is_above(self, other: Self) -> bool {
        match (self, other) {
            (Self::Newtons(one), Self::Newtons(other))
            | (Self::Fraction(one), Self::Fraction(other))
            | (Self::Factor(one), Self::Factor(other)) => one > other,
            _ => false,
        }
    }

    pub(super) fn number(self) -> f64 {
        match self {
            Self::Newtons(number) | Self::Fraction(number) | Self::Factor(number) => number,
        }
    }
}
