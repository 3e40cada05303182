//! Layers as the tick evaluates them: a file for each kind that is more than a number.

#[cfg(feature = "edge")]
mod button;
mod click;
#[cfg(feature = "speed")]
mod curve;
#[cfg(feature = "edge")]
mod edge;
#[cfg(feature = "grating")]
mod grating;
mod load;
#[cfg(feature = "noise")]
mod noise;
#[cfg(feature = "bitmap")]
mod picture;
mod region;
#[cfg(feature = "stream")]
mod streamed;
mod tables;
#[cfg(test)]
mod tests;
#[cfg(feature = "vibration")]
mod vibration;

#[cfg(feature = "stream")]
use frixel_wire::scene::Layer as Kind;
use frixel_wire::scene::{self as wire, Blend, Record};

use crate::bitmap_pool::BitmapPool;
#[cfg(feature = "stream")]
use crate::stream::StreamNow;
#[cfg(feature = "edge")]
use button::Button;
pub(crate) use click::Clicks;
#[cfg(feature = "speed")]
use curve::Curve;
#[cfg(feature = "edge")]
use edge::Edge;
#[cfg(feature = "grating")]
use grating::Grating;
pub(crate) use load::LayerLoading;
#[cfg(feature = "noise")]
use noise::Noise;
#[cfg(feature = "bitmap")]
use picture::Picture;
use region::Region;
#[cfg(feature = "stream")]
use streamed::Streamed;
pub(crate) use tables::Tables;
#[cfg(feature = "vibration")]
use vibration::Vibration;

/// What a layer's friction depends on at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// Where the finger is taken to be, in m.
    pub(crate) place_m: [f32; 2],
    /// The same, as rectangles take it.
    place_steps: [i32; 2],
    /// How the finger slides.
    #[cfg(feature = "speed")]
    pub(crate) velocity_m_per_s: [f32; 2],
    /// Ticks since power-on, modulo 2^32.
    pub(crate) tick: u32,
    /// The host's stream.
    #[cfg(feature = "stream")]
    pub(crate) stream: StreamNow,
}

impl Moment {
    /// The finger is at a place at a tick.
    #[inline]
    pub(crate) fn meet(&mut self, place_m: [f32; 2], tick: u32) {
        self.place_m = place_m;
        self.place_steps = place_m.map(region::steps);
        self.tick = tick;
    }
}

/// What layers look at besides their own numbers.
#[allow(dead_code, reason = "kinds that are left out do not look at all of it")]
pub(crate) struct Around<'a> {
    pub(crate) moment: &'a Moment,
    pub(crate) pool: &'a BitmapPool,
    pub(crate) tables: &'a Tables,
    pub(crate) clicks: &'a mut Clicks,
}

/// A layer, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    region: Region,
    join: Join,
    gain: f32,
    source: Source,
}

/// What a layer is. Its tag is a byte of its own, so that the tick finds the kind at once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
enum Source {
    Constant {
        electric_friction_n: f32,
    },
    #[cfg(feature = "grating")]
    Grating(Grating),
    #[cfg(feature = "bitmap")]
    Picture(Picture),
    #[cfg(feature = "noise")]
    Noise(Noise),
    #[cfg(feature = "edge")]
    Edge(Edge),
    #[cfg(feature = "edge")]
    Button(Button),
    #[cfg(feature = "vibration")]
    Vibration(Vibration),
    #[cfg(feature = "speed")]
    Curve(Curve),
    #[cfg(feature = "stream")]
    Stream(Streamed),
}

/// Bytes that a record becomes: a layer, and what of it lies in the tables; its points apart.
pub(crate) fn bytes_of(record: &Record) -> usize {
    let in_tables = match record.layer {
        #[cfg(feature = "noise")]
        wire::Layer::Noise { .. } => size_of::<noise::Waves>(),
        wire::Layer::Edge { click, .. } | wire::Layer::Button { click, .. } if click.height_n.abs() > 0.0 => {
            size_of::<click::Click>()
        }
        _ => 0,
    };
    size_of::<Layer>() + in_tables
}

