//! The units of columns, and how a header states them.

/// A unit that a header may state in place of the caller's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale {
    /// As it is written, such as `mN`.
    symbol: &'static str,
    /// As it is spoken, such as `millinewtons`.
    pub(super) words: &'static str,
    /// The power of ten that it has of the first unit of its list.
    power: i32,
}

const fn scale(symbol: &'static str, words: &'static str, power: i32) -> Scale {
    Scale { symbol, words, power }
}

const VOLTAGES: &[Scale] = &[scale("V", "volts", 0), scale("mV", "millivolts", -3), scale("kV", "kilovolts", 3)];
const FORCES: &[Scale] = &[
    scale("N", "newtons", 0),
    scale("mN", "millinewtons", -3),
    scale("cN", "centinewtons", -2),
    scale("uN", "micronewtons", -6),
    scale("kN", "kilonewtons", 3),
];
const TIMES: &[Scale] = &[scale("s", "seconds", 0), scale("ms", "milliseconds", -3), scale("us", "microseconds", -6)];
const LENGTHS: &[Scale] = &[
    scale("m", "metres", 0),
    scale("mm", "millimetres", -3),
    scale("cm", "centimetres", -2),
    scale("um", "micrometres", -6),
    scale("nm", "nanometres", -9),
];
const SPEEDS: &[Scale] = &[scale("m/s", "m/s", 0), scale("mm/s", "mm/s", -3), scale("cm/s", "cm/s", -2)];

/// The unit that a caller expects for a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// All units of the quantity.
    scales: &'static [Scale],
    /// The power of ten that this one has of the first of them.
    power: i32,
}

/// A unit of each quantity.
const ALL: [Unit; 5] = [Unit::VOLTS, Unit::NEWTONS, Unit::SECONDS, Unit::METRES, Unit::MILLIMETRES_PER_SECOND];

impl Unit {
    /// Volts.
    pub const VOLTS: Self = Self { scales: VOLTAGES, power: 0 };
    /// Newtons.
    pub const NEWTONS: Self = Self { scales: FORCES, power: 0 };
    /// Seconds.
    pub const SECONDS: Self = Self { scales: TIMES, power: 0 };
    /// Metres.
    pub const METRES: Self = Self { scales: LENGTHS, power: 0 };
    /// Millimetres.
    pub const MILLIMETRES: Self = Self { scales: LENGTHS, power: -3 };
    /// Millimetres per second.
    pub const MILLIMETRES_PER_SECOND: Self = Self { scales: SPEEDS, power: -3 };

    /// The power of ten by which a number in `scale` is multiplied.
    pub(super) fn power_from(self, scale: Scale) -> i32 {
        scale.power - self.power
    }

    /// This unit as a scale.
    fn own(self) -> Option<Scale> {
        self.scales.iter().find(|scale| scale.power == self.power).copied()
    }
}

impl Scale {
    /// As it stands in the name of a column: `mm_s` for mm/s.
    fn in_names(self) -> String {
        self.symbol.to_lowercase().replace('/', "_")
    }
}

/// How a header relates to a requested column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Named {
    /// It is another column.
    Other,
    /// It is the column, in this unit.
    In(Scale),
    /// It is the column, and its unit can be read in two ways.
    Doubtful { readings: [String; 2], advice: String },
}

/// The name of a column in parts: `voltage_v_rms` is `voltage`, volts, and `_rms`.
struct Parts<'n> {
    stem: &'n str,
    rest: &'n str,
}

impl<'n> Parts<'n> {
    fn of(name: &'n str, unit: Unit) -> Option<Self> {
        let suffix = format!("_{}", unit.own()?.in_names());
        let (stem, rest) = name.rsplit_once(&suffix)?;
        (rest.is_empty() || rest.starts_with('_')).then_some(Self { stem, rest })
    }

    fn name(&self, scale: Scale) -> String {
        format!("{}_{}{}", self.stem, scale.in_names(), self.rest)
    }

    /// The unit in words with the rest of the name: `volts rms`.
    fn words(&self, scale: Scale) -> String {
        format!("{}{}", scale.words, self.rest.replace('_', " "))
    }
}

