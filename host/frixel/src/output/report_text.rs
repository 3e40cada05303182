//! The lines of a report.

use frixel_felt::check::feel::{self, Line};
use frixel_felt::judge::Judgement;
use frixel_felt::metrics::ErrorSize;
use frixel_felt::recorder::JUDGED_MAX_S;
use frixel_scene::{LayerTitle, Origin, fold_copies};

use super::report::Report;

impl Report {
    /// The report as lines of text, each ending in a line feed: what the finger felt, and the friction error. With
    /// `verbose`, everything else comes first.
    pub(crate) fn summary(&self, verbose: bool) -> String {
        let mut lines = Vec::new();
        lines.extend(self.draft.then(|| ("draft", draft_line(self.board_refuses.len()))));
        if verbose {
            lines.extend(self.world_lines());
            lines.extend(self.friction_lines());
            lines.extend(self.board_lines());
        }
        lines.extend(self.stream_line().filter(|_| verbose || self.stream_has_holes()));
        lines.extend(self.felt_lines());
        let error = size(self.friction_error_rms_n, self.friction_error_max_n);
        lines.extend(if verbose { self.error_line("friction error", error) } else { self.error_in_percent(error) });
        feel::text(&lines)
    }

    /// The friction error in percent of what the drive can add.
    fn error_in_percent(&self, error: Option<ErrorSize>) -> Option<Line> {
        let percent = self.percent_of_range(error?.rms_n);
        let decimals = usize::from(percent < 10.0);
        Some(("friction error", format!("{percent:.decimals$} % of what the drive can add, rms")))
    }

    fn percent_of_range(&self, friction_n: f64) -> f64 {
        100.0 * friction_n / (self.reachable_max_n - self.reachable_min_n)
    }

    fn world_lines(&self) -> Vec<Line> {
        let world = self.world.map(|world| {
            let (name, description) = world.description();
            ("world", format!("{name}: {description}"))
        });
        let source = self.touch_source.map(|source| ("touch source", source.to_string()));
        let finger = self.finger_seed.map(|seed| {
            ("finger", format!("random person {seed}, assumed; the board computes for the scene's finger"))
        });
        [world, source, finger].into_iter().flatten().collect()
    }

    fn friction_lines(&self) -> Vec<Line> {
        let suffix = Origin::newtons_suffix_of(self.finger_origin);
        let range = |least: f64, most: f64| format!("{:.2} to {:.2} mN{suffix}", 1e3 * least, 1e3 * most);
        let mismatch = size(self.load_mismatch_rms_n, self.load_mismatch_max_n).filter(|error| error.max_n > 0.0);
        let (at_load, with_load) = match mismatch {
            Some(_) => (", at the load of the scene's finger", ", at the load of the finger that plays"),
            None => ("", ""),
        };
        let reachable = ("reachable", range(self.reachable_min_n, self.reachable_max_n) + at_load);
        let reference = self.reference_min_n.zip(self.reference_max_n).map(|(least, most)| {
            let turns = if self.world.is_some() { "; not where the finger lands or turns" } else { "" };
            ("reference", format!("{}{with_load}{turns}", range(least, most)))
        });
        let inversion = size(self.inversion_error_rms_n, self.inversion_error_max_n);
        let mismatch = mismatch.map(|ErrorSize { rms_n, max_n }| {
            let in_mn = format!("{:.4} mN rms, {:.4} mN at most", 1e3 * rms_n, 1e3 * max_n);
            ("load mismatch", format!("{in_mn}, for another load than the profile's; not in the friction error"))
        });
        let ripple = self.carrier_ripple_rms_n.map(|rms_n| ("carrier ripple", format!("{:.4} mN rms", 1e3 * rms_n)));
        [Some(reachable), reference, self.error_line("inversion error", inversion), mismatch, ripple]
            .into_iter()
            .flatten()
            .collect()
    }

