//! A play, moment by moment, while the board drives the scene.

use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference, direction_of};

use super::visible_layers;
use crate::fidelity::{self, FidelitySample, settled};

/// Moments per second: four times the highest frequency with a threshold.
pub(super) const MOMENT_HZ: f64 = 2000.0;
/// Samples per moment.
const SAMPLES: usize = (fidelity::SAMPLE_HZ / MOMENT_HZ) as usize;

/// A moment of a play: means over half a millisecond. Frictions are electric parts, N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub(super) context: Context,
    /// Bit set of the layers that have an effect at this place.
    pub(super) visible: u64,
    /// Friction of the scene for its own finger.
    pub(super) scene_n: f64,
    /// Friction with an ideal display.
    pub(super) reference_n: f64,
    pub(super) felt_n: f64,
    /// Natural friction of the finger.
    pub(super) natural_n: f64,
}

impl Moment {
    /// Creates a moment from its samples. Returns `None` without samples, or while the finger is off the screen.
    fn of(samples: &[FidelitySample], scene: &Reference, program: &Program) -> Option<Self> {
        let context = context(samples)?;
        let mean =
            |value: &dyn Fn(&FidelitySample) -> f64| samples.iter().map(value).sum::<f64>() / samples.len() as f64;
        Some(Self {
            context,
            visible: visible_layers(scene, context.x_m, context.y_m),
            scene_n: electric_n(scene, program, &context),
            reference_n: mean(&FidelitySample::reference_electric_n),
            felt_n: mean(&FidelitySample::felt_electric_n),
            natural_n: mean(&|sample| sample.natural_n),
        })
    }

    /// Whether the finger is on a layer.
    pub(super) fn is_on(&self, layer: usize) -> bool {
        self.visible >> layer & 1 == 1
    }

    /// Electric friction here and now, within reach, N.
    pub(super) fn electric_n(&self, reference: &Reference, program: &Program) -> f64 {
        electric_n(reference, program, &self.context)
    }
}

/// Distance slid at each moment since before the first one, m.
pub(super) fn ways_m<'m>(moments: impl Iterator<Item = &'m Moment>) -> impl Iterator<Item = f64> {
    moments.scan(0.0, |way_m, moment| {
        *way_m += moment.context.speed_m_per_s / MOMENT_HZ;
        Some(*way_m)
    })
}

/// The finger at the last sample, with its motion since the first one. Returns `None` without samples, or while the
/// finger is off the screen.
pub(super) fn context(samples: &[FidelitySample]) -> Option<Context> {
    let (first, last) = (samples.first()?, samples.last()?);
    let FidelitySample { t_s, x_m, y_m, speed_m_per_s, .. } = *last;
    let direction = direction_of([x_m - first.x_m, y_m - first.y_m]);
    Some(Context { x_m, y_m, t_s, speed_m_per_s: speed_m_per_s?, direction, ..Context::default() })
}

/// Electric friction in a context, within reach, N.
pub(super) fn electric_n(reference: &Reference, program: &Program, context: &Context) -> f64 {
    reference.electric_friction_at_n(context).clamp(0.0, program.reach.electric_friction_max_n)
}

/// The same moments with an ideal display.
pub(super) fn faultless(runs: &[Vec<Moment>]) -> Vec<Vec<Moment>> {
    let faultless = |moment: &Moment| Moment { felt_n: moment.reference_n, ..*moment };
    runs.iter().map(|run| run.iter().map(faultless).collect()).collect()
}

/// The parts of a play in which the board drives the scene.
pub(super) fn runs(samples: &[FidelitySample], scene: &Reference, program: &Program) -> Vec<Vec<Moment>> {
    let moments = |run: &[FidelitySample]| {
        run.chunks_exact(SAMPLES).filter_map(|samples| Moment::of(samples, scene, program)).collect()
    };
    settled(samples).map(moments).collect()
}
