//! From a record to a layer.

use frixel_wire::message::Refusal;
#[cfg(any(feature = "noise", feature = "edge"))]
use frixel_wire::message::{ConfigField, ConfigRefusal};
#[cfg(feature = "edge")]
use frixel_wire::scene::Click as ClickRecord;
use frixel_wire::scene::{Layer as Kind, Record};

use super::region::Region;
use super::{Layer, Source, Tables};
use crate::Board;
use crate::bitmap_pool::Directory;

/// A scene's layers are being loaded.
#[allow(dead_code, reason = "kinds that are left out do not look at all of it")]
pub(crate) struct LayerLoading<'a> {
    pub(crate) board: &'a Board,
    pub(crate) directory: &'a Directory,
    pub(crate) tables: &'a mut Tables,
}

impl LayerLoading<'_> {
    /// The layer of record `number`, whose numbers were checked.
    #[inline]
    pub(crate) fn layer(&mut self, record: &Record, number: u8) -> Result<Layer, Refusal> {
        let left_out = Refusal::LeftOut { layer: number };
        let region = Region::new(record.region, self.tables.points()).ok_or(left_out)?;
        let source = self.source(record, number)?;
        Ok(Layer { region, join: super::Join::new(record), gain: record.gain, source })
    }

    #[allow(unused_variables, clippy::unused_self, reason = "kinds that are left out do not look at them")]
    #[inline]
    fn source(&mut self, record: &Record, number: u8) -> Result<Source, Refusal> {
        match record.layer {
            Kind::Constant { electric_friction_n } => Ok(Source::Constant { electric_friction_n }),
            #[cfg(feature = "grating")]
            Kind::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n } => {
                let cycles_per_m = [cycles_per_m_x, cycles_per_m_y];
                Ok(Source::Grating(super::Grating::new(wave, cycles_per_m, phase_turns, [trough_n, crest_n])))
            }
            #[cfg(feature = "bitmap")]
            Kind::Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n, pitch_y_m, angle_turns, tiled } => {
                let bitmap = self.directory.find(crc32).ok_or(Refusal::BitmapMissing { crc32 })?;
                let place = super::picture::Placement { x_m, y_m, pitch_m, pitch_y_m, angle_turns, tiled };
                Ok(Source::Picture(super::Picture::new(bitmap, &place, [black_n, white_n])))
            }
            #[cfg(feature = "noise")]
            Kind::Noise { seed, wavelength_min_m, wavelength_max_m, low_n, high_n } => {
                let waves = super::noise::Waves::new(seed, wavelength_min_m, wavelength_max_m);
                let refusal = too_many(ConfigField::NoiseLayers, super::noise::NOISES_MAX, number);
                let waves = self.tables.add_noise(waves).map_err(|_| refusal)?;
                Ok(Source::Noise(super::Noise::new(waves, [low_n, high_n])))
            }
            #[cfg(feature = "edge")]
            Kind::Edge { x_m, y_m, angle_turns, width_m, level_n, ridge_n, click } => {
                let click = self.click(click, number)?;
                Ok(Source::Edge(super::Edge::new([x_m, y_m], angle_turns, width_m, [level_n, ridge_n], click)))
            }
            #[cfg(feature = "edge")]
            Kind::Button { rim_width_m, rim_n, face_n, click } => {
                let click = self.click(click, number)?;
                Ok(Source::Button(super::Button::new(rim_width_m, [rim_n, face_n], click)))
            }
            #[cfg(feature = "vibration")]
            Kind::Vibration { beat, frequency_hz, low_n, high_n, burst } => {
                let vibration = super::Vibration::new(beat, frequency_hz, [low_n, high_n], burst, self.board);
                Ok(Source::Vibration(vibration))
            }
            #[cfg(feature = "speed")]
            Kind::Speed { first, count } => Ok(Source::Curve(super::Curve::new(first, count))),
            #[cfg(feature = "stream")]
            Kind::Stream { low_n, high_n } => Ok(Source::Stream(super::Streamed::new(low_n, high_n))),
            #[allow(unreachable_patterns, reason = "no kind is left out")]
            _ => Err(Refusal::LeftOut { layer: number }),
        }
    }

    #[cfg(feature = "edge")]
    #[inline]
    fn click(&mut self, click: ClickRecord, number: u8) -> Result<Option<super::click::ClickNumber>, Refusal> {
        if click.height_n.abs() <= 0.0 {
            return Ok(None);
        }
        let refusal = too_many(ConfigField::ClickLayers, super::click::CLICKS_MAX, number);
        let click = super::click::Click::new(click, self.board);
        self.tables.add_click(click).map(Some).map_err(|_| refusal)
    }
}

#[cfg(any(feature = "noise", feature = "edge"))]
#[inline]
fn too_many(field: ConfigField, max: usize, layer: u8) -> Refusal {
    let max = max as f32;
    Refusal::Config(ConfigRefusal { field, found: max + 1.0, min: 0.0, max, layer })
}
