//! The person of bring-up, who does what the board says.
#![allow(clippy::panic, reason = "a test may fail")]

/// Whether ready is high after the person has done what was said; `None` if that does not concern it.
pub(crate) fn ready_after(said: &str) -> Option<bool> {
    let said = said.to_lowercase();
    let says = |what: &str| said.contains(what);
    if says("switch the amplifier's supply on") || says("switch it on") || says("wire to 3.3 v") {
        Some(true)
    } else if says("switch it off") || says("supply off") || says("wire off again") {
        Some(false)
    } else {
        None
    }
}

/// Whether the contact is closed after the person has done what was said.
pub(crate) fn contact_after(said: &str) -> Option<bool> {
    match said.to_lowercase() {
        said if said.contains("hold the switch.") => Some(true),
        said if said.contains("release the switch.") => Some(false),
        _ => None,
    }
}

/// What the person types, who sees `dac_v` on the voltmeter and reads `probe_v` from the oscilloscope.
pub(crate) fn answer(said: &str, dac_v: Option<f32>, probe_v: f32) -> String {
    if let Some((_, word)) = said.split_once("Then type: ") {
        return word.to_owned();
    }
    let Some((_, what)) = said.split_once("Type a number: ") else { panic!("nothing was asked: {said}") };
    match what {
        what if what.contains("series resistor") => "67.5".to_owned(),
        what if what.contains("kOhm") => "9.9".to_owned(),
        what if what.contains("MOhm") => "999".to_owned(),
        what if what.contains("voltmeter") => dac_v.unwrap_or(0.0).to_string(),
        what if what.contains("probe") => probe_v.to_string(),
        what if what.contains("at the capacitor") => "44.5".to_owned(),
        what if what.contains("at the monitor") => " 8.5 ".to_owned(),
        what => panic!("nobody knows this: {what}"),
    }
}
