//! Records a board and its finger, and compares them with the [reference](mod@frixel_scene::reference).
//!
//! The same [`Recorder`] serves simulated boards and boards at a port. Its input is [`Observation`]s: one per tick for
//! a simulated board or world, one per telemetry message for a board at a port. Its output is [`FeltRow`]s and a
//! [`MetricsSummary`]. A value that the source cannot observe is `None` in an observation, and absent from the output.

mod inversion;
mod judged;
mod listener;
mod marker;
mod observation;
mod rows;
mod stream;
mod turning;

use frixel_hil_sim::{FingerState, ReferenceFriction};
use frixel_model::ParameterError;
use frixel_wire::fault::Flags;
use frixel_wire::hello::BoardLimits;

use crate::fidelity::FidelitySample;
use crate::metrics::{Metrics, MetricsSummary, Sample};
use frixel_scene::reference::{Context, Reference, StrokeReference};
use frixel_scene::{LayerSetting, Program};
use inversion::Inversion;
pub use judged::JUDGED_MAX_S;
use judged::JudgedSamples;
pub use listener::PlayListener;
use marker::Markers;
pub use marker::{MarkedEvent, Marker};
pub use observation::Observation;
pub use rows::{FeltRow, FlagNames, OFF_BELOW_V_RMS};
use rows::{Frictions, RowMaker};
use stream::Stream;
use turning::Turning;

/// Records one play.
///
/// Time zero is the tick given to [`Self::start`], or else the first observation.
#[derive(Debug)]
pub struct Recorder {
    comparison: Option<Comparison>,
    /// The simulated finger that filters the reference, see [`Self::through_finger`].
    finger: Option<ReferenceFriction>,
    row_maker: RowMaker,
    rows: Vec<FeltRow>,
    /// Samples for the judge; `None` if they are not kept, or after a change of the scene.
    judged: Option<JudgedSamples>,
    markers: Markers,
    /// The samples sent since they were last taken; `None` if they are not kept.
    sent_samples: Option<Vec<u16>>,
    tick_hz: u32,
    tick_period_s: f64,
    ticks_max: u64,
    start_tick: Option<u64>,
    last_tick: u64,
}

/// The reference of a play, and the metrics of the comparison.
#[derive(Debug)]
struct Comparison {
    reference: StrokeReference,
    inversion: Inversion,
    stream: Stream,
    turning: Turning,
    metrics: Metrics,
}

impl Recorder {
    /// Creates a recorder that compares with the reference of `program`, on a board with these limits and the tick rate
    /// `tick_hz`. It records at most `ticks_max` ticks, with a row for every `ticks_per_row` of them.
    ///
    /// Returns an error if the contact model refuses the program's finger. This does not happen for a compiled program.
    pub fn new(
        program: &Program,
        limits: &BoardLimits,
        tick_hz: u32,
        ticks_max: u64,
        ticks_per_row: u32,
    ) -> Result<Self, ParameterError> {
        let mut recorder = Self { ticks_max, ..Self::without_reference(tick_hz, ticks_per_row) };
        recorder.scene_replaced(program, limits)?;
        Ok(recorder)
    }

    /// Creates a recorder for a board whose program is unknown: until [`Self::scene_replaced`], no row has
    /// `reference_n`, and the summary has no errors.
    pub fn without_reference(tick_hz: u32, ticks_per_row: u32) -> Self {
        Self {
            comparison: None,
            finger: None,
            row_maker: RowMaker::new(tick_hz, ticks_per_row),
            rows: Vec::new(),
            judged: None,
            markers: Markers::default(),
            sent_samples: None,
            tick_hz,
            tick_period_s: 1.0 / f64::from(tick_hz),
            ticks_max: u64::MAX,
            start_tick: None,
            last_tick: 0,
        }
    }

    /// Compares with an ideal display under the simulated finger, with its load, noise and skin. Without this, compares
    /// with the scene's finger in steady sliding.
    #[must_use]
    pub fn through_finger(self) -> Self {
        Self { finger: Some(ReferenceFriction::default()), ..self }
    }

    /// Keeps the samples of streams, for [`Self::take_samples`].
    #[must_use]
    pub fn keeping_samples(self) -> Self {
        Self { sent_samples: Some(Vec::new()), ..self }
    }

    /// Keeps the samples for [`in_play`](crate::judge::in_play), to be taken by [`Self::take_judged`].
    #[must_use]
    pub fn judged(self) -> Self {
        Self { judged: Some(JudgedSamples::new(self.tick_hz)), ..self }
    }

    /// Sets time zero to `tick`: the record begins with the next tick, and earlier observations are ignored.
    pub fn start(&mut self, tick: u32) {
        self.start_tick = Some(u64::from(tick));
        self.last_tick = u64::from(tick);
        self.mark(MarkedEvent::SceneBegan);
    }