/// A unit as a header writes it.
enum Written {
    Sure(Scale),
    /// All in capitals, where M is mega and m is milli.
    MegaOrMilli(Scale),
}

impl Written {
    fn of(text: &str, unit: Unit) -> Option<Self> {
        let text = text.replace(['\u{b5}', '\u{3bc}'], "u");
        let text = text.replace("_s", "/s");
        let scale = unit.scales.iter().find(|scale| scale.symbol.eq_ignore_ascii_case(&text)).copied()?;
        let is_doubtful = text.starts_with('M') && matches!(scale.symbol, "mV" | "mN");
        Some(if is_doubtful { Self::MegaOrMilli(scale) } else { Self::Sure(scale) })
    }
}

/// Whether a text is a unit, alone or in brackets.
pub(super) fn is_unit(text: &str) -> bool {
    let text = without_brackets(text);
    let (text, _) = without_rest(text, "_rms");
    ALL.iter().any(|unit| Written::of(text, *unit).is_some())
}

/// A unit without its brackets.
pub(super) fn without_brackets(text: &str) -> &str {
    let brackets = [('[', ']'), ('(', ')')].into_iter();
    let mut inside = brackets.filter_map(|(open, close)| text.strip_prefix(open)?.strip_suffix(close));
    inside.next().unwrap_or(text).trim()
}

/// The note about a header's column `name` in `unit`.
///
/// It may state another unit in the name (`friction_mn`), or in brackets or after a stroke, as instruments and papers
/// do: `friction [mN]`, `Friction (mN)`, `friction / mN`.
pub(super) fn named(header: &str, name: &str, unit: Unit) -> Named {
    let Some(parts) = Parts::of(name, unit) else { return Named::Other };
    let (label, bracket) = split(header);
    let Some(label) = Label::of(label, &parts, unit) else { return Named::Other };
    let (bracket, bracket_says_rest) = match bracket {
        None => (None, false),
        Some(text) => {
            let (text, says_rest) = without_rest(text, parts.rest);
            let Some(written) = Written::of(text, unit) else { return Named::Other };
            (Some(written), says_rest)
        }
    };
    let scales: Vec<Written> = label.unit.into_iter().chain(bracket).collect();
    for written in &scales {
        if let Written::MegaOrMilli(scale) = written {
            let readings = [scale.words.to_owned(), scale.words.replace("milli", "mega")];
            let own = unit.own().unwrap_or(*scale);
            let advice = format!("name it {}, or convert it and name it {}", parts.name(*scale), parts.name(own));
            return Named::Doubtful { readings, advice };
        }
    }
    let mut scales = scales.into_iter().map(|(Written::Sure(scale) | Written::MegaOrMilli(scale))| scale);
    let Some(scale) = scales.next() else { return Named::Other };
    if let Some(other) = scales.next().filter(|other| *other != scale) {
        let each = [scale, other];
        let [one, two] = each.map(|scale| parts.name(scale));
        return Named::Doubtful {
            readings: each.map(|scale| parts.words(scale)),
            advice: format!("name it {one} or {two}"),
        };
    }
    if label.says_rest || bracket_says_rest {
        return Named::In(scale);
    }
    // What is missing is `_rms` or `_peak`.
    let said = parts.rest.trim_start_matches('_');
    let other = if said == "rms" { "peak" } else { "rms" };
    let readings = [parts.words(scale), format!("{} {other}", scale.words)];
    let advice = format!("name it {} if it is {said}, and convert it otherwise", parts.name(scale));
    Named::Doubtful { readings, advice }
}

/// The name of a column in its own unit, or in the unit of the header, in words.
pub(super) fn words(name: &str, unit: Unit, scale: Scale) -> String {
    Parts::of(name, unit).map_or_else(|| scale.words.to_owned(), |parts| parts.words(scale))
}

