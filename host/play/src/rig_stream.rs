//! The line to a board in a simulated world, on the rig's clock.

use std::collections::VecDeque;
use std::time::Duration;

use frixel_driver::{ByteStream, Device, DeviceError, LinkClosed, PollingLink};
use frixel_felt::recorder::{Observation, Recorder};
use frixel_hil_sim::{BoardRig, BoardView, RigError, RigTick};
use frixel_wire::fault::State;
use frixel_wire::message::Telemetry;

use crate::recorded::Recorded;

/// Longest time that a tick waits for its telemetry.
const HOLD: Duration = Duration::from_millis(200);

/// Callback for every tick from the start of the record on.
type Observer<'a> = Box<dyn FnMut(&RigTick) + 'a>;

/// The host's end of the serial line to a rig, with the record of what its finger feels.
///
/// Stroke and record start when the scene first plays: in that tick if the rig [sees the board](BoardRig::sees_board),
/// and otherwise when the board acknowledges `play`. On a rig that does not see the board, only rows with a telemetry
/// message have the board's values.
pub struct RigStream<'a> {
    rig: Box<dyn BoardRig + 'a>,
    record: Record<'a>,
    /// Bytes from the board that were received beside a read.
    received: Vec<u8>,
}

/// The recorder, and the ticks that were not yet passed to it.
#[derive(Default)]
struct Record<'a> {
    recorder: Recorder,
    observer: Option<Observer<'a>>,
    is_started: bool,
    /// The board's state in the last tick, if the rig sees it.
    state: Option<State>,
    /// Ticks that wait for their telemetry.
    held: VecDeque<Observation>,
    /// Telemetry that waits for its tick, on the rig's clock.
    telemetry: VecDeque<Telemetry>,
    /// The rig's tick minus the board's, once known: exact, or to a millisecond if it is derived from the first
    /// telemetry.
    tick_offset: Option<u32>,
}

/// A link to a board in a simulated world.
pub type RigLink<'a> = PollingLink<RigStream<'a>>;

/// Connects to the board of a rig.
pub fn connect(rig: Box<dyn BoardRig + '_>) -> Result<Device<RigLink<'_>>, DeviceError> {
    Device::connect(PollingLink::new(RigStream::new(rig)))
}

impl<'a> RigStream<'a> {
    /// The line to a rig.
    pub fn new(rig: Box<dyn BoardRig + 'a>) -> Self {
        Self { rig, record: Record::default(), received: Vec::new() }
    }

    /// Calls `observer` with every tick from the start of the record on.
    #[must_use]
    pub fn observed(mut self, observer: impl FnMut(&RigTick) + 'a) -> Self {
        self.record.observer = Some(Box::new(observer));
        self
    }

    fn start(&mut self) {
        self.rig.start_stroke();
        self.record.recorder.start(self.rig.tick() as u32);
        self.record.is_started = true;
    }

    fn ticks(&self, time: Duration) -> u64 {
        ticks_spanning(time.as_secs_f64(), self.rig.board().tick_hz)
    }

    fn closed(&self, error: &RigError) -> LinkClosed {
        let reason = match error {
            RigError::Ended { reason, .. } => reason.clone(),
            other => other.to_string(),
        };
        LinkClosed { port: self.rig.name().to_owned(), reason }
    }

    /// Lets the rig run until bytes have arrived, or until a tick.
    fn run(&mut self, until_tick: u64, buffer: &mut Vec<u8>) -> Result<(), RigError> {
        let before = buffer.len();
        loop {
            // The stroke starts in the tick in which the scene plays.
            let steps = self.rig.sees_board() && !self.record.is_started;
            let until = if steps { until_tick.min(self.rig.tick() + 1) } else { until_tick };
            let Self { rig, record, .. } = self;
            rig.run(until, buffer, &mut |tick| record.take(tick))?;
            let touch_frames = rig.take_touch_frames();
            if !touch_frames.is_empty() {
                rig.send(&touch_frames)?;
            }
            if !record.is_started && record.state == Some(State::Active) {
                self.start();
            }
            if buffer.len() > before || self.rig.tick() >= until_tick {
                return Ok(());
            }
        }
    }
}

/// Number of ticks that cover a time in seconds. A time that is above a whole number of ticks by rounding alone is that
/// number.
pub fn ticks_spanning(time_s: f64, tick_hz: u32) -> u64 {
    (time_s * f64::from(tick_hz) - 1e-6).ceil().max(0.0) as u64
}

impl Record<'_> {
    fn take(&mut self, tick: &RigTick) {
        let on_rig = tick.tick as u32;
        match &tick.status {
            BoardView::Status(status) => self.state = Some(status.telemetry.state),
            BoardView::Tick(board_tick) => self.tick_offset = Some(on_rig.wrapping_sub(*board_tick)),
            BoardView::None => {}
        }
        if !self.is_started {
            return;
        }
        if let BoardView::Status(status) = &tick.status {
            // An observation is large, and a play may have no recorder.
            if self.recorder.ticks_left() > 0 {
                self.recorder.record(&Observation::of_tick(on_rig, &tick.felt, &status.telemetry));
            }
        } else {
            self.held.push_back(Observation::of_world(on_rig, &tick.felt, tick.drive.dac_code.bits()));
        }
        if let Some(observer) = &mut self.observer {
            observer(tick);
        }
    }

    /// Records all ticks that are held but the last `count`, each with its telemetry.
    fn record_all_but(&mut self, count: usize) {
        let count = self.held.len().saturating_sub(count);
        for observation in self.held.drain(..count) {
            let is_past = |telemetry: &mut Telemetry| observation.tick.wrapping_sub(telemetry.tick) as i32 >= 0;
            let mut last = None;
            while let Some(earlier) = self.telemetry.pop_front_if(is_past) {
                last = Some(earlier);
            }
            let telemetry = last.filter(|last| last.tick == observation.tick);
            self.recorder.record(&Observation { telemetry, ..observation });
        }
    }
}

impl Recorded for RigStream<'_> {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.record.recorder
    }

    fn begin(&mut self) -> Result<(), LinkClosed> {
        if !self.record.is_started {
            self.start();
        }
        Ok(())
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        if self.rig.sees_board() || !self.record.is_started {
            return;
        }
        if let Some(last) = telemetry.last() {
            // A rig that does not see the board's count learns it from the first message, to a millisecond.
            let offset = *self.record.tick_offset.get_or_insert((self.rig.tick() as u32).wrapping_sub(last.tick));
            let on_rig = |message: &Telemetry| Telemetry { tick: message.tick.wrapping_add(offset), ..*message };
            self.record.telemetry.extend(telemetry.iter().map(on_rig));
        }
        self.record.record_all_but(self.ticks(HOLD) as usize);
    }

    fn record_rest(&mut self) {
        if self.rig.sees_board() {
            return;
        }
        // Ticks that the rig has not reported yet. Its error was reported, or is reported at the next read.
        let Self { rig, record, received } = self;
        let _ = rig.run(rig.tick(), received, &mut |tick| record.take(tick));
        record.record_all_but(0);
    }
}

impl ByteStream for RigStream<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes).map_err(|error| self.closed(&error))
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        if !self.received.is_empty() {
            buffer.append(&mut self.received);
            return Ok(());
        }
        // The clock of an emulated board may stand still while its ticks pass. A read ends before its time then.
        let until_tick = self.rig.tick().saturating_add(self.ticks(wait));
        self.run(until_tick, buffer).map_err(|error| self.closed(&error))
    }

    fn now(&self) -> Duration {
        self.rig.now()
    }

    fn name(&self) -> &str {
        self.rig.name()
    }
}
