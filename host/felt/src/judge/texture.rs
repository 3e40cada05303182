//! Textures perceived by a finger.

use super::moment::{MOMENT_HZ, Moment};
use super::{Texture, component_power, texture_component};
use crate::spectrum::Spectrum;

/// Number of moments in a spectrum: 256 ms, in which a hand's speed changes little.
const MOMENTS: usize = 512;
/// Integration time, s: a shorter burst counts by its power within this time. It is that of the spectrum's Hann window,
/// three eighths of it. The threshold of touch falls with the duration up to about a quarter of a second (Verrillo
/// 1965, doi:10.1121/1.1909458; quoted from memory), so short bursts are overestimated rather than underestimated.
pub(super) const SUMMED_S: f64 = 0.375 * MOMENTS as f64 / MOMENT_HZ;
/// Shortest touch with a texture, in moments: 64 ms.
const MOMENTS_MIN: usize = 128;

/// The most noticeable texture in each quarter of a second of a touch of a layer. `own_n` is the friction of the scene
/// without the layers above it.
pub(super) fn of_touch(touch: &[Moment], own_n: &[f64]) -> impl Iterator<Item = Texture> {
    let parts = touch.chunks(MOMENTS).zip(own_n.chunks(MOMENTS));
    parts.filter(|(moments, _)| moments.len() >= MOMENTS_MIN).filter_map(|(moments, own_n)| of_part(moments, own_n))
}

/// The texture of the scene, limited to its felt power. Power added by the display is not a texture of the layer.
fn of_part(moments: &[Moment], own_n: &[f64]) -> Option<Texture> {
    let speed = moments.iter().map(|moment| moment.context.speed_m_per_s).sum::<f64>() / moments.len() as f64;
    let (frequency_hz, amplitude_n) = texture_component(own_n, 1e3 * speed)?;
    let power = |value: fn(&Moment) -> f64| {
        let signal: Vec<f64> = moments.iter().map(value).collect();
        component_power(&Spectrum::of(&signal, MOMENT_HZ), frequency_hz)
    };
    let felt = power(|moment| moment.felt_n).min(power(|moment| moment.reference_n));
    let part = (felt / power(|moment| moment.scene_n)).sqrt();
    Texture::new(1e3 * speed, frequency_hz, part * amplitude_n)
}