    /// Adds a marker at the last observation. Ignored before time zero.
    fn mark(&mut self, event: MarkedEvent) {
        if self.start_tick.is_some() {
            self.markers.add(self.ticks(), self.t_s(), event);
        }
    }

    fn with_stream(&mut self, change: impl FnOnce(&mut Stream)) {
        if let Some(comparison) = &mut self.comparison {
            change(&mut comparison.stream);
        }
    }

    /// Adds an observation. Ignores one that is not later than the previous one, or beyond the end of the record.
    pub fn record(&mut self, observation: &Observation) {
        let Some(ticks_passed) = self.advance_to(observation.tick) else { return };
        let t_s = self.last_tick as f64 * self.tick_period_s;
        let frictions = match &mut self.comparison {
            Some(comparison) => comparison.add(observation, t_s, ticks_passed, self.finger.as_mut()),
            None => Frictions::without_reference(observation),
        };
        let (ticks, start_s) = (self.ticks(), self.start_s().unwrap_or(0.0));
        self.rows.extend(self.row_maker.add(observation, ticks, &frictions));
        if let Some(judged) = &mut self.judged {
            judged.add(observation, ticks, &frictions, start_s);
        }
    }

    /// Ticks of the record so far.
    pub fn ticks(&self) -> u64 {
        self.start_tick.map_or(0, |start_tick| self.last_tick - start_tick)
    }

    /// Time of the record so far, s.
    pub fn t_s(&self) -> f64 {
        self.ticks() as f64 * self.tick_period_s
    }

    /// Time from the power-on of the board to time zero of the record, s; `None` before the first observation.
    pub fn start_s(&self) -> Option<f64> {
        Some(self.start_tick? as f64 * self.tick_period_s)
    }

    /// Number of ticks that remain to be recorded.
    pub fn ticks_left(&self) -> u64 {
        self.ticks_max - self.ticks()
    }

    /// The rows so far, except those already taken.
    pub fn rows(&self) -> &[FeltRow] {
        &self.rows
    }

    /// Removes the rows so far and returns them.
    pub fn take_rows(&mut self) -> Vec<FeltRow> {
        std::mem::take(&mut self.rows)
    }

    /// Removes the stream samples sent so far and returns them; empty without [`Self::keeping_samples`].
    pub fn take_samples(&mut self) -> Vec<u16> {
        self.sent_samples.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Removes the samples of the play up to [`JUDGED_MAX_S`] and returns them; `None` without [`Self::judged`], or if
    /// a layer, a trigger, a stream or another scene changed the play.
    pub fn take_judged(&mut self) -> Option<Vec<FidelitySample>> {
        self.judged.take().map(JudgedSamples::into_samples)
    }

    /// The events so far, in order. A marker has the time of the preceding observation.
    pub fn markers(&self) -> &[Marker] {
        self.markers.as_slice()
    }

    /// The metrics so far; only the ticks if there is no reference.
    pub fn summary(&self) -> MetricsSummary {
        let ticks = self.ticks();
        match &self.comparison {
            Some(comparison) => comparison.metrics.summary(ticks),
            None => MetricsSummary { ticks, ..MetricsSummary::default() },
        }
    }

    /// Advances to a tick of the board's counter, which is modulo 2^32, and returns the ticks since the previous
    /// observation; `None` if the tick is not recorded.
    fn advance_to(&mut self, tick: u32) -> Option<u32> {
        if self.start_tick.is_none() && self.ticks_max > 0 {
            self.start(tick);
            return Some(0);
        }
        let passed = tick.wrapping_sub(self.last_tick as u32);
        let is_later = (passed as i32) > 0;
        if !is_later || u64::from(passed) > self.ticks_left() {
            return None;
        }
        self.last_tick += u64::from(passed);
        Some(passed)
    }
}

/// A placeholder that records nothing, until a play has its recorder.
impl Default for Recorder {
    fn default() -> Self {
        Self { ticks_max: 0, ..Self::without_reference(1, u32::MAX) }
    }
}

impl PlayListener for Recorder {
    fn scene_replaced(&mut self, program: &Program, limits: &BoardLimits) -> Result<(), ParameterError> {
        if self.ticks_max == 0 {
            return Ok(());
        }
        self.markers.name_layers(program);
        self.mark(MarkedEvent::SceneReplaced);
        let reference = Reference::at_start(program).along_stroke();
        let inversion = Inversion::new(program, limits)?;
        if let Some(comparison) = &mut self.comparison {
            self.judged = None;
            (comparison.reference, comparison.inversion) = (reference, inversion);
            comparison.metrics.set_half_period(program.carrier.half_period_ticks);
        } else {
            let (stream, turning) = (Stream::new(self.tick_hz), Turning::default());
            let metrics = Metrics::new(program.carrier.half_period_ticks);
            self.comparison = Some(Comparison { reference, inversion, stream, turning, metrics });
        }
        Ok(())
    }

