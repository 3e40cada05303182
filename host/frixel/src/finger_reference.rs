//! The friction that a display without errors would give a simulated finger.

use frixel_hil_sim::{ReferenceFriction, TickRecord};
use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference, StrokeReference};

/// The friction of a scene at the finger's true place, through the same finger, with its load and noise.
///
/// The difference to the friction that the finger felt is the display's error: of the touch source, of the drive, and
/// of the charge that leaked.
pub(crate) struct FingerReference {
    scene: StrokeReference,
    finger: ReferenceFriction,
    tick_hz: f64,
}

impl FingerReference {
    pub(crate) fn new(program: &Program, tick_hz: u32) -> Self {
        Self {
            scene: Reference::new(program).along_stroke(),
            finger: ReferenceFriction::default(),
            tick_hz: f64::from(tick_hz),
        }
    }

    /// Follows a tick. Returns the total friction of the reference in N, 0 without a finger.
    pub(crate) fn follow(&mut self, TickRecord { tick, felt, .. }: &TickRecord) -> f64 {
        let electric_n = if let Some(finger) = felt.finger {
            self.scene.electric_friction_n(&Context {
                t_s: *tick as f64 / self.tick_hz,
                x_m: finger.x_m,
                y_m: finger.y_m,
                speed_m_per_s: finger.speed_m_per_s,
                ..Context::default()
            })
        } else {
            self.scene.lift();
            0.0
        };
        self.finger.follow(felt, electric_n)
    }
}
