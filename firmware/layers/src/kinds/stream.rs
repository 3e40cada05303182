//! Friction streamed by the host during the play: `low + (high - low) s`, with the sample `s` from 0 to 1.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::measured;
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;

parameters! {
    /// Friction streamed by the host during the play: `low + (high - low) s`, with the sample `s` from 0 to 1.
    pub struct Stream {
        /// Electric friction of sample 0, N.
        low_n: f32 = 24 in range::FRICTION_N,
        /// Electric friction of sample 1, N.
        high_n: f32 = 28 in range::FRICTION_N,
    }
}

impl Kind for Stream {
    type Coefficients = StreamCoefficients;

    const COST_ELSEWHERE: Cost = measured::STREAM_ELSEWHERE;
    const STREAMED: bool = true;

    fn cost(&self) -> Cost {
        const { measured_cost("stream") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.low_n, self.high_n])
    }

    fn prepare(&self, _layer: u8, _preparation: &mut Preparation) -> Result<StreamCoefficients, Refusal> {
        Ok(StreamCoefficients { low_n: self.low_n, span_n: self.high_n - self.low_n })
    }
}

/// `low + span` times the stream's sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StreamCoefficients {
    low_n: f32,
    span_n: f32,
}

impl Evaluate for StreamCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        self.low_n + self.span_n * context.inputs.stream.value
    }
}
