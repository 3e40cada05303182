//! Error of a felt texture against the run time of the estimator that follows the finger.
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};

use super::touch::{Class, Recording, best_of_grid, methods};

/// Classes of touch sources, as in `docs/touch.md`.
const CLASSES: [Class; 3] = [
    Class { rate_hz: 100.0, latency_s: 10e-3, wavelength_m: 10e-3 },
    Class { rate_hz: 200.0, latency_s: 5e-3, wavelength_m: 5e-3 },
    Class { rate_hz: 500.0, latency_s: 3e-3, wavelength_m: 2e-3 },
];
/// Median speed of the strokes, in m/s.
const MEDIAN_M_PER_S: f64 = 0.1;
const SEEDS: [u64; 3] = [1, 2, 3];
const MARKS: [Mark; 6] = [Mark::Ring, Mark::Ring, Mark::Square, Mark::Square, Mark::Triangle, Mark::Disc];

/// Root mean square of an error over the recordings.
fn rms(recordings: &[Recording], error: impl Fn(&Recording) -> f64) -> f64 {
    (recordings.iter().map(|recording| error(recording).powi(2)).sum::<f64>() / recordings.len() as f64).sqrt()
}

fn panel(class: Class, data: &mut Data<4>) -> Result<Panel, Box<dyn Error>> {
    let recordings =
        SEEDS.iter().map(|seed| Recording::new(class, MEDIAN_M_PER_S, *seed)).collect::<Result<Vec<_>, _>>()?;
    let title = format!(
        "{} Hz, {} ms late, simulated: stripes of {} mm",
        class.rate_hz,
        1e3 * class.latency_s,
        1e3 * class.wavelength_m
    );
    let mut panel = Panel::new(
        &title,
        Axis::log("time a report, ns (measured)", 1.0..10_000.0),
        Axis::linear("error below 40 Hz over the swing", 0.0..1.0),
    );
    for (number, method) in methods().into_iter().enumerate() {
        let error = rms(&recordings, |recording| recording.filtered_error(&mut *(method.make)(class.rate_hz)));
        let run_time_ns = recordings
            .first()
            .map_or(f64::NAN, |recording| 1e9 * recording.seconds_per_report(|| (method.make)(class.rate_hz)));
        data.row([method.name.into(), class.rate_hz.into(), run_time_ns.into(), error.into()]);
        let look = Look::mark(PALETTE[number % PALETTE.len()], MARKS[number % MARKS.len()]);
        panel.add(method.name, look, vec![(run_time_ns, error)]);
    }
    let hindsight = rms(&recordings, |recording| {
        best_of_grid().map(|mut filter| recording.filtered_error(&mut *filter)).fold(f64::INFINITY, f64::min)
    });
    let smoother = rms(&recordings, Recording::smoothed_error);
    for (name, error, line) in [
        ("best of 15 tunings, chosen with hindsight", hindsight, Line::Dashed),
        ("smoother that sees later reports", smoother, Line::Solid),
    ] {
        data.row([name.into(), class.rate_hz.into(), None.into(), error.into()]);
        panel.add(name, Look::line(PALETTE[6], line), vec![(1.0, error), (10_000.0, error)]);
    }
    Ok(panel)
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let mut data = Data::new(["method", "report_rate_hz", "measured_run_time_ns", "error_over_swing"]);
    let panels = CLASSES.iter().map(|class| panel(*class, &mut data)).collect::<Result<Vec<_>, _>>()?;
    Ok(Figure {
        name: "touch-estimators",
        title: "Error of a felt texture, simulated, against the run time of the touch estimator".to_owned(),
        caption: vec![
            "A sine grating that is played where an estimator says the finger is, against the same grating where it is: \
             rms of the difference below 40 Hz over that of the grating. Strokes of simulated people with a median speed \
             of 100 mm/s; one report in eight is lost, one in thirty is bunched with the next. The times were measured on \
             the computer that made this report, in f64; a board computes the same in f32, outside of the tick."
                .to_owned(),
            "The filters with gains of their own for every sample (rings) take a lost report for a fast finger. Kalman \
             filters (squares) know the time that has passed. Of them, the board's pays a fifth of its error for paths \
             that do not jump at a report. The lines are bounds: the best of fifteen tunings for each stroke, chosen \
             afterwards; and a smoother that sees later reports, too, which shows what latency costs."
                .to_owned(),
        ],
        chart: Chart::new(panels, 3),
        csv: data.csv()?,
    })
}
