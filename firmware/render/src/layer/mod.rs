//! Layers as the tick evaluates them: a file for each kind that is more than a number.

#[cfg(feature = "grating")]
mod grating;
#[cfg(feature = "bitmap")]
mod picture;
mod region;
#[cfg(test)]
mod tests;

use frixel_wire::scene::{Blend, Layer as Kind, Record};

use crate::bitmap_pool::{Bitmap, BitmapPool};
#[cfg(feature = "stream")]
use crate::stream::StreamNow;
#[cfg(feature = "grating")]
use grating::Grating;
#[cfg(feature = "bitmap")]
use picture::Picture;
use region::Region;

/// What a layer's friction depends on at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// Where the finger is taken to be, in m.
    pub(crate) x_m: f32,
    pub(crate) y_m: f32,
    /// The host's stream.
    #[cfg(feature = "stream")]
    pub(crate) stream: StreamNow,
}

/// A layer, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    region: Region,
    blend: Blend,
    gain: f32,
    source: Source,
}

/// What a layer is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Constant {
        electric_friction_n: f32,
    },
    #[cfg(feature = "grating")]
    Grating(Grating),
    #[cfg(feature = "bitmap")]
    Picture(Picture),
    /// `low + span` times the stream's sample.
    #[cfg(feature = "stream")]
    Stream {
        low_n: f32,
        span_n: f32,
    },
}

impl Layer {
    /// The layer of a record whose numbers were checked, and whose bitmap, if it has one, lies at `bitmap`; `None` for
    /// a kind that this firmware was built without.
    pub(crate) fn new(record: &Record, bitmap: Option<Bitmap>) -> Option<Self> {
        let source = Source::new(&record.layer, bitmap)?;
        Some(Self { region: Region::new(record.region), blend: record.blend, gain: record.gain, source })
    }

    pub(crate) fn set_gain(&mut self, gain: f32) {
        self.gain = gain;
    }

    /// It acts on the whole screen.
    pub(crate) fn is_everywhere(&self) -> bool {
        self.region == Region::Screen
    }

    /// This layer's electric friction at a moment, wherever that is, with nothing below it.
    #[inline]
    pub(crate) fn own_electric_friction_n(&self, moment: &Moment, pool: &BitmapPool) -> f32 {
        self.faded(0.0, self.gain * self.source.electric_friction_n(moment, pool), moment)
    }

    /// Joins this layer's electric friction at a moment to that of the layers below.
    #[inline]
    pub(crate) fn blend_over(&self, below_n: f32, moment: &Moment, pool: &BitmapPool) -> f32 {
        if !self.region.contains(moment.x_m, moment.y_m) {
            return below_n;
        }
        let own_n = self.gain * self.source.electric_friction_n(moment, pool);
        let blended_n = match self.blend {
            Blend::Replace => own_n,
            Blend::Add => below_n + own_n,
        };
        self.faded(below_n, blended_n, moment)
    }

    /// What there is of a blend: all of it, but for a stream, which fades as if the layer were not there.
    #[inline]
    #[cfg_attr(not(feature = "stream"), allow(unused_variables, clippy::unused_self, reason = "nothing fades"))]
    fn faded(&self, below_n: f32, blended_n: f32, moment: &Moment) -> f32 {
        #[cfg(feature = "stream")]
        if let Source::Stream { .. } = self.source {
            return below_n + moment.stream.weight * (blended_n - below_n);
        }
        blended_n
    }
}

/// Whether a layer plays what the host streams.
#[cfg(feature = "stream")]
pub(crate) fn is_stream(record: &Record) -> bool {
    matches!(record.layer, Kind::Stream { .. })
}

impl Source {
    fn new(kind: &Kind, bitmap: Option<Bitmap>) -> Option<Self> {
        match *kind {
            Kind::Constant { electric_friction_n } => Some(Self::Constant { electric_friction_n }),
            #[cfg(feature = "grating")]
            Kind::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n } => {
                let cycles_per_m = [cycles_per_m_x, cycles_per_m_y];
                Some(Self::Grating(Grating::new(wave, cycles_per_m, phase_turns, [trough_n, crest_n])))
            }
            #[cfg(feature = "bitmap")]
            Kind::Bitmap { x_m, y_m, pitch_m, black_n, white_n, .. } => {
                bitmap.map(|bitmap| Self::Picture(Picture::new(bitmap, [x_m, y_m], pitch_m, [black_n, white_n])))
            }
            #[cfg(feature = "stream")]
            Kind::Stream { low_n, high_n } => Some(Self::Stream { low_n, span_n: high_n - low_n }),
            #[cfg(not(all(feature = "grating", feature = "bitmap", feature = "stream")))]
            _ => {
                let _ = bitmap;
                None
            }
        }
    }

    /// Electric friction at a moment, in N, before the gain.
    ///
    /// Not inlined: a loop over layers would begin with the constants of every kind, and go past away layers slowly.
    #[inline(never)]
    #[cfg_attr(
        not(all(feature = "grating", feature = "bitmap")),
        allow(unused_variables, reason = "the other kinds of layer do not look at them")
    )]
    fn electric_friction_n(&self, moment: &Moment, pool: &BitmapPool) -> f32 {
        match self {
            Self::Constant { electric_friction_n } => *electric_friction_n,
            #[cfg(feature = "grating")]
            Self::Grating(grating) => grating.electric_friction_n(moment),
            #[cfg(feature = "bitmap")]
            Self::Picture(picture) => picture.electric_friction_n(moment, pool),
            #[cfg(feature = "stream")]
            Self::Stream { low_n, span_n } => low_n + span_n * moment.stream.value,
        }
    }
}
