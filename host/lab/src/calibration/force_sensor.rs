//! A force sensor under the simulated screen.

use frixel_hil_sim::Felt;

use super::ForceRow;

/// A load cell that averages over a number of ticks.
#[derive(Clone, Debug)]
pub struct ForceSensor {
    ticks_per_row: u32,
    tick_hz: f64,
    ticks: u32,
    normal_force_n: f64,
    friction_n: f64,
    rows: Vec<ForceRow>,
}

impl ForceSensor {
    /// A sensor with `hz` rows a second, beside a board with `tick_hz` ticks a second.
    pub fn new(hz: u32, tick_hz: u32) -> Self {
        Self {
            ticks_per_row: (tick_hz / hz.max(1)).max(1),
            tick_hz: f64::from(tick_hz),
            ticks: 0,
            normal_force_n: 0.0,
            friction_n: 0.0,
            rows: Vec::new(),
        }
    }

    /// The measured rows, on the clock of the simulation.
    pub fn rows(&self) -> &[ForceRow] {
        &self.rows
    }

    /// Removes the measured rows, and returns them.
    pub fn take_rows(&mut self) -> Vec<ForceRow> {
        std::mem::take(&mut self.rows)
    }

    /// Measures during a tick.
    pub fn measure(&mut self, tick: u64, felt: &Felt) {
        self.normal_force_n += felt.normal_load_n;
        self.friction_n += felt.friction_n;
        self.ticks += 1;
        if self.ticks == self.ticks_per_row {
            let count = f64::from(self.ticks);
            self.rows.push(ForceRow {
                time_s: tick as f64 / self.tick_hz,
                normal_force_n: self.normal_force_n / count,
                friction_n: self.friction_n / count,
            });
            (self.ticks, self.normal_force_n, self.friction_n) = (0, 0.0, 0.0);
        }
    }
}
