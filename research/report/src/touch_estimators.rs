//! Error of a felt texture against the run time of the estimator that follows the finger.
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};

use frixel_hil_sim::{HUMAN_TEST_SEEDS, HUMAN_TUNING_SEEDS, Stroke};

use super::touch::{Class, Hand, Recording, Trained, best_of_grid, methods};

/// Classes of touch sources, as in `docs/touch.md`.
const CLASSES: [Class; 3] = [
    Class { rate_hz: 100.0, latency_s: 10e-3, wavelength_m: 10e-3 },
    Class { rate_hz: 200.0, latency_s: 5e-3, wavelength_m: 5e-3 },
    Class { rate_hz: 500.0, latency_s: 3e-3, wavelength_m: 2e-3 },
];
/// Median speed of the strokes, in m/s.
const MEDIAN_M_PER_S: f64 = 0.1;
const HANDS: [(&str, Hand); 2] = [("human", Stroke::human), ("human-rough", Stroke::human_rough)];
/// Strokes that are judged, and strokes that the predictor is trained on.
const STROKES: usize = 6;
const TRAINED_STROKES: usize = 24;
const MARKS: [Mark; 6] = [Mark::Ring, Mark::Ring, Mark::Square, Mark::Square, Mark::Triangle, Mark::Disc];

/// Root mean square of an error over the recordings.
fn rms(recordings: &[Recording], error: impl Fn(&Recording) -> f64) -> f64 {
    (recordings.iter().map(|recording| error(recording).powi(2)).sum::<f64>() / recordings.len() as f64).sqrt()
}

fn panel(class: Class, (hand_name, hand): (&'static str, Hand), data: &mut Data<5>) -> Result<Panel, Box<dyn Error>> {
    let record = |seed| Recording::new(class, hand, MEDIAN_M_PER_S, seed);
    let recordings = HUMAN_TEST_SEEDS.take(STROKES).map(record).collect::<Result<Vec<_>, _>>()?;
    let training = HUMAN_TUNING_SEEDS.take(TRAINED_STROKES).map(record).collect::<Result<Vec<_>, _>>()?;
    let trained = Trained::on(&training, class.rate_hz);
    let title = format!(
        "{hand_name}, {} Hz, {} ms late, simulated: stripes of {} mm",
        class.rate_hz,
        1e3 * class.latency_s,
        1e3 * class.wavelength_m
    );
    let mut panel = Panel::new(
        &title,
        Axis::log("time a report, ns (measured)", 1.0..10_000.0),
        Axis::linear("error over the rms of the texture", 0.0..1.0),
    );
    for (number, method) in methods().into_iter().enumerate() {
        let error = rms(&recordings, |recording| recording.filtered_error(|| (method.make)(class.rate_hz)));
        let run_time_ns = recordings
            .first()
            .map_or(f64::NAN, |recording| 1e9 * recording.seconds_per_report(|| (method.make)(class.rate_hz)));
        data.row([method.name.into(), hand_name.into(), class.rate_hz.into(), run_time_ns.into(), error.into()]);
        let look = Look::mark(PALETTE[number % PALETTE.len()], MARKS[number % MARKS.len()]);
        panel.add(method.name, look, vec![(run_time_ns, error)]);
    }
    let hindsight = rms(&recordings, |recording| {
        best_of_grid().map(|make| recording.filtered_error(make)).fold(f64::INFINITY, f64::min)
    });
    let smoother = rms(&recordings, Recording::smoothed_error);
    for (name, error, line) in [
        ("best of 15 tunings, chosen with hindsight", hindsight, Line::Dashed),
        (
            "linear, trained on other strokes",
            rms(&recordings, |recording| recording.trained_error(&trained)),
            Line::Thin,
        ),
        ("smoother that sees later reports", smoother, Line::Solid),
    ] {
        data.row([name.into(), hand_name.into(), class.rate_hz.into(), None.into(), error.into()]);
        panel.add(name, Look::line(PALETTE[6], line), vec![(1.0, error), (10_000.0, error)]);
    }
    Ok(panel)
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let mut data = Data::new(["method", "stroke", "report_rate_hz", "measured_run_time_ns", "error_over_rms"]);
    let cases = HANDS.iter().flat_map(|hand| CLASSES.map(|class| (class, *hand)));
    let panels = cases.map(|(class, hand)| panel(class, hand, &mut data)).collect::<Result<Vec<_>, _>>()?;
    Ok(Figure {
        name: "touch-estimators",
        title: "Error of a felt texture, simulated, against the run time of the touch estimator".to_owned(),
        caption: vec![
            "A sine grating that is played where an estimator says the finger is, against the same grating where it is: \
             rms of the difference from 0 to 400 Hz over that of the grating. Touches of simulated people with a median \
             speed of 100 mm/s, with the accelerations of recorded ones after smoothing (human) and before (human-rough); \
             one report in eight is lost, one in thirty is bunched with the next, places come in steps of 0.18 mm, and \
             there is a pause in ten seconds. The times were measured on the computer that made this report, in f64; a \
             board computes the same in f32, outside of the tick."
                .to_owned(),
            "The filters with gains of their own for every sample (rings) take a lost report for a fast finger. Kalman \
             filters (squares) know the time that has passed. The lines are bounds: the best of fifteen tunings for each \
             stroke, chosen afterwards; a linear function of the last places, trained on other strokes for each age of \
             the newest report; and a smoother that sees later reports, too, which shows what latency costs."
                .to_owned(),
        ],
        chart: Chart::new(panels, 3),
        csv: data.csv()?,
    })
}
