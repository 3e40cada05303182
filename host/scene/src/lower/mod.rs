//! From a layer as written to a record of the wire.

mod place;

use frixel_layers::{
    Blend, Burst as WireBurst, Button, Click as WireClick, Constant, Edge, Grating, Header, Layer as WireLayer, Noise,
    Point, Record, Region as WireRegion, Speed, Stream, Vibration,
};
use frixel_wire::scene::POINTS_MAX;

use super::file::Scene;
use super::layer::{Above, Amount, Burst, Click, Kind, Layer, Region};
use super::left_out::LeftOut;
use super::log::Log;
use super::mistake::Mistake;
use super::pool::{Placed, Pool};
use super::program::Bitmap;
use super::reach::Reach;

/// Total friction this close to natural, relative to it, is natural: `mu F_N` rounds.
const NATURAL_ROUNDING: f64 = 1e-6;
/// Most layers of noise that a board takes.
const NOISES_MAX: usize = 8;
/// Most edges and buttons with a click that a board takes.
const CLICKS_MAX: usize = 16;
const MM: f64 = 1e-3;

/// Turns layers to records, and gathers what they name.
pub(super) struct Lowering<'a, 's> {
    scene: &'a Scene,
    header: &'a Header,
    reach: &'a Reach,
    tick_hz: u32,
    pool: Pool<'a>,
    points: Vec<Point>,
    noises: usize,
    clicks: usize,
    log: &'a mut Log<'s>,
    notes: Vec<String>,
}

/// What records name, and what was done to it.
pub(super) struct Lowered {
    pub(super) points: Vec<Point>,
    pub(super) bitmaps: Vec<Bitmap>,
    pub(super) notes: Vec<String>,
    pub(super) left_out: Vec<LeftOut>,
}

impl<'a, 's> Lowering<'a, 's> {
    pub(super) fn new(
        scene: &'a Scene,
        header: &'a Header,
        reach: &'a Reach,
        tick_hz: u32,
        pool: Pool<'a>,
        log: &'a mut Log<'s>,
    ) -> Self {
        let (points, notes) = (Vec::new(), Vec::new());
        Self { scene, header, reach, tick_hz, pool, points, noises: 0, clicks: 0, log, notes }
    }

    pub(super) fn finish(self) -> Lowered {
        let (bitmaps, left_out) = self.pool.finish();
        Lowered { points: self.points, bitmaps, notes: self.notes, left_out }
    }

    /// The record of a layer; `None` when something is wrong with it.
    pub(super) fn record(&mut self, layer: &Layer) -> Option<Record> {
        let (wire_layer, placed) = match &layer.kind {
            Kind::Bitmap(bitmap) => {
                let visible = layer.region.as_ref().map(Region::bounds);
                let screen = (self.scene.screen.width_mm, self.scene.screen.height_mm);
                let placed = self.pool.place(layer, bitmap, visible, screen, self.log, &mut self.notes)?;
                let record = self.bitmap(layer, &placed, bitmap.black, bitmap.white);
                (record, placed.outline)
            }
            kind => (self.kind(layer, kind)?, None),
        };
        let region = match layer.region.clone().or(placed) {
            Some(region) => {
                place::check_on_screen(self.scene, layer, region.bounds(), self.log);
                self.region(layer, &region)?
            }
            None => WireRegion::Screen,
        };
        Some(Record { region, blend: layer.blend, gain: layer.gain as f32, layer: wire_layer })
    }

    fn kind(&mut self, layer: &Layer, kind: &Kind) -> Option<WireLayer> {
        let amount = |amount| self.amount(layer, amount);
        Some(match kind {
            Kind::Constant { friction } => WireLayer::Constant(Constant { electric_friction_n: amount(*friction) }),
            Kind::Grating { wave, wavelength_mm, angle_deg, phase_deg, low, high } => {
                let (cycles_per_m_x, cycles_per_m_y) = place::wave_vector(*wavelength_mm, *angle_deg);
                WireLayer::Grating(Grating {
                    wave: *wave,
                    cycles_per_m_x,
                    cycles_per_m_y,
                    phase_turns: (phase_deg / 360.0).rem_euclid(1.0) as f32,
                    trough_n: amount(*low),
                    crest_n: amount(*high),
                })
            }
            Kind::Noise { seed, wavelength_min_mm, wavelength_max_mm, low, high } => {
                let noise = WireLayer::Noise(Noise {
                    seed: *seed,
                    wavelength_min_m: (wavelength_min_mm * MM) as f32,
                    wavelength_max_m: (wavelength_max_mm * MM) as f32,
                    low_n: amount(*low),
                    high_n: amount(*high),
                });
                self.noises += 1;
                self.limit(layer, "layers of noise", self.noises, NOISES_MAX)?;
                noise
            }
            Kind::Edge { x_mm, y_mm, angle_deg, width_mm, ridge, click } => WireLayer::Edge(Edge {
                x_m: (x_mm * MM) as f32,
                y_m: (y_mm * MM) as f32,
                angle_turns: place::turns(*angle_deg),
                width_m: (width_mm * MM) as f32,
                level_n: if layer.blend == Blend::Multiply { 1.0 } else { 0.0 },
                ridge_n: amount(*ridge),
                click: self.click(layer, *click)?,
            }),
            Kind::Button { rim_width_mm, rim, face, click } => WireLayer::Button(Button {
                rim_width_m: (rim_width_mm * MM) as f32,
                rim_n: amount(*rim),
                face_n: amount(*face),
                click: self.click(layer, *click)?,
            }),
            Kind::Vibration { beat, frequency_hz, low, high, burst } => WireLayer::Vibration(Vibration {
                beat: *beat,
                frequency_hz: *frequency_hz as f32,
                low_n: amount(*low),
                high_n: amount(*high),
                burst: burst.map_or(WireBurst::default(), |burst| self.burst(burst)),
            }),
            Kind::Speed { speeds_mm_per_s, factors } => {
                let pairs = speeds_mm_per_s.iter().zip(factors);
                let points = pairs.map(|(speed, factor)| Point { x: (speed * MM) as f32, y: *factor as f32 });
                let (first, count) = self.points(layer, points.collect())?;
                WireLayer::Speed(Speed { first, count })
            }
            Kind::Stream { low, high } => WireLayer::Stream(Stream { low_n: amount(*low), high_n: amount(*high) }),
            // It is placed apart.
            Kind::Bitmap(_) => return None,
        })
    }

