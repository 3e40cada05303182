//! The empirical law of a finger in a scene.

use frixel_model::{EmpiricalLaw, LawError, LawPoint};

use crate::point::{POINT_LEN, Point};

/// Largest number of points of a law in this build; 0 without laws.
pub const LAW_POINTS_MAX: usize = if cfg!(feature = "empirical") { EmpiricalLaw::POINTS_MAX } else { 0 };

/// The numbers of an [`EmpiricalLaw`]: the exponent below its first point, and its points, 1 to [`LAW_POINTS_MAX`]. The
/// commit checks whether they form a valid law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerLaw {
    exponent: f32,
    count: u8,
    points: [LawPoint; LAW_POINTS_MAX],
}

impl FingerLaw {
    /// The law of these numbers; `None` if there is no point, or there are too many.
    pub fn new(exponent: f32, points: &[LawPoint]) -> Option<Self> {
        let mut law = Self::without_points(exponent, u8::try_from(points.len()).ok()?)?;
        for (to, from) in law.points.iter_mut().zip(points) {
            *to = *from;
        }
        Some(law)
    }

    /// A law whose points are zero.
    pub(crate) fn without_points(exponent: f32, count: u8) -> Option<Self> {
        let points = [LawPoint { voltage_v_rms: 0.0, electric_friction_n: 0.0 }; LAW_POINTS_MAX];
        let has_room = points.get(usize::from(count).checked_sub(1)?).is_some();
        has_room.then_some(Self { exponent, count, points })
    }

    /// Sets the points from their bytes in a scene.
    pub(crate) fn read_points(&mut self, bytes: &[[u8; POINT_LEN]]) {
        for (to, Point { x, y }) in self.points.iter_mut().zip(bytes.iter().map(Point::parse)) {
            *to = LawPoint { voltage_v_rms: x, electric_friction_n: y };
        }
    }

    /// The bytes of the points, which follow those of the scene's own points.
    pub fn write_points(&self) -> impl Iterator<Item = u8> + use<> {
        let Self { points, count, .. } = *self;
        points
            .into_iter()
            .take(usize::from(count))
            .flat_map(|point| Point { x: point.voltage_v_rms, y: point.electric_friction_n }.write())
    }

    /// Exponent below the first point: friction grows as this power of the voltage.
    pub const fn exponent(&self) -> f32 {
        self.exponent
    }

    /// Number of points.
    pub const fn point_count(&self) -> u8 {
        self.count
    }

    /// The points, by ascending voltage.
    pub fn points(&self) -> &[LawPoint] {
        self.points.get(..usize::from(self.count)).unwrap_or_default()
    }

    /// Voltage of the last point, V rms, at which the law ends.
    pub fn voltage_max_v_rms(&self) -> f32 {
        self.points().last().map_or(0.0, |last| last.voltage_v_rms)
    }

    /// The law up to a largest voltage.
    ///
    /// # Errors
    ///
    /// The numbers do not form a valid law, or the voltage is above the last point's.
    pub fn up_to(&self, voltage_max_v_rms: f32) -> Result<EmpiricalLaw, LawError> {
        EmpiricalLaw::new(self.exponent, self.points(), voltage_max_v_rms)
    }
}
