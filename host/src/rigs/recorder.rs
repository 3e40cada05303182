//! What a simulated finger felt, tick by tick, against what it should have.

use frixel_hil_sim::{FingerState, TickRecord, contact_of};
use frixel_model::LoadedContact;
use frixel_wire::fault::Flags;
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::{Carrier, Header};

use crate::metrics::{Metrics, TickSample};
use crate::scene::Program;
use crate::wanted::Wanted;

/// Gathers the errors of every tick, and a row every so many.
pub struct Recorder {
    wanted: Option<Wanted>,
    dac: Option<Dac>,
    metrics: Option<Metrics>,
    interval: Interval,
    rows: Vec<FeltRow>,
    ticks_per_row: u32,
    tick_hz: u32,
}
