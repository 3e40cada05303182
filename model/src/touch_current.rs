//! The current through a person who touches the electrode, directly, through its coating or through a scratch, and the
//! largest voltage for which this current stays within the limits of standards.
//!
//! The circuit consists of a series resistor, the coating (a capacitance, with a leak at a scratch), a person, and the
//! return path to the amplifier's common. The person is the network of IEC 60990, Fig. 4: 1.5 kOhm in parallel with
//! 0.22 uF for the skin, 500 Ohm for the body, and a low-pass of 10 kOhm and 22 nF across the body. Its output over 500
//! Ohm is the current **weighted** for perception and reaction. The amplifier's own lag, which reduces currents, is
//! neglected.
//!
//! | number | source | original read |
//! |---|---|---|
//! | network and weighting | IEC 60990:2016, Fig. 4 | no; values as in public copies of IEC 60065, Annex D |
//! | 0.7 mA peak, weighted, in normal use | IEC 61010-1:2010, 6.3.1 b); the same in IEC 62368-1, Table 4, ES1 | no |
//! | 5 mA peak, weighted, in a single-fault condition | IEC 61010-1:2010, 6.3.2 b) | no |
//!
//! A coating too thin to insulate is worse than none: its charge from one half period drives current in the next.
//! [`TouchBound`] therefore holds for every coating, and does not count a coating as protection.

/// Largest weighted touch current in normal use, A peak (IEC 61010-1, 6.3.1; original not read).
pub const TOUCH_CURRENT_MAX_A_PEAK: f64 = 0.7e-3;
/// Largest weighted touch current in a single-fault condition, A peak (IEC 61010-1, 6.3.2; original not read).
pub const SINGLE_FAULT_CURRENT_MAX_A_PEAK: f64 = 5e-3;

/// Parts of the network of IEC 60990, Fig. 4 (original not read).
const SKIN_OHM: f64 = 1.5e3;
const SKIN_F: f64 = 0.22e-6;
const BODY_OHM: f64 = 500.0;
const WEIGHTING_OHM: f64 = 10e3;
const WEIGHTING_F: f64 = 22e-9;

/// State of the coating between electrode and finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coating {
    /// Bridged by moisture, or missing.
    Bridged,
    /// Without a defect.
    Intact {
        /// Capacitance to the finger, F.
        capacitance_f: f64,
    },
    /// With a scratch.
    Scratched {
        /// Capacitance to the finger, F.
        capacitance_f: f64,
        /// Resistance of the scratch, Ohm.
        leak_ohm: f64,
    },
}

/// Path of a touch current from the amplifier to its common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchPath {
    /// Series resistor before the electrode plus the resistance of the return path, Ohm.
    pub series_ohm: f64,
    /// The coating.
    pub coating: Coating,
}

/// A touch current at a steady square carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchCurrent {
    /// Peak of the weighted current, A.
    pub weighted_a_peak: f64,
    /// Peak of the current itself, A.
    pub a_peak: f64,
    /// Root mean square of the current itself, A.
    pub a_rms: f64,
}

/// Voltages of the capacitances of coating, skin and weighting, V.
type State = [f64; 3];

/// The weighted current, A.
fn weighted_a([.., weighting_v]: &State) -> f64 {
    weighting_v / BODY_OHM
}

impl TouchPath {
    /// Number of half periods after which a wave is taken as steady.
    const HALF_PERIODS: u32 = 200;
    /// Smallest number of steps in a half period.
    const STEPS: u32 = 200;
    /// Number of steps in the shortest time constant.
    const STEPS_PER_LAG: f64 = 4.0;

    /// The current at a steady square carrier of `drive_v_peak` volts and `carrier_hz` hertz.
    pub fn steady(&self, drive_v_peak: f64, carrier_hz: f64) -> TouchCurrent {
        let half_period_s = 0.5 / carrier_hz;
        let steps = self.steps(half_period_s).max(Self::STEPS);
        let step_s = half_period_s / f64::from(steps);
        let mut state = [0.0; 3];
        let mut drive_v = drive_v_peak;
        let mut found = TouchCurrent { weighted_a_peak: 0.0, a_peak: 0.0, a_rms: 0.0 };
        for _ in 0..Self::HALF_PERIODS {
            let mut square_sum = 0.0;
            found = TouchCurrent { weighted_a_peak: 0.0, a_peak: self.current_a(&state, drive_v).abs(), a_rms: 0.0 };
            for _ in 0..steps {
                let before_a = self.current_a(&state, drive_v);
                state = self.stepped(&state, drive_v, step_s);
                let after_a = self.current_a(&state, drive_v);
                found.weighted_a_peak = found.weighted_a_peak.max(weighted_a(&state).abs());
                square_sum += 0.5 * (before_a * before_a + after_a * after_a);
            }
            found.a_rms = libm::sqrt(square_sum / f64::from(steps));
            drive_v = -drive_v;
        }
        found
    }

