//! Plays a program on any board through its [`Device`], and changes what plays.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Device, DeviceError, Event, Link, Progress, ignore_progress};
use frixel_felt::recorder::PlayListener as _;
use frixel_model::ParameterError;
use frixel_scene::{Clamped, LayerSetting, Program};
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::BoardKind;
use frixel_wire::message::{Refusal, Telemetry};

use crate::error::{PlayError, StopReason, is_refusal};
use crate::feed::{Feed, FeedError};
use crate::live_layers::{LayerChange, LiveError, LiveLayers};
use crate::recorded::Recorded;
use crate::upload;

/// Longest time between two steps of a play.
const STEP_MAX: Duration = Duration::from_millis(50);
/// Longest time between two steps while samples are streamed: a board's buffer lasts 25 ms or more.
const STREAM_STEP_MAX: Duration = Duration::from_millis(5);
/// Extra time beyond the last recorded tick, because the link's clock is rounded.
const MARGIN: Duration = Duration::from_millis(5);
/// Ping period during a stop: longer than a stop takes, so that no ping is sent.
const NEVER: Duration = Duration::from_hours(1);

/// How a program replaced the previous one.
#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    /// Whether the output faded out in between.
    ///
    /// This happens if the pictures of both programs do not fit on the board together: an empty scene then plays until
    /// the new program is there. Otherwise the change is made between two ticks.
    pub faded_out: bool,
    /// Friction that was out of reach with the gains set before; `None` if they were kept, or none was set. If present,
    /// all gains are those of the new program.
    pub dropped_gains: Option<Clamped>,
}

/// A board, the program that plays on it, and the feed of streamed samples.
///
/// Call [`Self::start`], then [`Self::step`] or [`Self::wait`] until the play should end, then [`Self::stop`]. Dropping
/// a player also stops the board.
pub struct Player<L: Link + Recorded> {
    device: Device<L>,
    state: State,
    fault: Option<Fault>,
    stop_reason: Option<StopReason>,
    playing: Option<LiveLayers>,
    feed: Option<Feed>,
    telemetry: Vec<Telemetry>,
}

impl<L: Link + Recorded> Player<L> {
    /// Creates a player for a board, on which nothing plays.
    pub fn new(device: Device<L>) -> Self {
        let state = device.hello().state;
        Self { device, state, fault: None, stop_reason: None, playing: None, feed: None, telemetry: Vec::new() }
    }

    /// Creates a player for a board, and records into `recorder` from the start of the play.
    pub fn recording(mut device: Device<L>, recorder: L::Recorder) -> Self {
        *device.link_mut().recorder_mut() = recorder;
        Self::new(device)
    }