    /// An error, also relative to the reachable electric range.
    fn error_line(&self, name: &'static str, error: Option<ErrorSize>) -> Option<Line> {
        let ErrorSize { rms_n, max_n } = error?;
        let in_mn = format!("{:.4} mN rms, {:.4} mN at most", 1e3 * rms_n, 1e3 * max_n);
        Some((
            name,
            format!(
                "{in_mn} ({:.3} % and {:.3} % of the range)",
                self.percent_of_range(rms_n),
                self.percent_of_range(max_n)
            ),
        ))
    }

    fn board_lines(&self) -> Vec<Line> {
        let saturated = self.saturated_ticks.map(|ticks| format!(", of which saturated {ticks}"));
        let unreported = match self.unreported_ticks {
            0 => String::new(),
            ticks => format!(", before the first touch report {ticks}"),
        };
        let slewing = match self.slewing_ticks {
            None | Some(0) => String::new(),
            Some(ticks) => format!(", at the slew limit {ticks} (no inversion error)"),
        };
        let ticks = format!("{}{}{slewing}{unreported}", self.ticks, saturated.unwrap_or_default());
        let link = format!(
            "{} frames sent, {} rejected, {} payload bytes in {}",
            self.frames_sent, self.frames_rejected, self.payload_bytes, self.wire_bytes
        );
        let speed = self.realtime_factor.map(|factor| {
            let decimals = if factor < 10.0 { 2 } else { 0 };
            ("speed", format!("{factor:.decimals$} times real time"))
        });
        [("ticks", ticks), ("link", link)].into_iter().chain(speed).collect()
    }

    fn stream_line(&self) -> Option<Line> {
        let (samples, underruns, gaps) = (self.stream_samples?, self.stream_underruns?, self.stream_gaps?);
        Some(("stream", format!("{samples} samples, {underruns} underruns, {gaps} gaps")))
    }

    fn stream_has_holes(&self) -> bool {
        self.stream_underruns.is_some_and(|count| count > 0) || self.stream_gaps.is_some_and(|count| count > 0)
    }

    /// The verdict on each layer, or the reason for which there is none.
    fn felt_lines(&self) -> Vec<Line> {
        let verdicts = self.in_this_play.as_deref();
        let no_verdict = match verdicts {
            Some([]) if self.starts_off.is_none() => Some(
                "the finger slid on no layer for long enough while the board drove: slide over a layer, more slowly",
            ),
            Some([]) => Some("no layer was on under the finger for long enough"),
            _ => self.no_verdict,
        };
        let no_verdict = no_verdict.map(|why| ("in this play", format!("no verdict: {why}")));
        let mut lines: Vec<Line> = no_verdict.into_iter().collect();
        let judgement = Judgement { layers: verdicts.unwrap_or_default().to_vec(), ..Judgement::default() };
        lines.extend(feel::lines(&judgement).into_iter().map(|(name, text)| match name {
            "more" | "note" => (name, text),
            verdict => ("in this play", format!("{verdict}: {text}")),
        }));
        if verdicts.is_some() && self.is_judged_in_part {
            lines.push(("note", format!("verdicts in this play are of its first {JUDGED_MAX_S} s")));
        }
        lines.extend(self.starts_off.iter().map(|text| ("note", text.clone())));
        if !self.untouched_layers.is_empty() {
            let since = |t_s: f64| format!("; since {t_s:.2} s, when the scene was replaced");
            let titles: Vec<&LayerTitle> = self.untouched_layers.iter().collect();
            let layers = fold_copies(&titles).join(", ");
            lines.push(("never touched", format!("{layers}{}", self.replaced_at_s.map_or(String::new(), since))));
        }
        lines
    }
}

/// The line of a summary that marks a draft.
pub(crate) fn draft_line(refusals: usize) -> String {
    let reasons = if refusals == 1 { "1 reason".to_owned() } else { format!("{refusals} reasons") };
    format!("a board refuses this scene, for {reasons}; what is out of reach is clamped here")
}

fn size(rms_n: Option<f64>, max_n: Option<f64>) -> Option<ErrorSize> {
    rms_n.zip(max_n).map(|(rms_n, max_n)| ErrorSize { rms_n, max_n })
}
