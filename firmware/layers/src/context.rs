//! The evaluation context: everything that the evaluation of a layer depends on besides its coefficients.

use crate::bitmap_pool::BitmapPool;
use crate::clicks::Clicks;
use crate::tables::Tables;

/// The inputs of an evaluation: the finger's position and velocity, the time, and the host's stream.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Estimated position of the finger, from the screen's top left corner, in m.
    pub(crate) place_m: [f32; 2],
    /// The place in the integer steps of rectangles.
    pub(crate) place_steps: [i32; 2],
    /// Ticks since power-on, modulo 2^32.
    pub(crate) tick: u32,
    /// Velocity of the finger, in m/s.
    pub velocity_m_per_s: [f32; 2],
    /// The stream at this tick.
    pub stream: StreamSample,
}

impl Inputs {
    /// Sets the place of the finger, in m from the screen's top left corner, and the tick.
    #[inline]
    pub fn set_place(&mut self, place_m: [f32; 2], tick: u32) {
        self.place_m = place_m;
        self.place_steps = place_m.map(place_steps);
        self.tick = tick;
    }
}

/// Integer steps per metre, each 3.7 nm. Rectangles are tested in steps, since a tick compares integers faster than
/// `f32`. All coordinates of a scene are within 4 m.
pub(crate) const STEPS_PER_M: f32 = (1 << 28) as f32;

/// A coordinate in steps; saturates at the limits of the integer.
#[inline]
pub(crate) fn place_steps(place_m: f32) -> i32 {
    (place_m * STEPS_PER_M) as i32
}

/// The host's stream at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StreamSample {
    /// The sample, from 0 to 1.
    pub value: f32,
    /// Weight of the stream's layers while it fades, from 0 (no stream) to 1.
    pub weight: f32,
}

/// The evaluation context: the tick's inputs, and the data that the layers of a scene share.
pub(crate) struct Context<'a> {
    pub(crate) inputs: &'a Inputs,
    #[cfg_attr(not(feature = "bitmap"), allow(dead_code, reason = "only bitmaps lie in the pool"))]
    pub(crate) pool: &'a BitmapPool,
    pub(crate) tables: &'a Tables,
    pub(crate) clicks: &'a mut Clicks,
}
