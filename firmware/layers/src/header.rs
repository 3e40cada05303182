//! The header of a scene: the settings for all its layers.

use frixel_model::{
    Carrier, Contact, EmpiricalLaw, Expected, Finger, FrictionLaw, LawError, MeasuredFriction, ParameterError, Waveform,
};
use frixel_wire::bytes::{first_difference, get_at, put_at};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::{ConfigField, ConfigRefusal};
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX, SceneError};

use crate::finger_law::FingerLaw;
use crate::parameters::{range, within};
use crate::prepare::ticks;

/// Version of the layout of scenes.
pub const SCENE_VERSION: u16 = 1;
/// Bytes of the header.
pub const HEADER_LEN: usize = 56;

/// Smallest number of ticks in a half period of the carrier.
pub const HALF_PERIOD_MIN_TICKS: u32 = 4;
/// Lowest carrier frequency, Hz. Charge leaks through skin below about 250 Hz (arXiv 2409.18725); below half of that,
/// the drive effectively has no alternating carrier.
pub const CARRIER_MIN_HZ: f32 = 125.0;
/// Shortest and longest host timeout, ms.
pub const HOST_TIMEOUTS_MS: [u16; 2] = [20, 1_000];
/// [`HOST_TIMEOUTS_MS`] in s.
pub const HOST_TIMEOUTS_S: [f32; 2] = [HOST_TIMEOUTS_MS[0] as f32 / 1e3, HOST_TIMEOUTS_MS[1] as f32 / 1e3];

/// Offsets of the header's fields; those of `f32` are in [`Header::numbers`].
mod field {
    pub(super) const VERSION: usize = 0;
    pub(super) const RECORDS: usize = 2;
    pub(super) const FLAGS: usize = 3;
    pub(super) const NUMBERS: usize = 4;
    /// Number of the law's points, in place of the stiffness.
    pub(super) const LAW_POINTS: usize = 16;
    pub(super) const WAVEFORM: usize = 52;
    pub(super) const POINTS: usize = 53;
    pub(super) const ELECTRIC_FRICTION_MAX: usize = 54;
}

/// Bits of the flags.
mod flag {
    pub(super) const PREDICTION: u8 = 1 << 1;
    pub(super) const LEADER_LATEST: u8 = 1 << 2;
    pub(super) const LAYERS_FIXED: u8 = 1 << 3;
    pub(super) const ELECTRIC_FRICTION_MAX: u8 = 1 << 4;
    pub(super) const EMPIRICAL: u8 = 1 << 5;
    pub(super) const ALL: u8 = PREDICTION
        | LEADER_LATEST
        | LAYERS_FIXED
        | ELECTRIC_FRICTION_MAX
        | if cfg!(feature = "empirical") { EMPIRICAL } else { 0 };
}

/// The settings of the whole scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// Width of the screen, m.
    pub screen_width_m: f32,
    /// Height of the screen, m.
    pub screen_height_m: f32,
    /// Finger radius `R`, m. Radius, stiffness and gap are zero if there is a `law`.
    pub finger_radius_m: f32,
    /// Winkler-Fuss stiffness `k`, Pa/m.
    pub stiffness_pa_per_m: f32,
    /// Friction coefficient `mu`.
    pub friction_coefficient: f32,
    /// Normal load `F_N` for which the scene is designed, N.
    pub normal_load_n: f32,
    /// Effective gap `h0/eps` of the coating, m.
    pub effective_gap_m: f32,
    /// Largest rms voltage, V.
    pub voltage_max_v_rms: f32,
    /// Largest peak voltage, V.
    pub voltage_max_v_peak: f32,
    /// Fastest change of the envelope, V/s.
    pub slew_v_per_s: f32,
    /// Carrier frequency, Hz.
    pub carrier_hz: f32,
    /// Host timeout, s: the output goes to zero after this time without a frame from the host.
    pub host_timeout_s: f32,
    /// Shape of the carrier.
    pub waveform: Waveform,
    /// Whether the tick estimates the finger's current position from late samples. Otherwise it uses the last sample.
    pub prediction: bool,
    /// Which finger is followed when the host reports several.
    pub leader: Leader,
    /// Whether layer changes are refused while the scene plays.
    pub layers_fixed: bool,
    /// The scene's largest target friction (electric friction), N. The board's table ends there, and friction above it
    /// counts as saturated. `None`: the table ends at the friction for the largest voltage.
    ///
    /// A scene stores the upper half of the number's bits, rounded up: up to 1 % more.
    pub electric_friction_max_n: Option<f32>,
    /// The empirical law of the finger on the screen, under the normal load; `None` if radius, stiffness and gap
    /// describe the finger.
    pub law: Option<FingerLaw>,
}