    fn bitmap(&self, layer: &Layer, placed: &Placed, black: Amount, white: Amount) -> WireLayer {
        WireLayer::Bitmap(frixel_layers::Bitmap {
            crc32: placed.crc32,
            x_m: (placed.corner_mm.0 * MM) as f32,
            y_m: (placed.corner_mm.1 * MM) as f32,
            pitch_m: (placed.pitches_mm.0 * MM) as f32,
            black_n: self.amount(layer, black),
            white_n: self.amount(layer, white),
            pitch_y_m: (placed.pitches_mm.1 * MM) as f32,
            angle_turns: placed.angle_turns,
            tiled: placed.tiled,
        })
    }

    /// An amount as the wire has it: electric friction in newtons, or a factor.
    fn amount(&self, layer: &Layer, amount: Amount) -> f32 {
        match amount {
            Amount::Newtons(friction_n) => electric_n(layer.above, friction_n, self.reach.natural_friction_n),
            Amount::Fraction(fraction) => (fraction * self.reach.electric_friction_max_n) as f32,
            Amount::Factor(factor) => factor as f32,
        }
    }

    /// A click is added, so that it counts from what it is added to.
    fn click(&mut self, layer: &Layer, click: Option<Click>) -> Option<WireClick> {
        let Some(Click { height, decay_ms }) = click else { return Some(WireClick::default()) };
        self.clicks += 1;
        self.limit(layer, "edges and buttons with a click", self.clicks, CLICKS_MAX)?;
        let height_n = match height {
            Amount::Newtons(friction_n) => friction_n as f32,
            other => self.amount(layer, other),
        };
        Some(WireClick { height_n, decay_s: (decay_ms * MM) as f32 })
    }

    /// In whole ticks, as the board has it, so that a period is the same to both.
    fn burst(&self, burst: Burst) -> WireBurst {
        let tick_hz = f64::from(self.tick_hz);
        let whole = |time_ms: f64| ((time_ms * MM * tick_hz).round() / tick_hz) as f32;
        WireBurst { period_s: whole(burst.period_ms), on_s: whole(burst.on_ms), ramp_s: whole(burst.ramp_ms) }
    }

    fn region(&mut self, layer: &Layer, region: &Region) -> Option<WireRegion> {
        Some(match region {
            Region::Rectangle(rectangle) => {
                let button = matches!(layer.kind, Kind::Button { .. });
                place::rectangle(*rectangle, self.header, button)
            }
            Region::Ellipse(rectangle) => place::ellipse(*rectangle, self.header),
            Region::Polygon(vertices) => {
                let point = |(x_mm, y_mm): &(f64, f64)| Point { x: (x_mm * MM) as f32, y: (y_mm * MM) as f32 };
                let (first, count) = self.points(layer, vertices.iter().map(point).collect())?;
                WireRegion::Polygon { first, count }
            }
        })
    }

    /// Keeps points, or finds them where another layer has the same.
    fn points(&mut self, layer: &Layer, points: Vec<Point>) -> Option<(u8, u8)> {
        let count = points.len();
        let first = self.points.windows(count).position(|held| held == points).unwrap_or(self.points.len());
        if first == self.points.len() {
            self.points.extend(points);
        }
        self.limit(layer, "points of polygons and curves", self.points.len(), POINTS_MAX)?;
        Some((first as u8, count as u8))
    }

    fn limit(&mut self, layer: &Layer, what: &'static str, number: usize, max: usize) -> Option<()> {
        if number > max {
            self.log.add(layer.places.table(), Mistake::TooMany { what, number, max });
            return None;
        }
        Some(())
    }
}

/// Friction above natural, as the wire has it.
fn electric_n(above: Above, friction_n: f64, natural_friction_n: f64) -> f32 {
    let electric_n = match above {
        Above::Natural => friction_n,
        Above::Zero => friction_n - natural_friction_n,
    };
    let rounding = above == Above::Zero && electric_n.abs() <= NATURAL_ROUNDING * natural_friction_n;
    if rounding { 0.0 } else { electric_n as f32 }
}
