//! The textbook method: a table of friction at equidistant voltages, a binary search, and linear interpolation between
//! two entries.

use super::{Bench, Kind, Method, RANGE_V_RMS};

const ENTRIES: [usize; 4] = [64, 256, 1024, 4096];

/// Friction at equidistant voltages from zero.
struct ForwardTable {
    frictions_n: Vec<f32>,
    step_v_rms: f32,
}

impl ForwardTable {
    fn voltage_v_rms(&self, electric_friction_n: f32) -> f32 {
        let above = self.frictions_n.partition_point(|friction_n| *friction_n <= electric_friction_n);
        let below = above.saturating_sub(1).min(self.frictions_n.len() - 2);
        let (low, high) = (self.frictions_n[below], self.frictions_n[below + 1]);
        (below as f32 + (electric_friction_n - low) / (high - low)) * self.step_v_rms
    }
}

pub(super) fn measure(bench: &Bench, methods: &mut Vec<Method>) {
    for entries in ENTRIES {
        let step = RANGE_V_RMS.1 / (entries - 1) as f64;
        let friction_n = |entry: usize| bench.contact.electric_friction_n(step * entry as f64) as f32;
        let table = ForwardTable { frictions_n: (0..entries).map(friction_n).collect(), step_v_rms: step as f32 };
        let bytes = 4 * entries;
        methods.push(
            bench.in_f32(Kind::ForwardTable, format!("{entries} entries"), Some(bytes), |x| table.voltage_v_rms(x)),
        );
    }
}