/// A header without its unit in brackets or after a stroke, and that unit.
fn split(header: &str) -> (&str, Option<&str>) {
    let header = header.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((label, unit)) = header.strip_suffix(close).and_then(|text| text.rsplit_once(open)) {
            return (label.trim(), Some(unit.trim()));
        }
    }
    match header.rsplit_once(" / ") {
        Some((label, unit)) => (label.trim(), Some(unit.trim())),
        None => (header, None),
    }
}

/// A unit without `rms`, where the column's name has it, and whether it was there.
fn without_rest<'t>(text: &'t str, rest: &str) -> (&'t str, bool) {
    let word = rest.trim_start_matches('_');
    let start = text.len().saturating_sub(word.len());
    match text.split_at_checked(start) {
        Some((unit, end)) if !word.is_empty() && end.eq_ignore_ascii_case(word) => {
            (unit.trim_end_matches([' ', '_']), true)
        }
        _ => (text, false),
    }
}

/// The name before a unit in brackets.
struct Label {
    /// A unit in the name itself.
    unit: Option<Written>,
    /// Whether it has the ending of the column's name behind the unit, such as `_rms`.
    says_rest: bool,
}

impl Label {
    fn of(text: &str, parts: &Parts, unit: Unit) -> Option<Self> {
        let text = text.replace([' ', '-'], "_");
        let (stem, end) = text.split_at_checked(parts.stem.len())?;
        if !stem.eq_ignore_ascii_case(parts.stem) {
            return None;
        }
        let (end, says_rest) = without_rest(end, parts.rest);
        let says_rest = says_rest || parts.rest.is_empty();
        let unit = match end.strip_prefix('_') {
            Some(symbol) => Some(Written::of(symbol, unit)?),
            None if end.is_empty() => None,
            None => return None,
        };
        Some(Self { unit, says_rest })
    }
}

#[cfg(test)]
mod tests {
    use super::{Named, Unit, named};

    fn power(header: &str, name: &str, unit: Unit) -> Option<i32> {
        match named(header, name, unit) {
            Named::In(scale) => Some(unit.power_from(scale)),
            Named::Other | Named::Doubtful { .. } => None,
        }
    }

    #[test]
    fn a_header_states_its_unit_in_the_name_in_brackets_or_after_a_stroke() {
        for (header, expected) in [
            ("friction_n", 0),
            ("friction_mn", -3),
            ("friction_mN", -3),
            ("Friction [mN]", -3),
            ("friction (N)", 0),
            ("friction / uN", -6),
            ("friction (\u{b5}N)", -6),
            ("friction_mn [mN]", -3),
        ] {
            assert_eq!(power(header, "friction_n", Unit::NEWTONS), Some(expected), "{header}");
        }
        for (header, expected) in
            [("voltage_kv_rms", 3), ("voltage_rms [kV]", 3), ("Voltage [V rms]", 0), ("voltage (mVrms)", -3)]
        {
            assert_eq!(power(header, "voltage_v_rms", Unit::VOLTS), Some(expected), "{header}");
        }
        assert_eq!(power("Normal force (mN)", "normal_force_n", Unit::NEWTONS), Some(-3));
        assert_eq!(power("speed_m_s", "speed_mm_s", Unit::MILLIMETRES_PER_SECOND), Some(3));
        assert_eq!(power("speed [cm/s]", "speed_mm_s", Unit::MILLIMETRES_PER_SECOND), Some(1));
        assert_eq!(power("x [m]", "x_mm", Unit::MILLIMETRES), Some(3));
        assert_eq!(power("t_ms", "t_s", Unit::SECONDS), Some(-3));
        assert_eq!(power("radius_um", "radius_m", Unit::METRES), Some(-6));
    }

    #[test]
    fn other_columns_are_not_taken() {
        for header in
            ["friction", "friction_kg", "frictions_n", "friction_n_raw", "electric_friction_n", "friction []", ""]
        {
            assert_eq!(named(header, "friction_n", Unit::NEWTONS), Named::Other, "{header}");
        }
        assert_eq!(named("voltage_v_peak", "voltage_v_rms", Unit::VOLTS), Named::Other);
        assert_eq!(named("gr\u{f6}\u{df}e", "friction_n", Unit::NEWTONS), Named::Other);
    }
}