impl Layer {
    pub(crate) fn set_gain(&mut self, gain: f32) {
        self.gain = gain;
    }

    /// It plays what the host streams.
    #[cfg(feature = "stream")]
    pub(crate) fn is_stream(&self) -> bool {
        matches!(self.join, Join::Fading(_))
    }

    /// This layer's electric friction at a moment, wherever that is, with nothing below it.
    #[inline]
    pub(crate) fn own_electric_friction_n(&self, around: &mut Around) -> f32 {
        self.gain * self.source.electric_friction_n(&self.region, around)
    }

    /// Joins this layer's electric friction at a moment to that of the layers below.
    #[inline]
    pub(crate) fn blend_over(&self, below_n: f32, around: &mut Around) -> f32 {
        if !self.region.contains(around) {
            return below_n;
        }
        let own_n = self.own_electric_friction_n(around);
        match self.join {
            Join::Replace => own_n,
            Join::Add => below_n + own_n,
            Join::Multiply => below_n * own_n,
            Join::Max => {
                if own_n > below_n {
                    own_n
                } else {
                    below_n
                }
            }
            #[cfg(feature = "stream")]
            Join::Fading(blend) => streamed::fading(blend, below_n, own_n, around),
        }
    }
}

/// How a layer joins those below it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
enum Join {
    Replace,
    Add,
    Multiply,
    Max,
    /// As far as there is a stream.
    #[cfg(feature = "stream")]
    Fading(Blend),
}

impl Join {
    fn new(record: &Record) -> Self {
        #[cfg(feature = "stream")]
        if is_stream(record) {
            return Self::Fading(record.blend);
        }
        match record.blend {
            Blend::Replace => Self::Replace,
            Blend::Add => Self::Add,
            Blend::Multiply => Self::Multiply,
            Blend::Max => Self::Max,
        }
    }
}

/// Whether a layer plays what the host streams.
#[cfg(feature = "stream")]
pub(crate) fn is_stream(record: &Record) -> bool {
    matches!(record.layer, Kind::Stream { .. })
}

impl Source {
    /// Electric friction at a moment, in N, before the gain.
    ///
    /// Kinds of more than a number are calls that look around by themselves: a loop over layers would begin with the
    /// constants of all of them.
    #[inline]
    #[cfg_attr(
        not(all(feature = "grating", feature = "edge")),
        allow(unused_variables, reason = "the other kinds of layer do not look at them")
    )]
    fn electric_friction_n(&self, region: &Region, around: &mut Around) -> f32 {
        match self {
            Self::Constant { electric_friction_n } => *electric_friction_n,
            #[cfg(feature = "grating")]
            Self::Grating(grating) => grating.electric_friction_n(around),
            #[cfg(feature = "bitmap")]
            Self::Picture(picture) => picture.electric_friction_n(around.moment.place_m, around.pool),
            #[cfg(feature = "noise")]
            Self::Noise(noise) => noise.electric_friction_n(around),
            #[cfg(feature = "edge")]
            Self::Edge(edge) => edge.electric_friction_n(around),
            #[cfg(feature = "edge")]
            Self::Button(button) => button.electric_friction_n(region, around),
            #[cfg(feature = "vibration")]
            Self::Vibration(vibration) => vibration.electric_friction_n(around),
            #[cfg(feature = "speed")]
            Self::Curve(curve) => curve.electric_friction_n(around),
            #[cfg(feature = "stream")]
            Self::Stream(stream) => stream.electric_friction_n(around),
        }
    }
}

/// The direction of an angle, as parts along x and y. Not for the tick.
#[cfg(any(feature = "bitmap", feature = "noise", feature = "edge"))]
fn direction(angle_turns: f32) -> (f32, f32) {
    let (y, x) = libm::sincosf(core::f32::consts::TAU * angle_turns);
    (x, y)
}