    /// Peak of the weighted current in A for the worst envelope of a carrier of `drive_v_peak` volts and `carrier_hz`
    /// hertz. An envelope is any voltage up to the peak whose running integral stays within one half period at the peak
    /// on either side of zero, which is all that the firmware's carrier guarantees.
    ///
    /// The weighted current is a sum of past voltages weighted by the impulse response. The largest such sum is found
    /// over all paths of the integral, on a grid of a fortieth of a half period.
    pub fn any_envelope_a_peak(&self, drive_v_peak: f64, carrier_hz: f64) -> f64 {
        /// Positions of the integral, forty per half period.
        const PLACES: usize = 81;
        let half_period_s = 0.5 / carrier_hz;
        let cell_s = half_period_s / 40.0;
        let steps = self.steps(cell_s).max(1);
        let memory_s = 6e-3 + 5.0 * self.coating_lag_s() + 4.0 * half_period_s;
        let mut sums = [0.0_f64; PLACES];
        let mut state = [0.0; 3];
        let mut before_a = 0.0;
        for _ in 0..(memory_s / cell_s) as u32 {
            for _ in 0..steps {
                state = self.stepped(&state, 1.0, cell_s / f64::from(steps));
            }
            let response_a = weighted_a(&state) - before_a;
            before_a += response_a;
            let old = sums;
            for (place, sum) in sums.iter_mut().enumerate() {
                let from = |place: Option<usize>| place.and_then(|place| old.get(place)).copied();
                let down = from(place.checked_sub(1)).map_or(f64::NEG_INFINITY, |sum| sum + response_a);
                let up = from(place.checked_add(1)).map_or(f64::NEG_INFINITY, |sum| sum - response_a);
                *sum = sum.max(down).max(up);
            }
        }
        drive_v_peak * sums.into_iter().fold(0.0, f64::max)
    }

    /// The coating with the largest [`Self::any_envelope_a_peak`], over all capacitances and no coating.
    pub fn worst_coating(series_ohm: f64, carrier_hz: f64) -> Self {
        let bridged = Self { series_ohm, coating: Coating::Bridged };
        let worst_a = |path: &Self| path.any_envelope_a_peak(1.0, carrier_hz);
        // Time constants from a tenth of the weighting's to ten half periods; beyond, a coating acts as a bridge.
        (0..30)
            .map(|step| 22e-6 * libm::pow(10.0, f64::from(step) / 10.0))
            .take_while(|lag_s| *lag_s < 5.0 / carrier_hz)
            .map(|lag_s| Self { series_ohm, coating: Coating::Intact { capacitance_f: lag_s / series_ohm } })
            .fold((bridged, worst_a(&bridged)), |(worst, most_a), path| {
                let found_a = worst_a(&path);
                if found_a > most_a { (path, found_a) } else { (worst, most_a) }
            })
            .0
    }

    fn steps(&self, time_s: f64) -> u32 {
        let shortest_s = 200e-6_f64.min(self.coating_lag_s());
        let shortest_s = if shortest_s > 0.0 { shortest_s } else { 200e-6 };
        libm::ceil(Self::STEPS_PER_LAG * time_s / shortest_s) as u32
    }

    /// Charging time constant of the coating, s.
    fn coating_lag_s(&self) -> f64 {
        match self.coating {
            Coating::Bridged => 0.0,
            Coating::Intact { capacitance_f } => self.series_ohm * capacitance_f,
            Coating::Scratched { capacitance_f, leak_ohm } => {
                capacitance_f * self.series_ohm * leak_ohm / (self.series_ohm + leak_ohm)
            }
        }
    }

    /// The current through the series resistor, A.
    fn current_a(&self, [coating_v, skin_v, weighting_v]: &State, drive_v: f64) -> f64 {
        let share = BODY_OHM / (BODY_OHM + WEIGHTING_OHM);
        (drive_v - coating_v - skin_v - share * weighting_v) / (self.series_ohm + share * WEIGHTING_OHM)
    }

