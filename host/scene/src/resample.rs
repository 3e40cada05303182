//! Resamples pictures to the board's pitch.

/// One axis of a resampled picture's grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Samples of the whole picture.
    pub(super) whole: usize,
    /// Samples cropped before the first one.
    pub(super) skipped: usize,
    /// Samples along it.
    pub(super) samples: usize,
    /// Picture pixels per sample.
    pub(super) pixels_per_sample: f64,
}

impl Axis {
    /// Samples that cover `length_mm`. The last one may extend past the picture's end by less than a pitch.
    pub(super) fn covering(length_mm: f64, pitch_mm: f64, pixels: usize) -> Self {
        // Ignore a rounding error of a millionth of a sample.
        let samples = (length_mm / pitch_mm - 1e-6).ceil().max(1.0) as usize;
        Self { whole: samples, skipped: 0, samples, pixels_per_sample: pixels as f64 * pitch_mm / length_mm }
    }

    /// Samples that divide a length evenly, at approximately this pitch, so that it can be tiled.
    pub(super) fn dividing(length_mm: f64, pitch_mm: f64, pixels: usize) -> Self {
        let samples = (length_mm / pitch_mm).round().max(1.0);
        let whole = samples as usize;
        Self { whole, skipped: 0, samples: whole, pixels_per_sample: pixels as f64 / samples }
    }

    /// Crops the axis to the samples that matter between two places, in units of samples.
    pub(super) fn cropped(self, from: f64, to: f64) -> Self {
        let last = (self.samples - 1) as f64;
        // A place depends on the nearest sample centres. Ignore a rounding error of a millionth of a sample.
        let skipped = (from - 0.5 + 1e-6).floor().clamp(0.0, last) as usize;
        let end = (to - 0.5 - 1e-6).ceil().clamp(skipped as f64, last) as usize;
        Self { skipped, samples: end - skipped + 1, ..self }
    }

    /// The whole picture's samples, or its pixels if they are fewer.
    pub(super) fn whole_in_pixels(self, pixels: usize) -> Self {
        if self.pixels_per_sample < 1.0 {
            return Self { whole: pixels, skipped: 0, samples: pixels, pixels_per_sample: 1.0 };
        }
        Self { skipped: 0, samples: self.whole, ..self }
    }

    /// The first pixel of a sample, and the weights of the pixels from there on, which sum to one. A sample of one
    /// pixel or more is the mean over its area. A smaller one is interpolated between pixel centres, and constant
    /// beyond the outermost ones.
    fn weights(self, sample: usize, pixels: usize) -> (usize, Vec<f64>) {
        let last = pixels.saturating_sub(1);
        let start = (self.skipped + sample) as f64 * self.pixels_per_sample;
        if self.pixels_per_sample < 1.0 {
            let centre = (start + self.pixels_per_sample / 2.0 - 0.5).clamp(0.0, last as f64);
            let first = (centre as usize).min(last.saturating_sub(1));
            let second = centre - first as f64;
            return if last == 0 { (0, vec![1.0]) } else { (first, vec![1.0 - second, second]) };
        }
        let end = (start + self.pixels_per_sample).min(pixels as f64);
        let first = (start as usize).min(last);
        let mut weights = Vec::new();
        for pixel in first..pixels {
            let overlap = end.min(pixel as f64 + 1.0) - start.max(pixel as f64);
            if overlap <= 0.0 {
                break;
            }
            weights.push(overlap);
        }
        let sum: f64 = weights.iter().sum();
        (first, weights.iter().map(|weight| weight / sum).collect())
    }
}

/// Resamples rows of `width` grey values (0 to 255) to the grid of `across` and `down`, and rounds them to whole
/// numbers.
pub(super) fn resample(grey: &[f32], width: usize, across: Axis, down: Axis) -> Vec<u8> {
    if width == 0 || grey.is_empty() {
        return Vec::new();
    }
    let height = grey.len() / width;
    let columns: Vec<_> = (0..across.samples).map(|sample| across.weights(sample, width)).collect();
    let mut narrow = Vec::with_capacity(columns.len() * height);
    for row in grey.chunks_exact(width) {
        for (first, weights) in &columns {
            narrow.push(weighted(weights, row.iter().skip(*first).copied()));
        }
    }
    let mut samples = Vec::with_capacity(across.samples * down.samples);
    for row in 0..down.samples {
        let (first, weights) = down.weights(row, height);
        for column in 0..across.samples {
            let below = narrow.iter().skip(first * across.samples + column).step_by(across.samples);
            let value = weighted(&weights, below.copied());
            samples.push((value + 0.5).clamp(0.0, 255.0) as u8);
        }
    }
    samples
}

fn weighted(weights: &[f64], values: impl Iterator<Item = f32>) -> f32 {
    weights.iter().zip(values).map(|(weight, value)| weight * f64::from(value)).sum::<f64>() as f32
}
