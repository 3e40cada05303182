//! What is wanted along a stroke: clicks depend on where the finger was before.

use super::Wanted;
use super::field::Field;

/// Where and when a finger is, and how fast.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Place from the screen's left edge, m.
    pub x_m: f64,
    /// Place from the screen's top edge, m.
    pub y_m: f64,
    /// Time since the board's power-on, s: that of its tick.
    pub t_s: f64,
    /// Sliding speed, m/s.
    pub speed_m_per_s: f64,
    /// The stream's sample, from 0 to 1.
    pub stream: f64,
    /// How much of the stream's layers there is, from 0 without a stream to 1.
    pub stream_weight: f64,
}

/// The friction that a program wants along a stroke, moment by moment: one for each tick of the board, so that
/// crossings are those that the board can see.
#[derive(Clone, Debug)]
pub struct Along {
    wanted: Wanted,
    tracks: Vec<Track>,
    touching: bool,
}

/// The past of a layer that clicks.
#[derive(Clone, Debug)]
struct Track {
    layer: usize,
    /// On which side of an edge, or inside of a button, the finger was at the moment before; `None` outside.
    side: Option<bool>,
    clicked_at_s: Option<f64>,
}

impl Along {
    pub(super) fn new(wanted: Wanted) -> Self {
        let clicking = wanted.pieces.iter().enumerate().filter(|(_, piece)| piece.field.click().is_some());
        let tracks = clicking.map(|(layer, _)| Track { layer, side: None, clicked_at_s: None }).collect();
        Self { wanted, tracks, touching: false }
    }

    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> f64 {
        self.wanted.natural_friction_n
    }

    /// Electric friction that is wanted at the next moment of the stroke, in newtons, as
    /// [`Wanted::electric_friction_n`] has it.
    pub fn electric_friction_n(&mut self, moment: &Moment) -> f64 {
        let Self { wanted, tracks, touching } = self;
        for track in tracks.iter_mut() {
            let Some(piece) = wanted.pieces.get(track.layer) else { continue };
            let side = piece.shape.covers(moment.x_m, moment.y_m).then(|| match &piece.field {
                Field::Edge(edge) => edge.distance_m(moment.x_m, moment.y_m) >= 0.0,
                _ => true,
            });
            let clicks = match (&piece.field, track.side, side) {
                (Field::Edge(_), Some(before), Some(now)) => before != now,
                (Field::Button(_), None, Some(_)) => *touching,
                _ => false,
            };
            if clicks {
                track.clicked_at_s = Some(moment.t_s);
            }
            track.side = side;
        }
        *touching = true;
        let click_n = |layer: usize| {
            let track = tracks.iter().find(|track| track.layer == layer)?;
            let click = wanted.pieces.get(layer)?.field.click()?;
            let left = 1.0 - (moment.t_s - track.clicked_at_s?) / f64::from(click.decay_s);
            (left > 0.0).then(|| f64::from(click.height_n) * left * left)
        };
        wanted.at(moment, |layer| click_n(layer).unwrap_or(0.0))
    }

    /// The finger leaves the screen.
    pub fn lift(&mut self) {
        self.touching = false;
        for track in &mut self.tracks {
            track.side = None;
        }
    }
}
