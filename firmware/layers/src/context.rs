//! What the evaluation of a layer depends on besides its own coefficients.

use crate::bitmap_pool::BitmapPool;
use crate::click::Clicks;
use crate::region::place_steps;
use crate::tables::Tables;

/// What the tick evaluates a scene for: the finger's place and velocity, the time, and the host's stream.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Where the finger is taken to be, from the screen's top left corner, in m.
    pub(crate) place_m: [f32; 2],
    /// The same, as rectangles take it.
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

/// The host's stream at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StreamSample {
    /// The sample, from 0 to 1.
    pub value: f32,
    /// How much of the stream's layers there is, from 0 without a stream to 1.
    pub weight: f32,
}

/// The evaluation context: the tick's inputs, and what the layers of a scene share.
pub(crate) struct Context<'a> {
    pub(crate) inputs: &'a Inputs,
    #[cfg_attr(not(feature = "bitmap"), allow(dead_code, reason = "only bitmaps lie in the pool"))]
    pub(crate) pool: &'a BitmapPool,
    pub(crate) tables: &'a Tables,
    pub(crate) clicks: &'a mut Clicks,
}