/// Which of several fingers is followed, since one electrode renders one effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Leader {
    /// The finger on the screen that touched it first.
    #[default]
    First,
    /// The finger that touched the screen last.
    Latest,
}

impl Header {
    /// The bytes of the header of a scene with `records` records and `points` points. With a law, there is no room for
    /// radius, stiffness and gap; [`Self::check`] refuses a nonzero stiffness or gap.
    pub fn write(&self, records: u8, points: u8) -> [u8; HEADER_LEN] {
        let mut bytes = [0; HEADER_LEN];
        let flags = [
            (self.prediction, flag::PREDICTION),
            (self.leader == Leader::Latest, flag::LEADER_LATEST),
            (self.layers_fixed, flag::LAYERS_FIXED),
            (self.electric_friction_max_n.is_some(), flag::ELECTRIC_FRICTION_MAX),
            (self.law().is_some(), flag::EMPIRICAL),
        ];
        let flags = flags.into_iter().filter(|(is_set, _)| *is_set).fold(0, |flags, (_, flag)| flags | flag);
        let waveform = match self.waveform {
            Waveform::Square => 0,
            Waveform::Sine => 1,
        };
        put_at(&mut bytes, field::VERSION, SCENE_VERSION.to_le_bytes());
        put_at(&mut bytes, field::RECORDS, [records]);
        put_at(&mut bytes, field::FLAGS, [flags]);
        let mut header = *self;
        if let Some(law) = self.law() {
            // The fields of radius and stiffness hold the law's numbers.
            header.finger_radius_m = law.exponent();
            header.stiffness_pa_per_m = f32::from_bits(u32::from(law.point_count()));
            header.effective_gap_m = 0.0;
        }
        for (number, value) in header.numbers().into_iter().enumerate() {
            put_at(&mut bytes, field::NUMBERS + 4 * number, value.to_le_bytes());
        }
        put_at(&mut bytes, field::WAVEFORM, [waveform]);
        put_at(&mut bytes, field::POINTS, [points]);
        let max = self.electric_friction_max_n.map_or(0, upper_half_rounded_up);
        put_at(&mut bytes, field::ELECTRIC_FRICTION_MAX, max.to_le_bytes());
        bytes
    }