    fn layer_changed(&mut self, record: u8, setting: LayerSetting) {
        let t_s = self.last_tick as f64 * self.tick_period_s;
        if let Some(comparison) = &mut self.comparison {
            comparison.reference.set_layer(record.into(), setting.on, setting.gain.into(), t_s);
        }
        self.judged = None;
        self.mark(self.markers.changed(record, setting));
    }

    fn triggered(&mut self, record: u8) {
        self.judged = None;
        let layer = self.markers.title(record);
        self.mark(MarkedEvent::Triggered { layer });
    }

    /// The reference includes the stream once the board reports that it plays.
    fn stream_started(&mut self, sample_hz: u32) {
        self.judged = None;
        self.with_stream(|stream| stream.start(sample_hz));
        self.mark(MarkedEvent::StreamStarted { sample_hz });
    }

    fn samples_sent(&mut self, samples: &[u16]) {
        if let Some(sent) = &mut self.sent_samples {
            sent.extend_from_slice(samples);
        }
        self.with_stream(|stream| stream.append(samples));
    }

    fn stream_ended(&mut self) {
        self.with_stream(Stream::end);
        self.mark(MarkedEvent::StreamEnded);
    }

    fn stopped(&mut self) {
        self.with_stream(Stream::stop);
        self.mark(MarkedEvent::Stopped);
    }

    fn ticks_left(&self) -> u64 {
        Self::ticks_left(self)
    }
}

impl Comparison {
    /// Adds an observation at time `t_s` since power-on, `ticks_passed` ticks after the previous one.
    fn add(
        &mut self,
        observation: &Observation,
        t_s: f64,
        ticks_passed: u32,
        finger: Option<&mut ReferenceFriction>,
    ) -> Frictions {
        let scenes_natural_n = self.reference.natural_friction_n();
        // Only a simulated finger with its own skin turns.
        let turning = self.turning.follow(observation.finger) && finger.is_some();
        let electric_n = self.reference_electric_n(observation, t_s, ticks_passed);
        let in_scene_n = electric_n.map(|electric_n| scenes_natural_n + electric_n);
        let in_reach = in_scene_n.is_some_and(|in_scene_n| self.inversion.reaches(in_scene_n - scenes_natural_n));
        let (natural_n, reference_n) = match (finger, &observation.felt) {
            (Some(finger), Some(felt)) => {
                let through_finger_n = finger.follow(felt, electric_n.unwrap_or(0.0));
                (felt.friction_n - felt.electric_friction_n, electric_n.map(|_| through_finger_n))
            }
            _ => (scenes_natural_n, in_scene_n),
        };
        let telemetry = observation.telemetry.as_ref();
        let commanded_n = telemetry.map(|telemetry| natural_n + f64::from(telemetry.commanded_electric_friction_n));
        let felt_n = observation.felt.map(|felt| felt.friction_n);
        self.metrics.add(&Sample {
            finger_down: observation.finger.is_some(),
            board_has_finger: observation.board_has_finger(),
            reference_n,
            turning,
            commanded_n,
            felt_n,
            inversion_n: telemetry.filter(|_| in_reach).map(|telemetry| {
                natural_n + self.inversion.electric_friction_n(telemetry.voltage_v_rms, telemetry.dac_code)
            }),
            slewing: telemetry.is_some_and(|telemetry| telemetry.flags.contains(Flags::SLEWED)),
            load_mismatch_n: observation.felt.map(|felt| felt.load_mismatch_n),
            saturated: telemetry.map(|telemetry| telemetry.flags.contains(Flags::SATURATED)),
        });
        Frictions { reference_n, commanded_n, felt_n }
    }

    /// Electric friction of the reference at the finger's place; `None` while the finger is up.
    fn reference_electric_n(&mut self, observation: &Observation, t_s: f64, ticks_passed: u32) -> Option<f64> {
        let dry = observation.telemetry.map(|telemetry| telemetry.flags.contains(Flags::STREAM_DRY));
        let (stream, stream_weight) = self.stream.advance(ticks_passed, dry);
        let Some(FingerState { x_m, y_m, speed_m_per_s }) = observation.finger else {
            self.reference.lift();
            return None;
        };
        let direction = self.turning.direction();
        let context = Context { x_m, y_m, t_s, speed_m_per_s, direction, stream, stream_weight, begun_s: 0.0 };
        Some(self.reference.electric_friction_n(&context))
    }
}

#[cfg(test)]
mod tests;