    /// Uploads the program and plays it, in any state of the board. The board sends a telemetry message every
    /// `telemetry_period_ticks` ticks; 0 disables telemetry. `progress` may cancel the upload.
    pub fn start(
        &mut self,
        program: Program,
        telemetry_period_ticks: u32,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(), PlayError> {
        check_measured(&program, self.device.hello().board)?;
        upload::start(&mut self.device, &program, progress)?;
        self.playing = Some(LiveLayers::new(program));
        self.begin()?;
        if telemetry_period_ticks > 0 {
            self.device.subscribe(telemetry_period_ticks)?;
        }
        Ok(())
    }

    /// Arms the board if it is disarmed, and plays the program of [`Self::replace`] if it does not play.
    pub fn arm_and_play(&mut self) -> Result<(), DeviceError> {
        if self.state == State::Disarmed {
            self.device.arm()?;
            self.state = State::Armed;
        }
        if self.state == State::Armed {
            self.device.play()?;
            self.state = State::Active;
            self.switch_off()?;
            self.begin()?;
        }
        Ok(())
    }

    /// Records that the board has begun to play.
    fn begin(&mut self) -> Result<(), DeviceError> {
        (self.state, self.fault, self.stop_reason) = (State::Active, None, None);
        self.device.link_mut().begin().map_err(|closed| DeviceError::Vanished { command: "play", closed })
    }

    /// Replaces the program on the board. The new one plays at once if the previous one plays.
    ///
    /// The change is made between two ticks, unless the pictures of both do not fit on the board together.
    ///
    /// Layers of both programs keep their live settings: on or off, gain and trigger. The gains are kept only if the
    /// drive can reach the resulting friction.
    ///
    /// If the board refuses the program, the previous one continues. After any other error while the empty scene plays,
    /// the empty scene stays.
    pub fn replace(&mut self, program: Program) -> Result<Replaced, PlayError> {
        let (layers, dropped_gains) = match &self.playing {
            Some(before) => before.followed_by(program),
            None => (LiveLayers::new(program), None),
        };
        Ok(Replaced { dropped_gains, ..self.replace_layers(layers)? })
    }

    /// Like [`Self::replace`], with all layers as set in the program's file.
    pub fn replace_anew(&mut self, program: Program) -> Result<Replaced, PlayError> {
        self.replace_layers(LiveLayers::new(program))
    }

    fn replace_layers(&mut self, layers: LiveLayers) -> Result<Replaced, PlayError> {
        check_measured(layers.program(), self.device.hello().board)?;
        let faded_out = match self.upload(&layers) {
            Err(DeviceError::Refused { refusal: Refusal::BitmapPoolFull { .. }, .. }) => {
                self.replace_alone(&layers)?;
                true
            }
            uploaded => uploaded.map(|()| false)?,
        };
        self.set_playing(layers)?;
        Ok(Replaced { faded_out, dropped_gains: None })
    }

    /// Replaces the program after removing the pictures of the previous one. Restores the previous one if the board
    /// refuses.
    fn replace_alone(&mut self, layers: &LiveLayers) -> Result<(), PlayError> {
        let empty = LiveLayers::new(layers.program().without_layers());
        self.upload(&empty)?;
        self.tell_replaced(empty.program())?;
        let before = self.playing.take();
        let uploaded = self.upload(layers);
        if let Some(before) = before.filter(|_| uploaded.as_ref().is_err_and(is_refusal)) {
            self.upload(&before)?;
            self.set_playing(before)?;
        }
        Ok(uploaded?)
    }

    fn upload(&mut self, layers: &LiveLayers) -> Result<(), DeviceError> {
        upload::upload(&mut self.device, layers.program(), layers.settings(), &mut ignore_progress)
    }

    /// Records that the board has this program.
    fn set_playing(&mut self, layers: LiveLayers) -> Result<(), PlayError> {
        self.tell_replaced(layers.program())?;
        let changed = (0..).zip(layers.settings().iter().zip(&layers.program().start));
        for (record, (setting, _)) in changed.filter(|(_, (setting, start))| setting != start) {
            self.recorder_mut().layer_changed(record, *setting);
        }
        self.playing = Some(layers);
        if self.state == State::Active {
            self.switch_off()?;
        }
        Ok(())
    }

    /// Switches off the layers of the board that are off in the program that plays.
    fn switch_off(&mut self) -> Result<(), DeviceError> {
        let Self { device, playing, .. } = self;
        playing.as_ref().map_or(Ok(()), |layers| upload::switch_off(device, layers.settings()))
    }

    fn tell_replaced(&mut self, program: &Program) -> Result<(), ParameterError> {
        let limits = self.device.hello().limits;
        self.recorder_mut().scene_replaced(program, &limits)
    }

    /// Switches a layer by its name or number, or sets its gain; `None` leaves either unchanged. Returns the change,
    /// which has a notice of the layers that are clamped from now on.
    pub fn change_layer(&mut self, layer: &str, on: Option<bool>, gain: Option<f32>) -> Result<LayerChange, PlayError> {
        let change = self.layers()?.change(layer, on, gain)?;
        self.send(&change)?;
        Ok(change)
    }

    /// Switches on a layer that is off, and off again after `duration_s` seconds. `layer` is its name or number; see
    /// [`LiveLayers::trigger`].
    pub fn trigger(&mut self, layer: &str, duration_s: Option<f64>) -> Result<LayerChange, PlayError> {
        let now = self.device.now();
        let layers = self.layers()?;
        let change = layers.trigger(layer, now, duration_s)?;
        let is_streamed = |(number, _): &(u8, LayerSetting)| {
            layers.program().records.get(usize::from(*number)).is_some_and(|record| record.layer.is_streamed())
        };
        if self.feed.is_none() && change.settings.iter().any(is_streamed) {
            return Err(LiveError::TriggerUnfed { layer: layer.to_owned() }.into());
        }
        self.send(&change)?;
        for (record, _) in &change.settings {
            self.recorder_mut().triggered(*record);
        }
        Ok(change)
    }

    fn layers(&self) -> Result<&LiveLayers, PlayError> {
        self.playing.as_ref().ok_or(PlayError::NothingPlays)
    }

    /// Sends a change to the board, and applies the part that the board accepted.
    fn send(&mut self, change: &LayerChange) -> Result<(), DeviceError> {
        let Self { device, playing, .. } = self;
        let Some(layers) = playing else { return Ok(()) };
        for (record, setting) in &change.settings {
            device.link_mut().recorder_mut().layer_changed(*record, *setting);
            let sent = device.set_layer(*record, setting.on, setting.gain);
            if sent.is_err() {
                device.link_mut().recorder_mut().layer_changed(*record, layers.setting(*record));
                return sent;
            }
            layers.apply(*record, *setting, change);
        }
        Ok(())
    }

    /// Switches triggered layers according to their patterns, and off at the end. [`Self::step`] and [`Self::wait`] do
    /// this as well.
    pub(crate) fn end_triggers(&mut self) -> Result<(), PlayError> {
        let now = self.device.now();
        while let Some((record, change)) = self.playing.as_ref().and_then(|layers| layers.next_switch(now)) {
            if let Err(refused) = self.send(&change) {
                let Some(layers) = &mut self.playing else { return Ok(()) };
                layers.forget_trigger(record);
                if !is_refusal(&refused) {
                    return Err(refused.into());
                }
                let title = layers.program().titles.get(usize::from(record));
                return Err(PlayError::TriggerEnd {
                    layer: title.map(ToString::to_string).unwrap_or_default(),
                    refused,
                });
            }
        }
        Ok(())
    }

    /// Starts streaming the samples of `feed` to the scene that is playing.
    pub fn stream(&mut self, feed: Feed) -> Result<(), PlayError> {
        Ok(self.feed.insert(feed).start(&mut self.device)?)
    }

    /// Whether samples of [`Self::stream`] are still to be sent or played.
    pub fn is_streaming(&self) -> bool {
        self.feed.as_ref().is_some_and(|feed| !feed.is_over(&self.device))
    }

    /// Whether the stream of [`Self::stream`] has ended and was played.
    pub fn is_stream_over(&self) -> bool {
        self.feed.as_ref().is_some_and(|feed| feed.is_over(&self.device))
    }

    /// Advances the board by at most `time_max`, or until a trigger next switches its layer. Records the ticks, and
    /// sends samples.
    ///
    /// Returns the time that has passed. Fails if the connection is lost, or if the board stopped without a stop
    /// command; everything until then has been recorded.
    pub fn step(&mut self, time_max: Duration) -> Result<Duration, PlayError> {
        self.end_triggers()?;
        let time = self.step_max().min(time_max).min(self.time_left());
        let listened = self.listen(time);
        self.stop_reason.map_or(Ok(()), |reason| Err(PlayError::Stopped(reason)))?;
        listened?;
        self.pump()?;
        Ok(time)
    }

    /// Advances the board by `duration`, as [`Self::step`] does. A board that stops by itself is not an error: see
    /// [`Self::state`].
    pub fn wait(&mut self, duration: Duration) -> Result<(), PlayError> {
        let end = self.device.now() + duration;
        loop {
            self.end_triggers()?;
            let left = end.saturating_sub(self.device.now());
            if left.is_zero() {
                return Ok(());
            }
            self.listen(self.step_max().min(left))?;
            self.pump()?;
        }
    }

    /// Longest time until the player has something to send.
    fn step_max(&self) -> Duration {
        let step_max = if self.feed.is_some() { STREAM_STEP_MAX } else { STEP_MAX };
        let next_switch_at = self.playing.as_ref().and_then(LiveLayers::next_switch_at);
        next_switch_at.map_or(step_max, |at| step_max.min(at.saturating_sub(self.device.now())))
    }

    /// Time to the end of the record, plus [`MARGIN`].
    fn time_left(&mut self) -> Duration {
        let tick_hz = self.device.hello().tick_hz;
        let ticks = self.recorder_mut().ticks_left();
        Duration::try_from_secs_f64(ticks as f64 / f64::from(tick_hz)).unwrap_or(Duration::MAX).saturating_add(MARGIN)
    }

    /// Waits for `time`, and handles the messages that the board sends meanwhile.
    fn listen(&mut self, time: Duration) -> Result<(), DeviceError> {
        let Self { device, state, fault, stop_reason, telemetry, .. } = self;
        let listened = device.wait(time, &mut |event| match event {
            Event::Telemetry(message) => telemetry.push(message),
            Event::StateChanged { state: now, fault: latched, flags } => {
                (*state, *fault, *stop_reason) = (now, latched, StopReason::of(latched, flags));
            }
        });
        device.link_mut().record(telemetry);
        telemetry.clear();
        listened
    }

    fn pump(&mut self) -> Result<(), FeedError> {
        let Self { device, feed, .. } = self;
        feed.as_mut().map_or(Ok(()), |feed| feed.pump(device))
    }

    /// Sets the output to zero and disarms the board. With a latched fault the output is zero already.
    ///
    /// Only these commands are sent until the board answers. If they do not reach the board, its host timeout stops it.
    pub fn stop(&mut self) -> Result<(), DeviceError> {
        if self.state == State::Faulted {
            return Ok(());
        }
        (self.feed, self.stop_reason) = (None, None);
        self.device.link_mut().keep_alive(NEVER);
        self.recorder_mut().stopped();
        let stopped = if self.state == State::Active { self.device.stop() } else { Ok(()) };
        // A board that has left the active state by itself refuses to stop.
        let stopped = stopped.or_else(|error| if is_refusal(&error) { Ok(()) } else { Err(error) });
        // A board that answers with another state is disarmed all the same; one that does not answer is left alone.
        let stopped = match stopped {
            Err(error @ DeviceError::WrongState { .. }) => self.device.disarm().and(Err(error)),
            stopped => stopped.and_then(|()| self.device.disarm()),
        };
        (self.state, self.fault) = match stopped {
            // The board has latched a fault that it has not yet reported to this host.
            Err(DeviceError::Refused { refusal: Refusal::Faulted(fault), .. }) => (State::Faulted, Some(fault)),
            Err(DeviceError::Refused { refusal: Refusal::WrongState(State::Faulted), .. }) => (State::Faulted, None),
            disarmed => disarmed.map(|()| (State::Disarmed, None))?,
        };
        Ok(())
    }

    /// Clears a latched fault whose cause is gone.
    pub fn clear_fault(&mut self) -> Result<(), DeviceError> {
        self.device.clear_fault()?;
        (self.state, self.fault) = (State::Disarmed, None);
        Ok(())
    }

    /// State and latched fault last reported by the board.
    pub fn state(&self) -> (State, Option<Fault>) {
        (self.state, self.fault)
    }

    /// The program that plays, with its layers; `None` before the first one.
    pub fn playing(&self) -> Option<&LiveLayers> {
        self.playing.as_ref()
    }

    /// The board that the scene plays on.
    pub fn device(&self) -> &Device<L> {
        &self.device
    }

    /// The board that the scene plays on, for requests that no method of this type makes.
    pub fn device_mut(&mut self) -> &mut Device<L> {
        &mut self.device
    }

    /// Ends the record with the data received so far, and returns the recorder. Stops the board if it plays.
    pub fn into_recorder(mut self) -> L::Recorder
    where
        L::Recorder: Default,
    {
        let link = self.device.link_mut();
        link.record_rest();
        std::mem::take(link.recorder_mut())
    }

    /// The recorder of this play.
    pub fn recorder_mut(&mut self) -> &mut L::Recorder {
        self.device.link_mut().recorder_mut()
    }
}

/// Refuses a program whose finger was not measured at the required voltage or load, unless the board is simulated.
/// [`Player::start`] and [`Player::replace`] check this, too; callers check it before they write anything.
pub fn check_measured(program: &Program, board: BoardKind) -> Result<(), PlayError> {
    let warning = program.unmeasured().filter(|_| !board.is_simulated());
    warning.map_or(Ok(()), |warning| Err(PlayError::Unmeasured { warning }))
}

#[cfg(test)]
mod tests;
