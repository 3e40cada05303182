//! The serial line to the in-process rig, on the rig's clock, with the pointer's finger in its world.

use std::time::Duration;

use frixel_driver::{ByteStream, LinkClosed};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, FingerState, Point, Rig, RigConfig, RigTick, Status, Stroke};
use frixel_play::{Recorded, SimulationError};
use frixel_wire::fault::{Fault, State};

use crate::felt::FeltSampler;
use crate::pointer::{Finger, Pointer};
use crate::touched::{TouchFollower, TouchedPlaces};

/// The line to a simulated board. Each tick of virtual time passes in [`Self::step`].
pub(crate) struct PointerStream<'a> {
    rig: Rig<'a>,
    /// The finger on the screen.
    pub(crate) pointer: Pointer,
    /// Felt friction.
    pub(crate) felt: FeltSampler,
    touch: TouchFollower,
    /// Places of the finger as seen by the board in the last tick.
    touched: TouchedPlaces,
    /// The record of the last tick.
    last: Option<RigTick<Status>>,
    /// Callback for every tick.
    observer: Option<Observer>,
}

/// Callback for a tick.
type Observer = Box<dyn FnMut(&RigTick<Status>)>;

impl<'a> PointerStream<'a> {
    pub(crate) fn new(memory: &'a mut BoardMemory, config: &RigConfig, seed: u64) -> Result<Self, SimulationError> {
        // The pointer moves the finger; the world's own stroke never starts.
        let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0)?;
        let rig = Rig::new(memory, config, stroke, seed)?;
        Ok(Self {
            felt: FeltSampler::new(rig.tick_hz()),
            rig,
            pointer: Pointer::default(),
            touch: TouchFollower::new(&config.board),
            touched: TouchedPlaces::default(),
            last: None,
            observer: None,
        })
    }

    /// Calls `observer` with every tick.
    #[must_use]
    pub(crate) fn observed(self, observer: impl FnMut(&RigTick<Status>) + 'static) -> Self {
        Self { observer: Some(Box::new(observer)), ..self }
    }

    /// The world, to change its touch source or to inject faults.
    pub(crate) fn world_mut(&mut self) -> &mut frixel_hil_sim::World {
        self.rig.world_mut()
    }

    /// Ticks since power-on.
    pub(crate) fn tick(&self) -> u64 {
        self.rig.tick()
    }

    /// Whether the finger was on the screen in the last tick.
    pub(crate) fn is_touched(&self) -> bool {
        self.last.is_some_and(|last| last.felt.finger.is_some())
    }

    /// The board's state and latched fault after the last tick.
    pub(crate) fn state(&self) -> (State, Option<Fault>) {
        let Some(RigTick { status, .. }) = self.last else { return (State::Disarmed, None) };
        let state = status.telemetry.state;
        (state, status.fault.map(|(fault, _)| fault).filter(|_| state == State::Faulted))
    }

    /// Places of the finger as seen by the board in the last tick.
    #[cfg(test)]
    pub(crate) fn touched(&self) -> TouchedPlaces {
        self.touched
    }

    /// Passes one tick.
    pub(crate) fn step(&mut self) -> RigTick<Status> {
        let tick_hz = f64::from(self.rig.tick_hz());
        let finger = self.pointer.at(self.rig.tick() as f64);
        let world = self.world_mut();
        match finger {
            None => world.lift_finger(),
            Some(Finger { place_m: [x_m, y_m], speed_m_per_tick, normal_load_n }) => {
                let state = FingerState { x_m, y_m, speed_m_per_s: speed_m_per_tick * tick_hz };
                match normal_load_n {
                    Some(load_n) => world.place_pressing_finger(state, load_n),
                    None => world.place_finger(state),
                }
            }
        }
        let touch = world.touch();
        let record = self.rig.step();
        self.touched = self.touch.advance(touch, record.status.telemetry.tick);
        self.felt.add(&record, self.touched, self.rig.world_mut().finger_law());
        if let Some(observer) = &mut self.observer {
            observer(&record);
        }
        self.last = Some(record);
        record
    }
}

impl Recorded for PointerStream<'_> {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        self.felt.recorder_mut()
    }
}

impl ByteStream for PointerStream<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        while !self.rig.has_received() && self.now() < end {
            self.step();
        }
        self.rig.receive(buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs(self.rig.tick()) / self.rig.tick_hz()
    }

    fn name(&self) -> &'static str {
        "the simulator"
    }
}
