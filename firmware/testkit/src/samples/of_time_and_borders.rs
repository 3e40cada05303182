//! Kinds whose friction depends on time, on the finger's velocity, on what the host streams, or on which way the finger
//! came.

use frixel_layers::{
    Beat, Blend, Burst, Button, Click, Direction, Edge, Layer, Point, Region, Speed, Stream, Vibration,
};
use frixel_wire::scene::CURVE_POINTS_MAX;

use super::{CostCase, ELLIPSE, POLYGON, RECTANGLE, Sample, cost, sample};

// Their formulas need more than the place: `host/frixel/tests/kinds`.
pub(super) const SAMPLES: &[Sample] = &[EDGE, BUTTON, VIBRATION, SPEED, STREAM, DIRECTION];

const CLICK: Click = Click { height_n: 0.015, decay_s: 0.02 };
/// Short enough that ticks during the click and ticks after its end are both counted.
const CLICK_TO_COUNT: Click = Click { height_n: 0.005, decay_s: 0.05 };

const EDGE: Sample = Sample {
    records: &[sample(
        POLYGON,
        Blend::Add,
        1.0,
        Layer::Edge(Edge {
            x_m: 0.05,
            y_m: 0.04,
            angle_turns: 0.125,
            width_m: 0.004,
            level_n: 0.001,
            ridge_n: 0.02,
            click: CLICK,
        }),
        &[24..56],
    )],
    costs: &[cost(
        "tick_edge_alone",
        Layer::Edge(Edge {
            x_m: 0.03,
            y_m: 0.03,
            angle_turns: 0.02,
            width_m: 0.05,
            level_n: 0.0,
            ridge_n: 0.02,
            click: CLICK_TO_COUNT,
        }),
    )],
    random: |draw| {
        let [x_m, y_m] = draw.place_m(0.0);
        Layer::Edge(Edge {
            x_m,
            y_m,
            angle_turns: draw.random.between(-1.0, 1.0),
            width_m: draw.random.pick([1e-3, 0.02, 0.5]),
            level_n: draw.amounts[0],
            ridge_n: draw.amounts[1],
            click: draw.click,
        })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};

const BUTTON: Sample = Sample {
    records: &[sample(
        ELLIPSE,
        Blend::Replace,
        1.0,
        Layer::Button(Button { rim_width_m: 0.002, rim_n: 0.02, face_n: 0.005, click: CLICK }),
        &[24..44],
    )],
    // The finger slides in.
    costs: &[CostCase {
        name: "tick_button_alone",
        region: Region::Rectangle { x_m: 0.025, y_m: 0.0, width_m: 0.09, height_m: 0.11 },
        layer: Layer::Button(Button { rim_width_m: 0.02, rim_n: 0.02, face_n: 0.001, click: CLICK_TO_COUNT }),
    }],
    random: |draw| {
        Layer::Button(Button {
            rim_width_m: draw.random.pick([1e-3, 0.01, 0.1]),
            rim_n: draw.amounts[0],
            face_n: draw.amounts[1],
            click: draw.click,
        })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};

const fn vibration(beat: Beat, burst: Burst) -> Layer {
    Layer::Vibration(Vibration { beat, frequency_hz: 80.0, low_n: 0.001, high_n: 0.02, burst })
}

const fn vibration_to_count(beat: Beat) -> Layer {
    let burst = Burst { period_s: 0.05, on_s: 0.03, ramp_s: 0.01 };
    Layer::Vibration(Vibration { beat, frequency_hz: 90.0, low_n: 0.001, high_n: 0.02, burst })
}

const NO_BURST: Burst = Burst { period_s: 0.0, on_s: 0.0, ramp_s: 0.0 };

const VIBRATION: Sample = Sample {
    records: &[
        sample(Region::Screen, Blend::Max, 1.0, vibration(Beat::Sine, NO_BURST), &[3..4, 24..48]),
        sample(
            Region::Screen,
            Blend::Add,
            1.0,
            vibration(Beat::Square, Burst { period_s: 0.5, on_s: 0.25, ramp_s: 0.0625 }),
            &[3..4, 24..48],
        ),
    ],
    costs: &[
        cost("tick_vibration_sine_alone", vibration_to_count(Beat::Sine)),
        cost("tick_vibration_square_alone", vibration_to_count(Beat::Square)),
    ],
    random: |draw| {
        Layer::Vibration(Vibration {
            beat: draw.random.pick([Beat::Sine, Beat::Square]),
            frequency_hz: draw.random.pick([0.01, 80.0, 1000.0]),
            low_n: draw.amounts[0],
            high_n: draw.amounts[1],
            burst: draw.random.pick([NO_BURST, Burst { period_s: 0.02, on_s: 0.012, ramp_s: 0.005 }]),
        })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};

const SPEED: Sample = Sample {
    records: &[sample(Region::Screen, Blend::Multiply, 1.0, Layer::Speed(Speed { first: 0, count: 2 }), &[52..54])],
    // A benchmark counts curves of two lengths, and takes the cost of a point from them.
    costs: &[],
    random: |draw| {
        let count = 2 + draw.random.below(CURVE_POINTS_MAX as u32 - 1);
        let step_m_per_s = draw.random.pick([1e-3, 0.02, 0.1]);
        let mut curve = [Point::default(); CURVE_POINTS_MAX];
        for (number, point) in (0..count).zip(&mut curve) {
            *point = Point { x: step_m_per_s * number as f32, y: draw.amount() };
        }
        let added = draw.add_points(curve.into_iter().take(count as usize));
        Layer::Speed(Speed { first: added.start, count: added.len() as u8 })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};

const STREAM: Sample = Sample {
    records: &[sample(RECTANGLE, Blend::Replace, 1.0, Layer::Stream(Stream { low_n: 0.002, high_n: 0.02 }), &[24..32])],
    costs: &[cost("tick_stream_alone", Layer::Stream(Stream { low_n: 0.001, high_n: 0.02 }))],
    random: |draw| Layer::Stream(Stream { low_n: draw.amounts[0], high_n: draw.amounts[1] }),
    #[cfg(feature = "std")]
    formulas: &[],
};

const DIRECTION: Sample = Sample {
    records: &[sample(
        ELLIPSE,
        Blend::Multiply,
        1.0,
        Layer::Direction(Direction { angle_turns: 0.125, along_n: 0.25, against_n: 1.0 }),
        &[24..36],
    )],
    costs: &[cost(
        "tick_direction_alone",
        Layer::Direction(Direction { angle_turns: 0.125, along_n: 0.002, against_n: 0.02 }),
    )],
    random: |draw| {
        let [along_n, against_n] = draw.amounts;
        Layer::Direction(Direction { angle_turns: draw.turned, along_n, against_n })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};