    /// Reads the header, and returns it with the number of records and of points that follow it.
    pub fn parse(bytes: &[u8; HEADER_LEN]) -> Result<(Self, u8, u8), SceneError> {
        let version = u16::from_le_bytes(get_at(bytes, field::VERSION));
        if version != SCENE_VERSION {
            return Err(SceneError::Version { found: version });
        }
        let [records] = get_at(bytes, field::RECORDS);
        if usize::from(records) > RECORDS_MAX {
            return Err(SceneError::TooManyRecords { found: records });
        }
        let [points] = get_at(bytes, field::POINTS);
        if usize::from(points) > POINTS_MAX {
            return Err(SceneError::TooManyPoints { found: points });
        }
        let [flags] = get_at(bytes, field::FLAGS);
        if flags & !flag::ALL != 0 {
            return Err(SceneError::UnknownFlags(flags));
        }
        let waveform = match get_at(bytes, field::WAVEFORM) {
            [0] => Waveform::Square,
            [1] => Waveform::Sine,
            [other] => return Err(SceneError::UnknownCarrier(other)),
        };
        let is_set = |flag| flags & flag != 0;
        let max = u16::from_le_bytes(get_at(bytes, field::ELECTRIC_FRICTION_MAX));
        let mut header = Self {
            waveform,
            prediction: is_set(flag::PREDICTION),
            leader: if is_set(flag::LEADER_LATEST) { Leader::Latest } else { Leader::First },
            layers_fixed: is_set(flag::LAYERS_FIXED),
            electric_friction_max_n: is_set(flag::ELECTRIC_FRICTION_MAX)
                .then(|| f32::from_bits(u32::from(max) << u16::BITS)),
            ..Self::ZERO
        };
        for (number, value) in header.numbers().into_iter().enumerate() {
            *value = f32::from_le_bytes(get_at(bytes, field::NUMBERS + 4 * number));
        }
        if cfg!(feature = "empirical") && is_set(flag::EMPIRICAL) {
            let [count, rest @ ..]: [u8; 4] = get_at(bytes, field::LAW_POINTS);
            if let Some(place) = rest.iter().position(|byte| *byte != 0) {
                let offset = (field::LAW_POINTS + 1 + place) as u8;
                return Err(SceneError::NotZero { record: SceneError::HEADER, offset });
            }
            let law = FingerLaw::without_points(header.finger_radius_m, count).ok_or(SceneError::Points {
                record: SceneError::HEADER,
                first: 0,
                count,
            })?;
            header.law = Some(law);
            (header.finger_radius_m, header.stiffness_pa_per_m) = (0.0, 0.0);
        }
        match first_difference(bytes, &header.write(records, points)) {
            None => Ok((header, records, points)),
            Some(offset) => Err(SceneError::NotZero { record: SceneError::HEADER, offset }),
        }
    }

    const ZERO: Self = Self {
        screen_width_m: 0.0,
        screen_height_m: 0.0,
        finger_radius_m: 0.0,
        stiffness_pa_per_m: 0.0,
        friction_coefficient: 0.0,
        normal_load_n: 0.0,
        effective_gap_m: 0.0,
        voltage_max_v_rms: 0.0,
        voltage_max_v_peak: 0.0,
        slew_v_per_s: 0.0,
        carrier_hz: 0.0,
        host_timeout_s: 0.0,
        waveform: Waveform::Square,
        prediction: false,
        leader: Leader::First,
        layers_fixed: false,
        electric_friction_max_n: None,
        law: None,
    };

    /// The law; always `None` in a build without laws, so that the compiler omits the code for them.
    #[inline]
    pub fn law(&self) -> Option<&FingerLaw> {
        self.law.as_ref().filter(|_| cfg!(feature = "empirical"))
    }

    /// The numbers of type `f32`, in the order of the layout.
    fn numbers(&mut self) -> [&mut f32; 12] {
        [
            &mut self.screen_width_m,
            &mut self.screen_height_m,
            &mut self.finger_radius_m,
            &mut self.stiffness_pa_per_m,
            &mut self.friction_coefficient,
            &mut self.normal_load_n,
            &mut self.effective_gap_m,
            &mut self.voltage_max_v_rms,
            &mut self.voltage_max_v_peak,
            &mut self.slew_v_per_s,
            &mut self.carrier_hz,
            &mut self.host_timeout_s,
        ]
    }

    /// The carrier on a board, with a half period of the nearest whole number of ticks.
    pub fn carrier(&self, limits: &BoardLimits, tick_hz: u32) -> Carrier {
        let half_period_ticks = ticks(0.5 / self.carrier_hz, tick_hz);
        Carrier::new(self.waveform, half_period_ticks, tick_hz, limits.edge_time_constant_s)
    }

