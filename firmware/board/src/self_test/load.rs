//! The tick under the largest scene accepted by the board.

use frixel_control::Board;
use frixel_layers::{Beat, Blend, Burst, Constant, Grating, Layer, Noise, Record, Region, Vibration, Wave, cost};
use frixel_wire::message::TickTimes;
use heapless::Vec;

use super::script::refuse_inputs;
use super::{LoopedBoard, Round, Stop};
use crate::local_host::{LocalHost, Progress};
use crate::local_scene::{header, scene, scene_len};

/// Peak voltage of the scene, V. The wires simulate the monitor of an amplifier at 0 V, up to 4 V off. The supervisor
/// accepts deviations of 8 V and 25 % of the driven voltage, and checks no gain below 4 V rms.
const PEAK_V: f32 = 3.0;
/// Largest electric friction of a layer, N, of the size reached at [`PEAK_V`], so that the tick looks up voltages.
const HIGH_N: f32 = 9e-6;
/// Longest uninterrupted play of the scene, s.
const PIECE_S: f32 = 60.0;
/// Time for which the switch is released between two plays, s.
const RELEASED_S: f32 = 0.1;
/// More layers than fit into a tick.
const LAYERS_MAX: usize = 16;

/// Plays the largest scene repeatedly.
pub(super) struct Load {
    scene: Vec<u8, { scene_len(LAYERS_MAX) }>,
    core_cycles: u32,
    stage: Stage,
    since_tick: u32,
    now_tick: u32,
}

enum Stage {
    Released,
    Held,
    Playing(LocalHost),
}

impl Load {
    /// The largest scene accepted by `board`: its kinds of layers alternate, so that no code reliably stays in a cache.
    // Not inlined, so that its records are on the stack only meanwhile.
    #[inline(never)]
    pub(super) fn largest(board: &Board) -> Self {
        let header = header(PEAK_V);
        let mut records = Vec::<Record, LAYERS_MAX>::new();
        let core = board.limits.core;
        let mut core_cycles = cost::of_empty_scene(&header).on(core);
        // Layers that no longer fit are skipped, so that smaller ones fill the rest.
        for layer in layers().iter().cycle().take(4 * LAYERS_MAX) {
            let record = Record { region: Region::Screen, blend: Blend::Add, gain: 1.0, layer: *layer };
            let with_it = core_cycles + cost::of_record(&record, &[]).on(core);
            if cost::cycles(core, with_it) <= board.limits.tick_cycles_max && records.push(record).is_ok() {
                core_cycles = with_it;
            }
        }
        Self { scene: scene(&header, &records), core_cycles, stage: Stage::Released, since_tick: 0, now_tick: 0 }
    }

    /// Estimated cycles of its longest tick, without flash wait states.
    pub(super) fn core_cycles(&self) -> u32 {
        self.core_cycles
    }

    /// The tick of the last round.
    pub(super) fn now_tick(&self) -> u32 {
        self.now_tick
    }

    /// Plays the scene to its end, and releases the switch, so that [`Self::round`] need not be called any more.
    pub(super) fn rest(&mut self, board: &mut impl LoopedBoard) -> Result<(), Stop> {
        while !matches!(self.stage, Stage::Released) {
            match &mut self.stage {
                Stage::Playing(host) => host.stop(),
                stage => *stage = Stage::Released,
            }
            self.round(board)?;
        }
        Ok(())
    }

    /// One round of the main loop; returns whether the scene plays. The enable is low, but a high input indicates that
    /// something was connected meanwhile.
    pub(super) fn round(&mut self, board: &mut impl LoopedBoard) -> Result<bool, Stop> {
        refuse_inputs(board)?;
        let released_ticks = board.board().ticks(RELEASED_S);
        let description = *board.board();
        let Round { status, now_tick, session } = board.round(!matches!(self.stage, Stage::Released));
        self.now_tick = now_tick;
        match &mut self.stage {
            Stage::Released if now_tick.wrapping_sub(self.since_tick) >= released_ticks => self.stage = Stage::Held,
            Stage::Held if status.arm_switch => {
                self.stage = Stage::Playing(LocalHost::new(PIECE_S, &description));
            }
            Stage::Released | Stage::Held => {}
            Stage::Playing(host) => match host.step(&self.scene, status, now_tick, session).map_err(Stop::Drive)? {
                Progress::Playing(_) => return Ok(true),
                Progress::Waiting => {}
                Progress::Done => {
                    self.stage = Stage::Released;
                    self.since_tick = now_tick;
                }
            },
        }
        Ok(false)
    }
}

/// One layer of each of several kinds, the most expensive first.
fn layers() -> [Layer; 6] {
    let grating = |wave| {
        Layer::Grating(Grating {
            wave,
            cycles_per_m_x: 500.0,
            cycles_per_m_y: 170.0,
            phase_turns: 0.1,
            trough_n: 0.0,
            crest_n: HIGH_N,
            drift_hz: 0.0,
        })
    };
    [
        Layer::Noise(Noise { seed: 1, wavelength_min_m: 1e-3, wavelength_max_m: 4e-3, low_n: 0.0, high_n: HIGH_N }),
        Layer::Vibration(Vibration {
            beat: Beat::Sine,
            frequency_hz: 90.0,
            low_n: 0.0,
            high_n: HIGH_N,
            burst: Burst { period_s: 0.3, on_s: 0.2, ramp_s: 0.05 },
        }),
        grating(Wave::Square { duty: 0.3 }),
        grating(Wave::Sine),
        grating(Wave::Triangle),
        Layer::Constant(Constant { electric_friction_n: HIGH_N }),
    ]
}

/// The counts between two readings of a meter. The longest tick is that of all ticks so far.
pub(super) fn counted_since(before: &TickTimes, now: &TickTimes) -> TickTimes {
    let mut histogram = now.histogram;
    for (count, before) in histogram.iter_mut().zip(before.histogram) {
        *count = count.wrapping_sub(before);
    }
    TickTimes { histogram, missed_deadlines: now.missed_deadlines.wrapping_sub(before.missed_deadlines), ..*now }
}
