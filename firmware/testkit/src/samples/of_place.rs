//! Kinds whose friction depends on the place alone.

#[cfg(feature = "std")]
use core::f64::consts::TAU;

use frixel_layers::{Bitmap, Blend, Constant, Grating, Layer, Noise, Region, Rings, Spokes, Wave};

#[cfg(feature = "std")]
use super::formula::{ACROSS, Formula, along_deg, noise, sine, turn};
use super::{ELLIPSE, PICTURE, POLYGON, RECTANGLE, Sample, cost, sample};

pub(super) const SAMPLES: &[Sample] = &[CONSTANT, GRATING, BITMAP, NOISE, RINGS, SPOKES];

const CONSTANT: Sample = Sample {
    records: &[sample(
        Region::Screen,
        Blend::Replace,
        1.0,
        Layer::Constant(Constant { electric_friction_n: 0.01 }),
        &[24..28],
    )],
    costs: &[cost("tick_constant_alone", Layer::Constant(Constant { electric_friction_n: 0.001 }))],
    random: |draw| Layer::Constant(Constant { electric_friction_n: draw.amounts[0] }),
    #[cfg(feature = "std")]
    formulas: &[Formula {
        name: "constant",
        toml: "[[layer]]\nkind = \"constant\"\nfriction_n = 0.262\ngain = 1.5",
        stroke_mm: ACROSS,
        friction_mn: |_, _| 18.0,
        jumps: false,
        bound: 0.0013,
    }],
};

const fn grating(wave: Wave, drift_hz: f32) -> Layer {
    Layer::Grating(Grating {
        wave,
        cycles_per_m_x: 500.0,
        cycles_per_m_y: -250.0,
        phase_turns: 0.25,
        trough_n: 0.002,
        crest_n: 0.02,
        drift_hz,
    })
}

/// A grating whose evaluation a benchmark counts.
#[must_use]
pub const fn grating_to_count(wave: Wave, drift_hz: f32) -> Layer {
    Layer::Grating(Grating {
        wave,
        cycles_per_m_x: 500.0,
        cycles_per_m_y: 100.0,
        phase_turns: 0.2,
        trough_n: 0.0,
        crest_n: 0.026,
        drift_hz,
    })
}

const GRATING: Sample = Sample {
    records: &[
        sample(RECTANGLE, Blend::Add, 0.5, grating(Wave::Sine, 0.0), &[3..4, 24..44, 48..52]),
        sample(Region::Screen, Blend::Add, -1.0, grating(Wave::Square { duty: 0.25 }, -2.5), &[3..4, 24..52]),
        sample(ELLIPSE, Blend::Multiply, 1.0, grating(Wave::Triangle, 4.0), &[3..4, 24..44, 48..52]),
        sample(POLYGON, Blend::Max, 1.0, grating(Wave::Saw, 0.0), &[3..4, 24..44, 48..52]),
    ],
    costs: &[
        cost("tick_sine_alone", grating_to_count(Wave::Sine, 0.0)),
        cost("tick_square_alone", grating_to_count(Wave::Square { duty: 0.5 }, 0.0)),
        cost("tick_triangle_alone", grating_to_count(Wave::Triangle, 0.0)),
        cost("tick_saw_alone", grating_to_count(Wave::Saw, 0.0)),
        cost("tick_drift_over_sine_alone", grating_to_count(Wave::Sine, -2.5)),
    ],
    random: |draw| {
        Layer::Grating(Grating {
            wave: draw.wave(),
            cycles_per_m_x: draw.random.between(-2e3, 2e3),
            cycles_per_m_y: draw.random.between(-2e3, 2e3),
            phase_turns: draw.random.between(-3.0, 3.0),
            trough_n: draw.amounts[0],
            crest_n: draw.amounts[1],
            drift_hz: draw.drift_hz(),
        })
    },
    #[cfg(feature = "std")]
    formulas: &[
        Formula {
            name: "sine grating",
            toml: "[[layer]]\nkind = \"grating\"\nwavelength_mm = 5\nangle_deg = 30\nphase_deg = 45\n\
                    low_n = 0.002\nhigh_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, y| 2.0 + 20.0 * sine(along_deg(x, y, 30.0) / 5.0 + 0.125),
            jumps: false,
            bound: 0.0392,
        },
        Formula {
            name: "square grating",
            toml: "[[layer]]\nkind = \"grating\"\nwave = \"square\"\nduty = 0.3\nwavelength_mm = 10\n\
                    low_n = 0.002\nhigh_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, _| if turn(x / 10.0) < 0.3 { 22.0 } else { 2.0 },
            jumps: true,
            bound: 0.074,
        },
        Formula {
            name: "triangle grating",
            toml: "[[layer]]\nkind = \"grating\"\nwave = \"triangle\"\nwavelength_mm = 6\nangle_deg = 90\n\
                    low_n = 0.002\nhigh_n = 0.022",
            stroke_mm: [(20.0, 5.0), (60.0, 75.0)],
            friction_mn: |_, y| 2.0 + 20.0 * (1.0 - (2.0 * turn(y / 6.0) - 1.0).abs()),
            jumps: false,
            bound: 0.0309,
        },
        Formula {
            name: "saw grating",
            toml: "[[layer]]\nkind = \"grating\"\nwave = \"saw\"\nwavelength_mm = 12\nlow_n = 0.002\n\
                    high_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, _| 2.0 + 20.0 * turn(x / 12.0),
            jumps: true,
            bound: 0.0853,
        },
    ],
};