    fn slope(&self, state: &State, drive_v: f64) -> State {
        let [coating_v, skin_v, weighting_v] = *state;
        let current_a = self.current_a(state, drive_v);
        let coating_slope = match self.coating {
            Coating::Bridged => 0.0,
            Coating::Intact { capacitance_f } => current_a / capacitance_f,
            Coating::Scratched { capacitance_f, leak_ohm } => (current_a - coating_v / leak_ohm) / capacitance_f,
        };
        let body_v = (BODY_OHM * WEIGHTING_OHM * current_a + BODY_OHM * weighting_v) / (BODY_OHM + WEIGHTING_OHM);
        [
            coating_slope,
            (current_a - skin_v / SKIN_OHM) / SKIN_F,
            (body_v - weighting_v) / (WEIGHTING_OHM * WEIGHTING_F),
        ]
    }

    /// The state one step later, by the fourth-order Runge-Kutta method.
    fn stepped(&self, state: &State, drive_v: f64, step_s: f64) -> State {
        let moved = |slope: &State, time_s: f64| {
            let [a, b, c] = *state;
            let [da, db, dc] = *slope;
            [a + time_s * da, b + time_s * db, c + time_s * dc]
        };
        let first = self.slope(state, drive_v);
        let second = self.slope(&moved(&first, 0.5 * step_s), drive_v);
        let third = self.slope(&moved(&second, 0.5 * step_s), drive_v);
        let fourth = self.slope(&moved(&third, step_s), drive_v);
        let mean = |[a, b, c, d]: [f64; 4]| (a + 2.0 * (b + c) + d) / 6.0;
        let ([a1, b1, c1], [a2, b2, c2], [a3, b3, c3], [a4, b4, c4]) = (first, second, third, fourth);
        moved(&[mean([a1, a2, a3, a4]), mean([b1, b2, b3, b4]), mean([c1, c2, c3, c4])], step_s)
    }
}

/// The largest voltage behind a series resistor at which the touch current is within [`TOUCH_CURRENT_MAX_A_PEAK`], for
/// every coating (including a bridged one), every person and every envelope.
///
/// It is the series resistance times a current that rises with the carrier frequency, in two straight pieces below 0.7
/// mA over the worst case of [`TouchPath::any_envelope_a_peak`], with [`Self::MARGIN`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchBound {
    series_ohm: f32,
}

impl TouchBound {
    /// Smallest ratio of the allowed current to the current at the bound: 4 % for an amplifier gain above the one
    /// stored by bring-up, and 1.5 % for a low series resistance (`docs/board/hardware.md`, "Bring-up").
    pub const MARGIN: f32 = 1.06;
    /// Current at 1 kHz, A.
    const CURRENT_A: f32 = 0.645e-3;
    /// Rise of the current below and above 1 kHz, A/Hz.
    const RISES_A_PER_HZ: [f32; 2] = [0.255e-6, 0.08e-6];

    /// The bound for a series resistance in Ohm. Infinite for a board that cannot be touched.
    pub const fn behind(series_ohm: f32) -> Self {
        Self { series_ohm }
    }

    /// The largest peak voltage in V at a carrier of `carrier_hz` hertz, 125 to 5,000.
    ///
    /// ```
    /// use frixel_model::TouchBound;
    ///
    /// let bound = TouchBound::behind(68e3);
    /// assert!((bound.voltage_max_v_peak(125.0) - 28.7).abs() < 0.1);
    /// assert!((bound.voltage_max_v_peak(1_000.0) - 43.9).abs() < 0.1);
    /// ```
    pub fn voltage_max_v_peak(&self, carrier_hz: f32) -> f32 {
        let [below, above] = Self::RISES_A_PER_HZ;
        let rise = if carrier_hz < 1_000.0 { below } else { above };
        self.series_ohm * (Self::CURRENT_A + rise * (carrier_hz - 1_000.0))
    }

    /// The bound as it is stated and as scenes are compiled for it, in V: rounded down to a tenth, so that a board's own
    /// arithmetic finds no excess.
    pub fn stated_v_peak(&self, carrier_hz: f32) -> f64 {
        libm::floor(10.0 * f64::from(self.voltage_max_v_peak(carrier_hz))) / 10.0
    }
}

#[cfg(test)]
mod tests;
