//! What a layer is.

/// What a layer is. Frictions are electric, in newtons, before the gain; plain factors in a layer that is multiplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layer {
    /// The same friction everywhere.
    Constant {
        /// Electric friction, N.
        electric_friction_n: f32,
    },
    /// Stripes: `trough + (crest - trough) w(kx x + ky y + phase)`, with `w` between 0 and 1 and one period a turn.
    Grating {
        /// Shape of the stripes.
        wave: Wave,
        /// Cycles per metre along x.
        cycles_per_m_x: f32,
        /// Cycles per metre along y.
        cycles_per_m_y: f32,
        /// Phase, in turns.
        phase_turns: f32,
        /// Least electric friction, N.
        trough_n: f32,
        /// Largest electric friction, N.
        crest_n: f32,
    },
    /// A picture of samples at a pitch, bilinear between their centres.
    Bitmap {
        /// CRC-32 of the samples: the bitmap's name in the pool.
        crc32: u32,
        /// The corner that the first sample begins at, m.
        x_m: f32,
        /// The corner that the first sample begins at, m.
        y_m: f32,
        /// Distance of samples in a row, m.
        pitch_m: f32,
        /// Electric friction of sample 0, N.
        black_n: f32,
        /// Electric friction of sample 255, N.
        white_n: f32,
        /// Distance of rows, m.
        pitch_y_m: f32,
        /// How far the rows are turned about that corner, from x towards y, in turns.
        angle_turns: f32,
        /// It is repeated in both directions; else it is held at its border.
        tiled: bool,
    },
    /// The mean of eight cosine waves over the screen, `low + (high - low) (1 + mean) / 2`: `PROTOCOL.md` says which.
    Noise {
        /// Says which waves.
        seed: u32,
        /// Shortest wavelength, m.
        wavelength_min_m: f32,
        /// Longest wavelength, m.
        wavelength_max_m: f32,
        /// Electric friction that is not gone below, N.
        low_n: f32,
        /// Electric friction that is not gone above, N.
        high_n: f32,
    },
    /// A line with a ridge or a well along it, and a click when the finger crosses it.
    Edge {
        /// A place on the line, m.
        x_m: f32,
        /// A place on the line, m.
        y_m: f32,
        /// Direction across the line, from x towards y, in turns.
        angle_turns: f32,
        /// Width of the ridge, which falls off as a raised cosine on both sides, m.
        width_m: f32,
        /// Electric friction beside the ridge, N.
        level_n: f32,
        /// Electric friction on the line, N.
        ridge_n: f32,
        /// Felt when the line is crossed.
        click: Click,
    },
    /// A button that fills its region, which is a rectangle or an ellipse.
    Button {
        /// Width of the rim inside the border, m: a raised cosine from border to face. An ellipse's rim is measured
        /// along its shorter half axis.
        rim_width_m: f32,
        /// Electric friction in the middle of the rim, N.
        rim_n: f32,
        /// Electric friction on the face, N.
        face_n: f32,
        /// Felt when the finger slides in.
        click: Click,
    },
    /// Friction that changes with time: `low + (high - low) e w(f t)`, with the burst's envelope `e`.
    Vibration {
        /// Shape over a period.
        beat: Beat,
        /// Frequency, Hz.
        frequency_hz: f32,
        /// Electric friction between bursts, and the least within, N.
        low_n: f32,
        /// Largest electric friction, N.
        high_n: f32,
        /// How it comes and goes.
        burst: Burst,
    },
    /// A curve over sliding speed, straight between its points and held outside of them.
    Speed {
        /// Its first point among the scene's: speed in m/s, and friction in N or a factor. Speeds rise.
        first: u8,
        /// How many points it has, 2 to [`super::CURVE_POINTS_MAX`].
        count: u8,
    },
    /// What the host sends while it plays: `low + (high - low) s`, with the sample `s` from 0 to 1.
    Stream {
        /// Electric friction of sample 0, N.
        low_n: f32,
        /// Electric friction of sample 1, N.
        high_n: f32,
    },
}

/// Shape of a grating's stripes over a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Wave {
    /// `(1 + sin(2 pi turns)) / 2`.
    #[default]
    Sine,
    /// 1 in the first part of each turn, 0 in the rest.
    Square {
        /// How large the first part is, from 0 to 1.
        duty: f32,
    },
    /// Rises from 0 to 1 in the first half of each turn, and falls in the second.
    Triangle,
    /// Rises from 0 to 1 in each turn.
    Saw,
}

/// Shape of a vibration over its period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Beat {
    /// `(1 + sin(2 pi turns)) / 2`.
    #[default]
    Sine,
    /// 1 in the first half of each turn, 0 in the second.
    Square,
}

/// A short pulse of friction: `height (1 - t / decay)^2` until `decay` has passed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Click {
    /// Electric friction at its beginning, N; 0 for none.
    pub height_n: f32,
    /// How long it takes, s.
    pub decay_s: f32,
}

/// How a vibration comes and goes: within each period it rises over the ramp, is on, and falls over the ramp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Burst {
    /// From one beginning to the next, s; 0 for a vibration that goes on.
    pub period_s: f32,
    /// How long it is on, both ramps included, s.
    pub on_s: f32,
    /// How long it rises, and how long it falls, s.
    pub ramp_s: f32,
}
