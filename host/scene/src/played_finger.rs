//! The finger of a program, and the evidence for its parameters.

use super::finger::{Evidence, Origin};
use super::printable::printable;
use super::scene_profiles::{ProfileSource, Profiles};

/// The finger for which a program is compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlayedFinger {
    /// The finger in messages: for example `the example finger`.
    pub title: String,
    /// Evidence for its newtons on the program's screen.
    pub origin: Origin,
}

impl PlayedFinger {
    /// The finger of a scene. A profile measured on another screen counts as assumed, with a note.
    pub(super) fn of(profiles: &Profiles) -> (Self, Option<String>) {
        let title = match &profiles.finger_source {
            ProfileSource::Option(name) | ProfileSource::Named(name) => format!("finger \"{name}\""),
            ProfileSource::Embedded => "the scene's finger".to_owned(),
            ProfileSource::Example => "the example finger".to_owned(),
        };
        let evidence = &profiles.finger.evidence;
        let other =
            evidence.experiment().filter(|experiment| profiles.screen.name.as_ref() != Some(&experiment.screen));
        let Some(experiment) = other else { return (Self { title, origin: evidence.origin() }, None) };
        let screen = match &profiles.screen.name {
            Some(name) => format!("\"{name}\""),
            None => "a screen without a `name`".to_owned(),
        };
        let note = format!(
            "{title} was {} on screen \"{}\" and is played on {screen}: it counts as assumed",
            verb(evidence),
            printable(&experiment.screen)
        );
        (Self { title, origin: Origin::Assumed }, Some(note))
    }
}

fn verb(evidence: &Evidence) -> &'static str {
    match evidence.origin() {
        Origin::Measured | Origin::Empirical => "measured",
        Origin::Assumed | Origin::Perceptual => "fitted",
    }
}
