//! Mistakes of a scene that does not fit its screen, its finger or the board.

use thiserror::Error;

/// A scene asks for more than screen, finger and board have.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum FitMistake {
    /// The scene has more of something than the board supports.
    #[error("this is number {number} of the scene's {what}, but a board supports at most {max}: remove some")]
    TooMany { what: &'static str, number: usize, max: usize },
    /// The drive exceeds the measured range of the finger's empirical law.
    #[error(
        "the drive goes up to {found_v_rms} V rms, but this finger was measured only up to {measured_v_rms} V rms: \
         leave `voltage_max_v_rms` out, and the drive ends there"
    )]
    BeyondLaw { found_v_rms: f64, measured_v_rms: f64 },
    /// A region extends past the screen.
    #[error(
        "{layer} reaches {beyond_mm} mm past the {edge} edge of the {screen_width_mm} mm x {screen_height_mm} mm screen: \
         move it or make it smaller"
    )]
    OffScreen { layer: String, edge: &'static str, beyond_mm: f64, screen_width_mm: f64, screen_height_mm: f64 },
    /// The target friction of a layer is more than the drive can give. `raise` has the fields of `[drive]` whose
    /// increase to these values reaches the target. It is empty if other limits forbid it, or if the amounts are
    /// fractions, which scale with the voltage.
    #[error(
        "{asking} up to {target_n} N {reference}{}, and at {voltage_v_rms} V rms this finger feels at most {reach_n} N \
         {reference}: {}{cure}, {}or write `saturate = true` under [drive] to have it clamped",
        .part_of_reach.map_or(String::new(), |part| format!(" ({part} of the reach)")),
        if *.may_be_millinewtons { "were mN meant? 1 mN is 0.001 N; " } else { "" },
        raised(.raise),
    )]
    AboveReach {
        asking: String,
        target_n: f64,
        reference: &'static str,
        part_of_reach: Option<f64>,
        voltage_v_rms: f64,
        reach_n: f64,
        cure: Box<str>,
        raise: Vec<(&'static str, f64)>,
        may_be_millinewtons: bool,
    },
    /// The target friction of a layer is less than the friction at no voltage.
    #[error(
        "{asking} down to {target_n} N {reference}, but a drive can only add to the finger's natural friction of \
         {natural_n} N: {cure}, or write `saturate = true` under [drive] to have it clamped"
    )]
    BelowNatural { asking: String, target_n: f64, reference: &'static str, natural_n: f64, cure: &'static str },
    /// The scene has more layers than the board takes.
    #[error(
        "the scene has {count} layers{}, but the board supports {max}: remove some or draw them into one picture",
        if *.has_copies { ", each copy of a `repeat` counted" } else { "" }
    )]
    TooManyLayers { count: usize, has_copies: bool, max: usize },
    /// The tick exceeds its time limit at some place. The layers overlap there (`meet`), or they only share a cell of
    /// the grid.
    #[error(
        "{layers} {} at x {x_mm} mm, y {y_mm} mm: a tick there is estimated at {cycles} cycles, and the board has time for \
         {cycles_max}: {}",
        match (*.alone, *.meet) {
            (true, _) => "takes too long",
            (false, true) => "overlap",
            (false, false) => "lie too close together",
        },
        if *.alone { "use another kind of layer, or another board" } else { "move layers apart, or leave some out" }
    )]
    TickTooLong { cycles: u32, cycles_max: u32, layers: String, alone: bool, meet: bool, x_mm: f64, y_mm: f64 },
    /// The pictures need more memory than the board has for them.
    #[error(
        "the pictures up to this one need {needed_bytes} bytes, and the board has {pool_bytes}: \
         a pitch_mm of {pitch_mm} would fit"
    )]
    PoolTooSmall { needed_bytes: u64, pool_bytes: u32, pitch_mm: f64 },
    /// The peak voltage is above the board's limit.
    #[error(
        "`voltage_max_v_peak = {found}` is above the board's limit of {board} V peak{why}: lower it or leave it out"
    )]
    PeakAboveBoard { found: f64, board: f64, why: &'static str },
    /// The carrier is too fast for the board's tick.
    #[error("`frequency_hz = {found}` is too fast for {tick_hz} ticks a second: expected 125 to {max} Hz")]
    CarrierTooFast { found: f64, tick_hz: u32, max: f64 },
    /// The current into the electrode is above the board's limit.
    #[error(
        "this carrier drives {found_ma:.2} mA {kind} into the board's worst-case electrode, and its limit is \
         {board_ma:.2} mA: lower {cure}"
    )]
    CurrentAboveBoard { kind: &'static str, found_ma: f64, board_ma: f64, cure: &'static str },
    /// The contact at the largest voltage is wider than the finger.
    #[error(
        "at {voltage_v_rms:.1} V rms the contact would have a radius of {contact_mm:.1} mm under a finger of {radius_mm} mm, \
         where the model is not valid: a skin gap is missing, since {gap_um:.2} um between electrode and finger is too \
         little; give the finger a `skin_gap_um` of a few micrometres, or lower `voltage_max_v_rms`"
    )]
    ContactWiderThanFinger { voltage_v_rms: f64, contact_mm: f64, radius_mm: f64, gap_um: f64 },
    /// Linear springs cannot approximate the soft finger.
    #[error(
        "a board plays linear springs, and the closest ones differ from this soft finger by {found_percent:.1} % of \
         the reach, more than {max_percent} %: lower `voltage_max_v_rms`, or give the finger `stiffness_pa_per_m`"
    )]
    SoftFinger { found_percent: f64, max_percent: f64 },
    /// The contact model or its table refuses the combination of numbers, each of which is in range.
    #[error("this finger on this coating cannot be played ({reason}): check finger, coating and `voltage_max_v_rms`")]
    Model { reason: String },
}

/// The limits to raise, as advice.
fn raised(limits: &[(&str, f64)]) -> String {
    let limits: Vec<String> = limits.iter().map(|(field, to)| format!("`{field}` to {to}")).collect();
    if limits.is_empty() { String::new() } else { format!("raise {}, ", limits.join(" and ")) }
}
