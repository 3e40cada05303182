//! A board, simulated or at a serial port, that plays while the Python program calls.

mod worker;

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use frixel_lab::recording::Metadata;
use frixel_scene::{Program, compile};
use frixel_wire::hello::Hello;
use frixel_wire::message::{Telemetry, telemetry_period_ticks};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use super::error::{parameter_error, raised, scene_error};
use super::recording::Made;
use super::scene::Scene;
use super::signals::{SIGNALS_PERIOD, raised_by_signal};
use worker::{Interrupted, Report, Request, Trouble};

/// The port of the simulated board.
const SIMULATOR: &str = "sim";
const CLOSED: &str = "this device is closed: open it again with Device.open";
const ENDED: &str = "the thread of this device has ended: open it again with Device.open";

/// The result of each call for Python: state, time of the board in s, whether a stream is under way, sentences, and
/// telemetry.
type Answer = (&'static str, f64, bool, Vec<String>, Vec<Message>);
/// Tick, state, flags, x and y in m, speed in m/s, commanded electric friction in N, and voltage in V rms.
type Message = (u32, &'static str, Vec<&'static str>, f32, f32, f32, f32, f32);

/// A board in a thread of its own. The thread acts only on requests, so that the board is pinged only while the program
/// calls.
#[pyclass(frozen, module = "frixel._frixel")]
pub(crate) struct Device {
    port: String,
    hello: Hello,
    /// `None` once closed.
    line: Mutex<Option<Line>>,
}

/// The channels to the thread that owns the board.
struct Line {
    requests: Sender<Request>,
    replies: Receiver<Result<Report, Trouble>>,
    interrupted: Interrupted,
    thread: JoinHandle<()>,
}

impl Line {
    /// Starts the thread, which opens the port.
    fn open(port: &str, arm: bool) -> Result<(Self, Hello), Trouble> {
        let (requests, asked) = channel();
        let (answers, replies) = channel();
        let (opened, is_open) = channel();
        let interrupted = Interrupted::default();
        let (port, watched) = (port.to_owned(), interrupted.clone());
        let run = move || worker::run(&port, arm, &opened, (&asked, &answers), &watched);
        let thread = thread::Builder::new().name("frixel-device".into()).spawn(run);
        let thread = thread.map_err(|error| Trouble::Play(format!("no thread could be started: {error}")))?;
        let hello = is_open.recv().map_err(|_| Trouble::Play(ENDED.into()))??;
        Ok((Self { requests, replies, interrupted, thread }, hello))
    }

    /// Sends a request, and waits for its report. Disarms the board on a signal, such as that of Ctrl-C.
    fn ask(&self, request: Request) -> Result<Report, Trouble> {
        let ended = || Trouble::Play(ENDED.into());
        self.requests.send(request).map_err(|_| ended())?;
        let mut signal = None;
        let reply = loop {
            match self.replies.recv_timeout(SIGNALS_PERIOD) {
                Ok(reply) => break reply,
                Err(RecvTimeoutError::Disconnected) => return Err(ended()),
                Err(RecvTimeoutError::Timeout) if signal.is_some() => {}
                Err(RecvTimeoutError::Timeout) => {
                    signal = raised_by_signal();
                    self.interrupted.set(signal.is_some());
                }
            }
        };
        let Some(signal) = signal else { return reply };
        // Only the signal is reported to the program; a board that is out of reach stops by its host timeout.
        if self.requests.send(Request::Stop).is_ok() {
            let _ = self.replies.recv();
        }
        self.interrupted.set(false);
        Err(Trouble::Signal(signal))
    }
}

impl Device {
    fn line(&self) -> MutexGuard<'_, Option<Line>> {
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn ask(&self, py: Python<'_>, request: Request) -> PyResult<Answer> {
        let asked = py.detach(|| {
            let line = self.line();
            line.as_ref().ok_or_else(|| Trouble::Play(CLOSED.into()))?.ask(request)
        });
        asked.map(answer).map_err(|trouble| exception(py, trouble))
    }

    /// The program of a scene for this board.
    fn program(&self, py: Python<'_>, scene: &Scene) -> PyResult<Box<Program>> {
        if self.port == SIMULATOR {
            return Ok(scene.program().clone().into());
        }
        let compiled = py.detach(|| compile(scene.parsed(), &self.hello.limits, self.hello.tick_hz));
        Ok(compiled.map_err(|error| scene_error(py, &error))?.into())
    }
}

#[pymethods]
impl Device {
    /// Connects to the board at a port, or to a simulated one.
    #[new]
    fn new(py: Python<'_>, port: String, arm: bool) -> PyResult<Self> {
        let opened = py.detach(|| Line::open(&port, arm));
        let (line, hello) = opened.map_err(|trouble| exception(py, trouble))?;
        Ok(Self { port, hello, line: Mutex::new(Some(line)) })
    }

    /// Name of the board's kind.
    #[getter]
    fn board(&self) -> String {
        self.hello.board.to_string()
    }

    /// Ticks a second.
    #[getter]
    fn ticks_per_s(&self) -> u32 {
        self.hello.tick_hz
    }

    /// Notes on the board, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<&'static str> {
        self.hello.notice_sentences().collect()
    }

    /// Whether the port was closed.
    #[getter]
    fn is_closed(&self, py: Python<'_>) -> bool {
        py.detach(|| self.line().is_none())
    }

    fn play(&self, py: Python<'_>, scene: &Scene) -> PyResult<Answer> {
        self.ask(py, Request::Play(self.program(py, scene)?))
    }

    fn replace(&self, py: Python<'_>, scene: &Scene) -> PyResult<Answer> {
        self.ask(py, Request::Replace(self.program(py, scene)?))
    }

    fn set_layer(&self, py: Python<'_>, layer: String, on: Option<bool>, gain: Option<f32>) -> PyResult<Answer> {
        self.ask(py, Request::SetLayer { layer, on, gain })
    }

    fn trigger(&self, py: Python<'_>, layer: String, duration_s: Option<f64>) -> PyResult<Answer> {
        self.ask(py, Request::Trigger { layer, duration_s })
    }

    /// Begins to stream samples from 0 to 1.
    fn stream(&self, py: Python<'_>, samples: PyReadonlyArray1<'_, f64>, sample_hz: u32) -> PyResult<Answer> {
        let code = |sample: &f64| (f64::from(u16::MAX) * sample).round() as u16;
        let samples = samples.as_array().iter().map(code).collect();
        self.ask(py, Request::Stream { samples, sample_hz })
    }

    /// Requests telemetry at this rate; 0 ends it.
    fn subscribe(&self, py: Python<'_>, messages_per_s: u32) -> PyResult<Answer> {
        let period_ticks = match messages_per_s {
            0 => 0,
            _ => telemetry_period_ticks(self.hello.tick_hz, messages_per_s),
        };
        self.ask(py, Request::Subscribe { period_ticks })
    }

    /// Lets time pass on the board, at most 50 ms.
    fn listen(&self, py: Python<'_>, seconds: f64) -> PyResult<Answer> {
        self.ask(
            py,
            Request::Listen(Duration::try_from_secs_f64(seconds).unwrap_or(SIGNALS_PERIOD).min(SIGNALS_PERIOD)),
        )
    }

    /// Handles the messages that the board has sent.
    fn look(&self, py: Python<'_>) -> PyResult<Answer> {
        self.ask(py, Request::Look)
    }

    /// Metadata of a play on this board, as JSON, for its recording.
    fn made(&self, py: Python<'_>, messages_per_s: u32) -> PyResult<String> {
        let metadata = Metadata {
            ticks_per_row: telemetry_period_ticks(self.hello.tick_hz, messages_per_s),
            ..Metadata::new("board", Some(&self.hello), self.hello.board.is_simulated(), None)
        };
        let made = Made { metadata, files: BTreeMap::new(), later_scenes: Vec::new(), markers: Vec::new() };
        serde_json::to_string(&made).map_err(|error| raised(py, "PlayError", (error.to_string(),)))
    }

    /// Sets the output to zero and disarms the board.
    fn stop(&self, py: Python<'_>) -> PyResult<Answer> {
        self.ask(py, Request::Stop)
    }

    /// Disarms the board and closes the port. Returns the board's last answer; `None` if it is closed already.
    fn close(&self, py: Python<'_>) -> PyResult<Option<Answer>> {
        let closed = py.detach(|| {
            let line = self.line().take()?;
            let stopped = line.ask(Request::Stop);
            let Line { requests, thread, .. } = line;
            drop(requests);
            // A thread that has panicked has dropped the port.
            let _ = thread.join();
            Some(stopped)
        });
        closed.transpose().map(|report| report.map(answer)).map_err(|trouble| exception(py, trouble))
    }
}

fn answer(report: Report) -> Answer {
    let Report { state, now, is_streaming, sentences, telemetry } = report;
    let messages = telemetry.iter().map(message).collect();
    (state.word(), now.as_secs_f64(), is_streaming, sentences, messages)
}

fn message(telemetry: &Telemetry) -> Message {
    let Telemetry { tick, state, flags, finger_x_m, finger_y_m, speed_m_per_s, .. } = *telemetry;
    let Telemetry { commanded_electric_friction_n, voltage_v_rms, .. } = *telemetry;
    let flags = flags.names().collect();
    (tick, state.word(), flags, finger_x_m, finger_y_m, speed_m_per_s, commanded_electric_friction_n, voltage_v_rms)
}

fn exception(py: Python<'_>, trouble: Trouble) -> PyErr {
    match trouble {
        Trouble::Signal(signal) => signal,
        Trouble::Parameter(message) => parameter_error(py, message),
        Trouble::Play(message) => raised(py, "PlayError", (message,)),
    }
}
