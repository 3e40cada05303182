//! The ticks of an emulated board's world, which wait for the telemetry of the same ticks.

use std::collections::VecDeque;

use frixel_felt::recorder::{Observation, Recorder};
use frixel_hil_sim::emulated::LinkRecord;
use frixel_wire::message::Telemetry;

/// Ticks without their telemetry yet, and telemetry without its tick yet.
#[derive(Default)]
pub(super) struct HeldTicks {
    pub(super) recorder: Recorder,
    ticks: VecDeque<LinkRecord>,
    telemetry: VecDeque<Telemetry>,
}

impl HeldTicks {
    /// Holds ticks of the world.
    pub(super) fn hold(&mut self, ticks: impl IntoIterator<Item = LinkRecord>) {
        self.ticks.extend(ticks);
    }

    /// Holds telemetry, whose ticks are those of the world.
    pub(super) fn hear(&mut self, telemetry: impl IntoIterator<Item = Telemetry>) {
        self.telemetry.extend(telemetry);
    }

    /// Records all ticks so far except the last `held`.
    pub(super) fn record(&mut self, held: usize) {
        let count = self.ticks.len().saturating_sub(held);
        for record in self.ticks.drain(..count) {
            let telemetry = telemetry_of(record.tick, &mut self.telemetry);
            let observation = Observation::of_world(record.tick, &record.felt, record.drive.dac_code.bits());
            self.recorder.record(&Observation { telemetry, ..observation });
        }
    }
}

/// Removes the telemetry up to a tick, and returns the message of that tick.
fn telemetry_of(tick: u32, telemetry: &mut VecDeque<Telemetry>) -> Option<Telemetry> {
    let mut last = None;
    while let Some(earlier) = telemetry.pop_front_if(|telemetry| tick.wrapping_sub(telemetry.tick) as i32 >= 0) {
        last = Some(earlier);
    }
    last.filter(|last| last.tick == tick)
}
