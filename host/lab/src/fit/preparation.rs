//! The preparation of a recording for the fit.

use frixel_scene::brief;

use super::{DefectiveStroke, Division, SensorZero};

/// Omissions and corrections in a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preparation {
    /// Odd strokes that were left out.
    pub left_out: Vec<DefectiveStroke>,
    /// Zero of the force sensor, from rows without contact.
    pub sensor_zero: Option<SensorZero>,
    /// Number of rows that were left out because they have no time although others do.
    pub rows_without_time: usize,
    /// Whether the finger is simulated: the profile is assumed.
    pub is_simulated: bool,
}

impl Preparation {
    /// A note for each of them; none for means.
    pub fn notes(&self, division: Division) -> Vec<String> {
        if division == Division::Means {
            return Vec::new();
        }
        let note =
            |defective: &DefectiveStroke| format!("stroke {} left out: {}", brief(&defective.stroke), defective.defect);
        let mut notes: Vec<String> = self.left_out.iter().map(note).collect();
        notes.extend(self.is_simulated.then(|| "the finger is simulated: nothing was measured".to_owned()));
        notes.extend(match self.rows_without_time {
            0 => None,
            1 => Some("1 row without a time left out".to_owned()),
            count => Some(format!("{count} rows without a time left out")),
        });
        notes.push(match self.sensor_zero {
            Some(SensorZero { normal_force_n, friction_n, duration_s }) => format!(
                "the sensor's zero was taken from {duration_s:.1} s without contact: {normal_force_n:.3} N of load, \
                 {friction_n:.3} N of friction"
            ),
            None => {
                "the recording has no second without contact, which would show the sensor's zero: a sensor that was \
                 not tared shifts the friction coefficient (docs/design/outputs.md, \"Taring\")"
                    .to_owned()
            }
        });
        notes
    }
}