const fn bitmap(tiled: bool, angle_turns: f32) -> Layer {
    Layer::Bitmap(Bitmap {
        crc32: PICTURE,
        x_m: 0.001,
        y_m: 0.002,
        pitch_m: 0.00025,
        black_n: 0.0,
        white_n: 0.025,
        pitch_y_m: 0.0003,
        angle_turns,
        tiled,
    })
}

/// A bitmap whose evaluation a benchmark counts.
#[must_use]
pub const fn bitmap_to_count(tiled: bool) -> Layer {
    Layer::Bitmap(Bitmap {
        crc32: PICTURE,
        x_m: 0.01,
        y_m: 0.0,
        pitch_m: 1e-3,
        black_n: 0.0,
        white_n: 0.026,
        pitch_y_m: 1e-3,
        angle_turns: if tiled { 0.05 } else { 0.0 },
        tiled,
    })
}

// The formulas of pictures need the samples of the picture: `host/frixel/tests/kinds`.
const BITMAP: Sample = Sample {
    records: &[
        sample(RECTANGLE, Blend::Replace, 2.0, bitmap(false, 0.0), &[3..4, 24..56]),
        sample(Region::Screen, Blend::Add, 1.0, bitmap(true, 0.125), &[3..4, 24..56]),
    ],
    costs: &[cost("tick_bitmap_alone", bitmap_to_count(false)), cost("tick_bitmap_tiled_alone", bitmap_to_count(true))],
    random: |draw| {
        let [width_m, height_m] = [draw.header.screen_width_m, draw.header.screen_height_m];
        Layer::Bitmap(Bitmap {
            crc32: draw.picture,
            x_m: draw.random.between(-0.5, 1.0) * width_m,
            y_m: draw.random.between(-0.5, 1.0) * height_m,
            pitch_m: draw.random.pick([1e-4, 1e-3, 3e-3]),
            black_n: draw.amounts[0],
            white_n: draw.amounts[1],
            pitch_y_m: draw.random.pick([1e-4, 1e-3, 3e-3]),
            angle_turns: draw.random.pick([0.0, 0.25, draw.turned]),
            tiled: draw.random.once_in(2),
        })
    },
    #[cfg(feature = "std")]
    formulas: &[],
};

const NOISE: Sample = Sample {
    records: &[sample(
        Region::Screen,
        Blend::Add,
        1.0,
        Layer::Noise(Noise {
            seed: 0x0123_4567,
            wavelength_min_m: 0.001,
            wavelength_max_m: 0.004,
            low_n: 0.002,
            high_n: 0.02,
        }),
        &[24..40, 52..56],
    )],
    costs: &[cost(
        "tick_noise_alone",
        Layer::Noise(Noise { seed: 7, wavelength_min_m: 1e-3, wavelength_max_m: 5e-3, low_n: 0.001, high_n: 0.02 }),
    )],
    random: |draw| {
        Layer::Noise(Noise {
            seed: draw.random.bits(),
            wavelength_min_m: draw.random.between(5e-5, 2e-3),
            wavelength_max_m: draw.random.between(2e-3, 0.5),
            low_n: draw.amounts[0],
            high_n: draw.amounts[1],
        })
    },
    #[cfg(feature = "std")]
    formulas: &[Formula {
        name: "noise",
        toml: "[[layer]]\nkind = \"noise\"\nseed = 20260\nwavelength_min_mm = 4\nwavelength_max_mm = 12\n\
                low_n = 0.002\nhigh_n = 0.026",
        stroke_mm: ACROSS,
        friction_mn: |x, y| 2.0 + 24.0 * noise(20260, 4.0, 12.0, x, y),
        jumps: false,
        bound: 0.0125,
    }],
};

const fn rings(wave: Wave, drift_hz: f32) -> Layer {
    Layer::Rings(Rings { wave, x_m: 0.05, y_m: 0.03, cycles_per_m: 400.0, trough_n: 0.002, crest_n: 0.02, drift_hz })
}

