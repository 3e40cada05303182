//! Screens: size, coating, and drive limits.
//!
//! A screen is a TOML file of its own, or the table `[screen]` of a scene. Both have the same fields.

mod read;
#[cfg(test)]
mod tests;

use super::compile_error::CompileError;
use super::fields::read_text;
use super::file_kind::FileKind;
use super::profile::Profile;

pub(super) use read::{EFFECTIVE_GAP_MAX_UM, read};

/// Parameters of a screen.
///
/// ```
/// use frixel_scene::{Profile, Screen};
///
/// let screen = Screen::parse("width_mm = 120\nheight_mm = 80\n", "small.toml")?;
/// assert_eq!(screen.coating, Screen::example().coating);
/// assert!((screen.coating_gap_um() - 1.0 / 3.9).abs() < 1e-12);
/// # Ok::<(), frixel_scene::CompileError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Screen {
    /// Name that finger profiles refer to.
    pub name: Option<String>,
    /// Width, along x, 5 to 2,000 mm.
    pub width_mm: f64,
    /// Height, along y, 5 to 2,000 mm.
    pub height_mm: f64,
    /// The insulator between electrode and finger: one or more slabs in series.
    pub coating: Vec<Slab>,
    /// Largest rms voltage, in volts, if the screen limits it.
    pub voltage_max_v_rms: Option<f64>,
    /// Largest peak voltage, in volts, if the screen limits it.
    pub voltage_max_v_peak: Option<f64>,
    /// Fastest change of the envelope, in volts per microsecond, if the screen limits it.
    pub slew_v_per_us: Option<f64>,
}

/// A slab of insulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Thickness, 0.01 to 1,000 um.
    pub thickness_um: f64,
    /// Relative permittivity, 1 to 10,000.
    pub permittivity: f64,
}

impl Slab {
    /// The coating of the example screen: 1 um of silicon dioxide, typical of laboratory screens.
    pub const EXAMPLE: Self = Self { thickness_um: 1.0, permittivity: 3.9 };
}

impl Screen {
    /// The default screen of a scene: 120 mm by 80 mm, [`Slab::EXAMPLE`], no limits of its own.
    pub fn example() -> Self {
        Self {
            name: Some("example".to_owned()),
            width_mm: 120.0,
            height_mm: 80.0,
            coating: vec![Slab::EXAMPLE],
            voltage_max_v_rms: None,
            voltage_max_v_peak: None,
            slew_v_per_us: None,
        }
    }

    /// Effective gap of the coating: the sum of thickness over permittivity, in micrometres.
    pub fn coating_gap_um(&self) -> f64 {
        self.coating.iter().fold(0.0, |sum, slab| sum + slab.thickness_um / slab.permittivity)
    }

    /// [`Self::coating_gap_um`] in metres.
    pub fn coating_gap_m(&self) -> f64 {
        1e-6 * self.coating_gap_um()
    }
}

impl Profile for Screen {
    const KIND: FileKind = FileKind::Screen;

    fn bundled_names() -> Vec<&'static str> {
        vec!["example"]
    }

    fn bundled(name: &str) -> Option<Self> {
        (name == "example").then(Self::example)
    }

    fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, CompileError> {
        read_text(Self::KIND, text.as_ref(), name, read)
    }
}
