//! Records which layers of a program a finger has touched.

use super::program::Program;
use super::titles::LayerTitle;
use crate::reference::Reference;

/// Number of places tried along each side of a layer's region.
const PLACES: u32 = 40;

/// Records which layers a finger has touched. A layer hidden by one that is on and replaces it is not touched there.
#[derive(Clone, Debug)]
pub struct TouchedLayers {
    reference: Reference,
    screen_m: (f64, f64),
    titles: Vec<LayerTitle>,
    touched: Vec<bool>,
    /// Indices from the bottom of the layers that are off, which hide nothing.
    off: Vec<usize>,
}

/// The middle of a layer from the top left corner of the screen, and the sides of its bounding rectangle within the
/// screen, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerMiddle {
    /// Place of the middle.
    pub x_m: f64,
    /// Place of the middle.
    pub y_m: f64,
    /// Side along x.
    pub width_m: f64,
    /// Side along y.
    pub height_m: f64,
}

impl TouchedLayers {
    /// Creates a record in which no layer of the program is touched.
    pub fn new(program: &Program) -> Self {
        let reference = Reference::new(program);
        let off = (0..).zip(&program.start).filter(|(_, setting)| !setting.on).map(|(layer, _)| layer).collect();
        let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
        Self { touched: vec![false; reference.layer_count()], reference, screen_m, titles: program.titles.clone(), off }
    }

    /// Adds a place of the finger, from the top left corner of the screen, m. Returns the topmost layer there, by its
    /// index from the bottom.
    pub fn add(&mut self, x_m: f64, y_m: f64) -> Option<usize> {
        let layers = self.layers_at(x_m, y_m);
        for index in &layers {
            if let Some(touched) = self.touched.get_mut(*index) {
                *touched = true;
            }
        }
        layers.first().copied()
    }

    /// Sets the layers that are off from now on, by their indices from the bottom.
    pub fn switch(&mut self, off: &[usize]) {
        if self.off != off {
            off.clone_into(&mut self.off);
        }
    }

    /// The title of a layer in messages.
    pub fn title(&self, index: usize) -> Option<&LayerTitle> {
        self.titles.get(index)
    }

    /// Indices from the bottom of the layers that were never touched.
    pub fn untouched(&self) -> impl Iterator<Item = usize> {
        self.touched.iter().enumerate().filter(|(_, touched)| !**touched).map(|(index, _)| index)
    }

    /// The middle of a layer, or the nearest place at which a finger touches it; `None` if no tried place is inside the
    /// layer.
    pub fn middle(&self, index: usize) -> Option<LayerMiddle> {
        let [left_m, top_m, right_m, bottom_m] = self.reference.bounds_m(index)?;
        let (left_m, right_m) = (left_m.max(0.0), right_m.min(self.screen_m.0));
        let (top_m, bottom_m) = (top_m.max(0.0), bottom_m.min(self.screen_m.1));
        let part = |number: u32| (f64::from(number) + 0.5) / f64::from(PLACES);
        let mut places: Vec<(f64, f64)> =
            (0..PLACES * PLACES).map(|number| (part(number % PLACES), part(number / PLACES))).collect();
        places.sort_by(|one, other| off_middle(*one).total_cmp(&off_middle(*other)));
        let (width_m, height_m) = (right_m - left_m, bottom_m - top_m);
        let (x_m, y_m) = places
            .into_iter()
            .map(|(x, y)| (left_m + x * width_m, top_m + y * height_m))
            .find(|(x_m, y_m)| self.is_touched_at(index, *x_m, *y_m))?;
        Some(LayerMiddle { x_m, y_m, width_m, height_m })
    }

    /// Whether a finger at a place touches a layer.
    pub fn is_touched_at(&self, index: usize, x_m: f64, y_m: f64) -> bool {
        self.layers_at(x_m, y_m).contains(&index)
    }

    /// Number of layers.
    pub fn layer_count(&self) -> usize {
        self.reference.layer_count()
    }

    /// The layers that a finger touches at a place, from the topmost down.
    fn layers_at(&self, x_m: f64, y_m: f64) -> Vec<usize> {
        let is_on_screen = (0.0..=self.screen_m.0).contains(&x_m) && (0.0..=self.screen_m.1).contains(&y_m);
        self.reference.covering_at(x_m, y_m, &self.off).filter(|_| is_on_screen).collect()
    }
}

/// Distance from the middle of a place given in fractions of both sides.
fn off_middle((x, y): (f64, f64)) -> f64 {
    (x - 0.5).abs().max((y - 0.5).abs())
}