const fn rings_to_count(drift_hz: f32) -> Layer {
    let (wave, trough_n, crest_n) = (Wave::Sine, 0.0, 0.026);
    Layer::Rings(Rings { wave, x_m: 0.06, y_m: 0.05, cycles_per_m: 500.0, trough_n, crest_n, drift_hz })
}

const RINGS: Sample = Sample {
    records: &[
        sample(ELLIPSE, Blend::Add, 1.0, rings(Wave::Sine, 0.0), &[3..4, 24..44, 48..52]),
        sample(Region::Screen, Blend::Replace, 0.5, rings(Wave::Square { duty: 0.25 }, 4.0), &[3..4, 24..52]),
    ],
    costs: &[
        cost("tick_rings_over_sine_alone", rings_to_count(0.0)),
        cost("tick_drifting_rings_over_sine_alone", rings_to_count(4.0)),
    ],
    random: |draw| {
        let wave = draw.wave();
        let [x_m, y_m] = draw.place_m(0.2);
        Layer::Rings(Rings {
            wave,
            x_m,
            y_m,
            cycles_per_m: draw.random.between(0.0, 2e3),
            trough_n: draw.amounts[0],
            crest_n: draw.amounts[1],
            drift_hz: draw.drift_hz(),
        })
    },
    #[cfg(feature = "std")]
    formulas: &[
        Formula {
            name: "rings",
            toml: "[[layer]]\nkind = \"rings\"\nx_mm = 50\ny_mm = 20\nwavelength_mm = 6\nlow_n = 0.002\n\
                    high_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, y| 2.0 + 20.0 * sine((x - 50.0).hypot(y - 20.0) / 6.0),
            jumps: false,
            bound: 0.0272,
        },
        Formula {
            name: "square rings",
            toml: "[[layer]]\nkind = \"rings\"\nwave = \"square\"\nduty = 0.3\nx_mm = 50\ny_mm = 20\n\
                    wavelength_mm = 10\nlow_n = 0.002\nhigh_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, y| if turn((x - 50.0).hypot(y - 20.0) / 10.0) < 0.3 { 22.0 } else { 2.0 },
            jumps: true,
            bound: 0.0903,
        },
    ],
};

const fn spokes(wave: Wave) -> Layer {
    Layer::Spokes(Spokes { wave, x_m: 0.05, y_m: 0.03, phase_turns: 0.25, trough_n: 0.002, crest_n: 0.02, number: 24 })
}

const SPOKES: Sample = Sample {
    records: &[
        sample(ELLIPSE, Blend::Add, 1.0, spokes(Wave::Sine), &[3..4, 24..44, 52..53]),
        sample(Region::Screen, Blend::Max, 0.5, spokes(Wave::Square { duty: 0.25 }), &[3..4, 24..48, 52..53]),
    ],
    costs: &[cost(
        "tick_spokes_over_sine_alone",
        Layer::Spokes(Spokes {
            wave: Wave::Sine,
            x_m: 0.06,
            y_m: 0.05,
            phase_turns: 0.2,
            trough_n: 0.0,
            crest_n: 0.026,
            number: 24,
        }),
    )],
    random: |draw| {
        let wave = draw.wave();
        let [x_m, y_m] = draw.place_m(0.2);
        Layer::Spokes(Spokes {
            wave,
            x_m,
            y_m,
            phase_turns: draw.random.between(-3.0, 3.0),
            trough_n: draw.amounts[0],
            crest_n: draw.amounts[1],
            number: draw.random.byte(),
        })
    },
    #[cfg(feature = "std")]
    formulas: &[
        Formula {
            name: "spokes",
            toml: "[[layer]]\nkind = \"spokes\"\nx_mm = 50\ny_mm = 20\nnumber = 24\nangle_deg = 10\nlow_n = 0.002\n\
                    high_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, y| 2.0 + 20.0 * sine(24.0 * ((y - 20.0).atan2(x - 50.0) / TAU - 10.0 / 360.0)),
            jumps: false,
            bound: 0.0279,
        },
        Formula {
            name: "saw spokes across their middle",
            toml: "[[layer]]\nkind = \"spokes\"\nwave = \"saw\"\nx_mm = 60\ny_mm = 37.5\nnumber = 40\n\
                    low_n = 0.002\nhigh_n = 0.022",
            stroke_mm: ACROSS,
            friction_mn: |x, y| {
                let (x, y) = (x - 60.0, y - 37.5);
                let width = TAU * x.hypot(y) / 40.0;
                12.0 + width.powi(2).min(1.0) * (20.0 * turn(40.0 * y.atan2(x) / TAU) - 10.0)
            },
            jumps: true,
            bound: 0.0156,
        },
    ],
};
