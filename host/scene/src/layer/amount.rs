//! What a layer asks for, in one of three units that stand in the field's name.

use frixel_layers::range;

use super::super::fields::{Fields, Range};
use super::super::log::Log;
use super::super::mistake::Mistake;
use super::super::source::Places;

const FRICTION_N: Range = Range::new(range::FRICTION_N.min, range::FRICTION_N.max, " N");
const FRACTION: Range = Range::new(-1.0, 1.0, "");
pub(crate) const FACTOR: Range = Range::new(range::FRICTION_N.min, range::FRICTION_N.max, "");

/// What a layer asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Amount {
    /// Friction, N.
    Newtons(f64),
    /// A fraction of the most that the drive can add here.
    Fraction(f64),
    /// A plain factor, of a layer that is multiplied.
    Factor(f64),
}

/// What the amounts of a layer may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Newtons or fractions.
    Friction,
    /// Factors.
    Factor,
}

/// The fields that an amount may stand in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Names {
    pub(crate) newtons: &'static str,
    pub(crate) fraction: &'static str,
    pub(crate) factor: &'static str,
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
    pub(crate) const FRICTION: Self = names!("friction");
    pub(crate) const LOW: Self = names!("low");
    pub(crate) const HIGH: Self = names!("high");
    pub(crate) const BLACK: Self = names!("black");
    pub(crate) const WHITE: Self = names!("white");
    pub(crate) const RIDGE: Self = names!("ridge");
    pub(crate) const RIM: Self = names!("rim");
    pub(crate) const FACE: Self = names!("face");
    pub(crate) const CLICK: Self = names!("click");

    /// All names, so that the one in use can be found among a layer's fields.
    pub(crate) fn all(self) -> [&'static str; 3] {
        [self.newtons, self.fraction, self.factor]
    }
}

impl Amount {
    /// Reads an amount that has to be there.
    pub(crate) fn read(fields: &mut Fields, names: Names, unit: Unit, log: &mut Log) -> Option<Self> {
        match unit {
            Unit::Factor => fields.require(names.factor),
            Unit::Friction if !fields.has(names.fraction) => fields.require(names.newtons),
            Unit::Friction => {}
        }
        Self::optional(fields, names, unit, log)
    }

    /// Reads an amount that may be left out.
    pub(crate) fn optional(fields: &mut Fields, names: Names, unit: Unit, log: &mut Log) -> Option<Self> {
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

/// The least and the largest amount of a layer that varies between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LowHigh {
    pub(crate) low: Amount,
    pub(crate) high: Amount,
}

impl LowHigh {
    pub(crate) fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let low = Amount::read(fields, Names::LOW, unit, log);
        let high = Amount::read(fields, Names::HIGH, unit, log);
        Some(Self { low: low?, high: high? })
    }

    /// Finds a least amount that is above the largest.
    pub(crate) fn check(self, places: &Places, log: &mut Log) {
        if self.low.is_above(self.high) {
            let (low_name, high_name) = (places.first_of(Names::LOW.all()), places.first_of(Names::HIGH.all()));
            let (low, high) = (self.low.number(), self.high.number());
            log.add(places.field(low_name), Mistake::LowAboveHigh { low_name, low, high_name, high });
        }
    }

    /// The field of the largest amount, or of the least.
    pub(crate) fn extreme(most: bool, places: &Places) -> &'static str {
        places.first_of(if most { Names::HIGH } else { Names::LOW }.all())
    }
}
