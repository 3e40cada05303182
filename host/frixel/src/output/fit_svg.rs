//! The residual plots of a fit.

use super::{DrawingError, svg};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};
use frixel_lab::fit::Fit;

/// Number of points of a fitted curve.
const CURVE_POINTS: u32 = 100;

/// Draws the measurements beside the fit: electric friction over voltage with the fitted law and a square law, the
/// residuals over time and over load, and the friction coefficient per stroke.
pub(crate) fn draw_fit_svg(title: &str, fit: &Fit) -> Result<String, DrawingError> {
    svg(&chart(title, fit))
}

fn chart(title: &str, fit: &Fit) -> Chart {
    let mut chart = Chart::new(vec![over_voltage(fit), residuals(fit), over_load(fit), coefficients(fit)], 2);
    title.clone_into(&mut chart.title);
    chart.caption = vec![
        "Each mark is the mean of one stroke at one voltage, relative to the friction while the drive is off just \
         before and after. Residuals that depend on voltage, load or time show what the model does not explain."
            .to_owned(),
    ];
    chart
}

/// Values with a twentieth of their range on either side.
fn range(values: impl Iterator<Item = f64>) -> core::ops::Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let margin = (0.05 * (high - low)).max(1e-3);
    low - margin..high + margin
}

fn over_voltage(fit: &Fit) -> Panel {
    let points: Vec<_> = points(fit).map(|(_, point)| (point.voltage_v_rms, 1e3 * point.measured_n)).collect();
    let most_v_rms = 1.05 * fit.data.voltage_range_v_rms.1;
    let most_mn = fit.electric_friction_at_n(most_v_rms).map_or(0.0, |newtons| 1e3 * newtons);
    let mut panel = Panel::new(
        "Electric friction",
        Axis::linear("voltage, V rms", 0.0..most_v_rms),
        Axis::linear("electric friction, mN", range(points.iter().map(|(_, value)| *value).chain([0.0, most_mn]))),
    );
    let voltages = || (0..=CURVE_POINTS).map(|step| most_v_rms * f64::from(step) / f64::from(CURVE_POINTS));
    let model = voltages().filter_map(|volts| Some((volts, 1e3 * fit.electric_friction_at_n(volts)?)));
    let highest_v_rms = fit.data.voltage_range_v_rms.1;
    let square = voltages().map(|volts| {
        (volts, 1e3 * fit.electric_friction_most_n.value * (volts / highest_v_rms) * (volts / highest_v_rms))
    });
    panel.add("measured", Look::mark(PALETTE[0], Mark::Ring), points);
    panel.add("contact model, fitted", Look::line(PALETTE[1], Line::Solid), model.collect());
    panel.add("square law", Look::line(PALETTE[6], Line::Dashed), square.collect());
    panel
}

fn points(fit: &Fit) -> impl Iterator<Item = (usize, &frixel_lab::fit::Point)> {
    fit.strokes.iter().enumerate().flat_map(|(index, stroke)| stroke.points.iter().map(move |point| (index + 1, point)))
}

fn residuals(fit: &Fit) -> Panel {
    let points: Vec<_> = points(fit).map(|(stroke, point)| (stroke as f64, 1e3 * point.residual_n)).collect();
    let mut panel = Panel::new(
        "Residuals over time",
        stroke_axis(fit),
        Axis::linear("measured − fitted, mN", range(points.iter().map(|(_, value)| *value).chain([0.0]))),
    );
    panel.add("", Look::line(PALETTE[6], Line::Thin), vec![(0.0, 0.0), (fit.strokes.len() as f64 + 1.0, 0.0)]);
    panel.add("residual of a stroke", Look::mark(PALETTE[0], Mark::Ring), points);
    panel
}

fn over_load(fit: &Fit) -> Panel {
    let points: Vec<_> = points(fit).map(|(_, point)| (point.normal_load_n, 1e3 * point.residual_n)).collect();
    let loads = range(points.iter().map(|(load_n, _)| *load_n));
    let mut panel = Panel::new(
        "Residuals over load",
        Axis::linear("normal load, N", loads.clone()),
        Axis::linear("measured − fitted, mN", range(points.iter().map(|(_, value)| *value).chain([0.0]))),
    );
    panel.add("", Look::line(PALETTE[6], Line::Thin), vec![(loads.start, 0.0), (loads.end, 0.0)]);
    panel.add("residual of a stroke", Look::mark(PALETTE[0], Mark::Ring), points);
    panel
}

fn coefficients(fit: &Fit) -> Panel {
    let coefficient = |(index, stroke): (usize, &frixel_lab::fit::StrokeResult)| {
        Some((index as f64 + 1.0, stroke.natural_coefficient?))
    };
    let points: Vec<_> = fit.strokes.iter().enumerate().filter_map(coefficient).collect();
    let last = fit.strokes.len() as f64 + 1.0;
    let mean = fit.friction_coefficient.value;
    let mut panel = Panel::new(
        "Natural friction",
        stroke_axis(fit),
        Axis::linear("friction over load, drive off", range(points.iter().map(|(_, value)| *value))),
    );
    panel.add("fitted coefficient", Look::line(PALETTE[1], Line::Solid), vec![(0.0, mean), (last, mean)]);
    panel.add("stroke", Look::mark(PALETTE[0], Mark::Ring), points);
    panel
}

fn stroke_axis(fit: &Fit) -> Axis {
    Axis::linear("stroke", 0.0..fit.strokes.len() as f64 + 1.0)
}
