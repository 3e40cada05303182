//! One direction of the line, with the effects of a scenario's faults on its bytes.

use std::collections::VecDeque;

use frixel_hil_sim::{LineNoise, NoiseConfig};
use frixel_scene::LineDamage;

use super::ticks_of;

/// One direction of the line.
pub(super) struct Direction {
    noise: LineNoise,
    is_cut: bool,
    late_ticks: u64,
    held: VecDeque<(u64, Vec<u8>)>,
}

impl Direction {
    pub(super) fn new(seed: u64) -> Self {
        Self { noise: LineNoise::new(seed), is_cut: false, late_ticks: 0, held: VecDeque::new() }
    }

    /// Takes bytes that are sent at a tick.
    pub(super) fn take(&mut self, bytes: &[u8], tick: u64) {
        if bytes.is_empty() || self.is_cut {
            return;
        }
        let mut arrived = Vec::new();
        self.noise.pass(bytes, &mut arrived);
        // Bytes do not overtake each other.
        let due = (tick + self.late_ticks).max(self.held.back().map_or(0, |(due, _)| *due));
        self.held.push_back((due, arrived));
    }

    /// The bytes that arrive up to a tick.
    pub(super) fn due(&mut self, tick: u64) -> Option<Vec<u8>> {
        self.held.pop_front_if(|(due, _)| *due <= tick).map(|(_, bytes)| bytes)
    }

    pub(super) fn set(&mut self, damages: &[LineDamage], tick_hz: u32) {
        let mut noise = NoiseConfig::default();
        (self.is_cut, self.late_ticks) = (false, 0);
        for damage in damages {
            match damage {
                LineDamage::Cut => self.is_cut = true,
                LineDamage::Late { ms } => self.late_ticks += ticks_of(*ms, tick_hz),
                LineDamage::Noise(more) => {
                    noise.bit_error_rate = noise.bit_error_rate.max(more.bit_error_rate);
                    noise.lost_share = noise.lost_share.max(more.lost_share);
                    noise.doubled_share = noise.doubled_share.max(more.doubled_share);
                }
            }
        }
        // The file's reader has checked the shares.
        let _ = self.noise.set(noise);
    }

    /// When the next bytes arrive.
    pub(super) fn next_due(&self) -> Option<u64> {
        self.held.front().map(|(due, _)| *due)
    }
}