    /// Steady friction of the scene's finger at a constant voltage, in `f64`, from the board's `f32` numbers. The knots
    /// of a law depend on the largest voltage: if the peak limit allows less than `voltage_max_v_rms`, a board's law is
    /// that of a header with the lower voltage.
    ///
    /// # Errors
    ///
    /// A parameter of the contact model is out of range, or the `law` is invalid. Neither happens for a scene accepted
    /// by a board.
    pub fn friction_law(&self) -> Result<FrictionLaw, ParameterError> {
        let (friction_coefficient, normal_load_n) =
            (f64::from(self.friction_coefficient), f64::from(self.normal_load_n));
        if let Some(law) = &self.law {
            let found = self.voltage_max_v_rms;
            let law = law.up_to(found).map_err(|_: LawError| ParameterError {
                parameter: "law",
                expected: Expected::Representable,
                found: f64::from(found),
            })?;
            return Ok(FrictionLaw::Empirical(MeasuredFriction { law, friction_coefficient, normal_load_n }));
        }
        let finger = Finger {
            radius_m: f64::from(self.finger_radius_m),
            stiffness_pa_per_m: f64::from(self.stiffness_pa_per_m),
            friction_coefficient,
        };
        Contact::new(&finger, f64::from(self.effective_gap_m))?.under_load(normal_load_n).map(FrictionLaw::from)
    }

    /// Checks that every number is within the ranges of a board with these limits and the tick rate `tick_hz`.
    pub fn check(&self, limits: &BoardLimits, tick_hz: u32) -> Result<(), ConfigRefusal> {
        let carrier_max_hz = tick_hz as f32 / (2.0 * HALF_PERIOD_MIN_TICKS as f32);
        let voltage_max_v_peak = limits.voltage_max_v_peak;
        // A law is not extrapolated.
        let voltage_max_v_rms =
            self.law().map_or(voltage_max_v_peak, |law| law.voltage_max_v_rms().min(voltage_max_v_peak));
        let (radius, stiffness, gap) = (self.finger_radius_m, self.stiffness_pa_per_m, self.effective_gap_m);
        let [radius, stiffness, gap] = match self.law() {
            None => [
                (ConfigField::FingerRadius, radius, 1e-4, 1.0),
                (ConfigField::Stiffness, stiffness, 1e3, 1e14),
                (ConfigField::EffectiveGap, gap, 1e-12, 1e-2),
            ],
            Some(law) => {
                let [least, most] = EmpiricalLaw::EXPONENTS;
                [
                    (ConfigField::LawExponent, law.exponent(), least, most),
                    (ConfigField::Stiffness, stiffness, 0.0, 0.0),
                    (ConfigField::EffectiveGap, gap, 0.0, 0.0),
                ]
            }
        };
        let [timeout_min_s, timeout_max_s] = HOST_TIMEOUTS_S;
        for (field, found, min, max) in [
            (ConfigField::ScreenWidth, self.screen_width_m, 1e-3, range::LENGTH_MAX_M as f32),
            (ConfigField::ScreenHeight, self.screen_height_m, 1e-3, range::LENGTH_MAX_M as f32),
            radius,
            stiffness,
            (ConfigField::FrictionCoefficient, self.friction_coefficient, 1e-3, 100.0),
            (ConfigField::NormalLoad, self.normal_load_n, 0.0, 50.0),
            gap,
            (ConfigField::VoltageRms, self.voltage_max_v_rms, 1.0, voltage_max_v_rms),
            (ConfigField::VoltagePeak, self.voltage_max_v_peak, 1.0, voltage_max_v_peak),
            (ConfigField::Slew, self.slew_v_per_s, 1.0, 1e9),
            (ConfigField::CarrierFrequency, self.carrier_hz, CARRIER_MIN_HZ, carrier_max_hz),
            (ConfigField::HostTimeout, self.host_timeout_s, timeout_min_s, timeout_max_s),
            (ConfigField::ElectricFrictionMax, self.electric_friction_max_n.unwrap_or(0.0), 0.0, f32::MAX),
        ] {
            within(field, found, min, max, ConfigRefusal::WHOLE_SCENE)?;
        }
        Ok(())
    }
}

/// The upper half of a number's bits, rounded away from zero.
pub(crate) fn upper_half_rounded_up(number: f32) -> u16 {
    let bits = number.to_bits();
    let upper = (bits >> u16::BITS) as u16;
    if bits & u32::from(u16::MAX) == 0 { upper } else { upper.saturating_add(1) }
}
