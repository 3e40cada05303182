//! The exports of the module: plain numbers in and out, and one buffer in each direction.
//!
//! The page calls [`input`] for a buffer of a length, fills it, and calls an export. Afterwards [`output`] and
//! [`output_len`] say where the answer is. An export returns 0, or 1 when the answer is a JSON text with `error`.
//! Unless documented otherwise, an export's input is a [`Request`] and its answer JSON.
//!
//! The functions are also callable natively; only their names are for the page.
#![allow(unsafe_code, reason = "an export needs a name that the linker keeps; nothing else in this file is unsafe")]

use std::cell::RefCell;
use std::time::Duration;

use frixel_felt::judge::{WEBER_FRACTION, weber_steps};
use frixel_felt::recorder::OFF_BELOW_V_RMS;
use frixel_hil_sim::Board;
use frixel_scene::check_picture;
use frixel_wire::fault::{Fault, State};
use frixel_wire::message::telemetry_period_ticks;
use serde::Serialize;
use serde_json::{Value, json};

use crate::additions;
use crate::answer;
use crate::felt::COLUMNS;
use crate::host::{self, Host};
use crate::host_error::HostError;
use crate::layer_text;
use crate::link_stream::LinkStream;
use crate::map::MAP_HEAD;
use crate::place;
use crate::pointer::PointerSample;
use crate::request::Request;
use crate::simulator::{FRAME_HEAD, Simulator};

/// Telemetry messages a second of a board outside of the page.
const TELEMETRY_HZ: u32 = 100;

thread_local! {
    static INPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static OUTPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static SIMULATOR: RefCell<Option<Simulator>> = const { RefCell::new(None) };
    static HOST: RefCell<Option<Host<LinkStream>>> = const { RefCell::new(None) };
}

/// Makes the input buffer `len` bytes long, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn input(len: usize) -> *mut u8 {
    INPUT.with_borrow_mut(|input| {
        input.clear();
        input.resize(len, 0);
        input.as_mut_ptr()
    })
}

/// Address of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    OUTPUT.with_borrow(Vec::as_ptr)
}

/// Length of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn output_len() -> usize {
    OUTPUT.with_borrow(Vec::len)
}

/// Writes the message of a panic to the output buffer from now on. The module then traps, and can no longer be used.
#[unsafe(no_mangle)]
pub extern "C" fn report_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let text = json!({ "error": format!("the engine failed: {panic}") }).to_string();
        OUTPUT.with(|output| {
            if let Ok(mut output) = output.try_borrow_mut() {
                *output = text.into_bytes();
            }
        });
    }));
}

/// [`crate::check`].
#[unsafe(no_mangle)]
pub extern "C" fn check() -> i32 {
    respond(|| Ok(crate::check(&request()?)))
}

/// [`crate::compile`].
#[unsafe(no_mangle)]
pub extern "C" fn compile() -> i32 {
    respond(|| Ok(crate::compile(&request()?)))
}

/// The friction map; the answer is numbers, see `map.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn map() -> i32 {
    respond_bytes(|| crate::map::map(&request()?))
}

/// The names of the numbers in answers that are not JSON, in their order: `mapHead`, `frameHead` and `frameColumns`;
/// and `tickHz`, the simulated board's ticks a second.
#[unsafe(no_mangle)]
pub extern "C" fn layouts() -> i32 {
    respond(|| {
        let tick_hz = Board::SIMULATOR.tick_hz;
        Ok(json!({ "mapHead": MAP_HEAD, "frameHead": FRAME_HEAD, "frameColumns": COLUMNS, "tickHz": tick_hz }))
    })
}

/// Constants of perception for the page: `weberStepsPerE`, Weber steps of a change by a factor of e; `weberStep`, a
/// sentence that explains a Weber step; and `offBelowVRms`, the voltage below which the output counts as off.
#[unsafe(no_mangle)]
pub extern "C" fn perception() -> i32 {
    respond(|| {
        let steps_per_e = weber_steps(1.0, std::f64::consts::E);
        let factor = 1.0 + WEBER_FRACTION;
        let step = format!(
            "A Weber step is a factor of {factor:.2}, about the smallest change of friction that a finger feels."
        );
        Ok(json!({ "weberStepsPerE": steps_per_e, "weberStep": step, "offBelowVRms": OFF_BELOW_V_RMS }))
    })
}

/// [`crate::used_files`].
#[unsafe(no_mangle)]
pub extern "C" fn used_files() -> i32 {
    respond(|| crate::used_files(&request()?))
}

/// Checks the input, which is a picture. The answer has `aspect`, its width over its height as it is played.
#[unsafe(no_mangle)]
pub extern "C" fn picture() -> i32 {
    respond(|| {
        let (width, height) = INPUT.with_borrow(|bytes| check_picture(bytes)).map_err(HostError::Picture)?;
        Ok(json!({ "aspect": width as f64 / height as f64 }))
    })
}

/// The values of the input, which is TOML text, and the lines of its layers: see `layer_text.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn read_text() -> i32 {
    respond_bytes(|| Ok(layer_text::read(&line())?.into_bytes()))
}

/// Edits a text (see `layer_text.rs`); the answer is the new text.
#[unsafe(no_mangle)]
pub extern "C" fn edit_text() -> i32 {
    respond_bytes(|| Ok(layer_text::edit(&line())?.into_bytes()))
}

/// The layers that Add and New offer: see `additions.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn additions() -> i32 {
    respond(|| Ok(additions::list()?))
}

/// Initial values of fields by kind, from `additions.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn first_values() -> i32 {
    respond(|| Ok(additions::first_values()))
}

/// The place of a layer, and the changes that move or resize it: see `place.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn place() -> i32 {
    respond(|| Ok(place::place(&line())?))
}

/// Adds a layer to a text: see `additions.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn add_layer() -> i32 {
    respond(|| Ok(additions::add(&line())?))
}

/// [`crate::seeded_hash`], as `hash` in hexadecimal digits.
#[unsafe(no_mangle)]
pub extern "C" fn seeded_hash() -> i32 {
    respond(|| crate::seeded_hash(&request()?).map(|hash| json!({ "hash": format!("{hash:016x}") })))
}

/// Builds the simulator, whose random numbers are drawn from `seed`, in place of the one before.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_start(seed: u32) -> i32 {
    respond(|| {
        SIMULATOR.set(Some(Simulator::new(seed.into())?));
        Ok(())
    })
}

/// Compiles a scene and plays it on the simulator.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_play() -> i32 {
    with_simulator(|simulator| simulator.play(&request()?))
}

/// Stops the simulator.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_stop() -> i32 {
    with_simulator(|simulator| Ok(simulator.stop()?))
}

/// Plays the simulator's scene again after a stop.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_resume() -> i32 {
    with_simulator(|simulator| Ok(simulator.resume()?))
}

/// Carries out a control line, which is the input as text, on the simulator. The answer has `notice`: a sentence on
/// what is clamped from now on, or `null`.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_control() -> i32 {
    with_simulator(|simulator| Ok(json!({ "notice": host::control(simulator.host_mut(), &line())? })))
}

/// Ticks of the simulator since power-on; 0 without one.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_tick() -> f64 {
    SIMULATOR.with_borrow_mut(|simulator| simulator.as_mut().map_or(0.0, |simulator| simulator.tick() as f64))
}

/// Adds a sample of the pointer: the finger is to be at this place, in mm, at this tick. A load of 0 N stands for that
/// of the finger's profile.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_pointer(tick: f64, x_mm: f64, y_mm: f64, is_down: u32, load_n: f64) {
    SIMULATOR.with_borrow_mut(|simulator| {
        if let Some(simulator) = simulator {
            let place_m = [1e-3 * x_mm, 1e-3 * y_mm];
            let normal_load_n = (load_n > 0.0).then_some(load_n);
            simulator.add_pointer_sample(PointerSample { tick, place_m, is_down: is_down != 0, normal_load_n });
        }
    });
}

/// Lifts the finger, and forgets the samples of the pointer that are still ahead.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_lift() {
    SIMULATOR.with_borrow_mut(|simulator| {
        if let Some(simulator) = simulator {
            simulator.pointer_mut().clear();
        }
    });
}

/// Lets so many ticks pass; the host lives in them only if `is_alive` is not 0. The answer is what was felt:
///
/// - 64-bit floats, as `frameHead` of [`layouts`] names them;
/// - 32-bit floats, all samples of one quantity after another, as `frameColumns` names them; then the sound in N, one
///   for each tick.
#[unsafe(no_mangle)]
pub extern "C" fn simulator_run(ticks: u32, is_alive: u32) -> i32 {
    respond_bytes(|| {
        SIMULATOR.with_borrow_mut(|simulator| {
            let simulator = simulator.as_mut().ok_or(HostError::NoBoard)?;
            simulator.run(ticks, is_alive != 0)?;
            Ok(simulator.take_frame())
        })
    })
}

/// Connects to the board at the other end of the stream. Suspends.
///
/// The answer has `driving`, a sentence, and `tickHz`.
#[unsafe(no_mangle)]
pub extern "C" fn host_connect() -> i32 {
    respond(|| {
        HOST.set(None);
        let mut host = host::connect(LinkStream::new())?;
        let tick_hz = host.device().hello().tick_hz;
        host.device_mut().subscribe(telemetry_period_ticks(tick_hz, TELEMETRY_HZ))?;
        let answer = answer::board(host.device().hello());
        HOST.set(Some(host));
        Ok(answer)
    })
}

/// Disconnects, which stops and disarms the board.
#[unsafe(no_mangle)]
pub extern "C" fn host_disconnect() {
    HOST.set(None);
}

/// Compiles a scene for the board and loads it. Suspends.
#[unsafe(no_mangle)]
pub extern "C" fn host_load() -> i32 {
    with_host(|host| host::load(host, &request()?))
}

/// Arms the board and plays the loaded scene. Suspends.
#[unsafe(no_mangle)]
pub extern "C" fn host_play() -> i32 {
    with_host(|host| Ok(host.arm_and_play()?))
}

/// Stops and disarms the board. Suspends.
#[unsafe(no_mangle)]
pub extern "C" fn host_stop() -> i32 {
    with_host(|host| Ok(host.stop()?))
}

/// Clears a latched fault whose cause is gone. Suspends.
#[unsafe(no_mangle)]
pub extern "C" fn host_clear_fault() -> i32 {
    with_host(|host| Ok(host.clear_fault()?))
}

/// Carries out a control line, which is the input as text, as [`simulator_control`] does. Suspends.
#[unsafe(no_mangle)]
pub extern "C" fn host_control() -> i32 {
    with_host(|host| Ok(json!({ "notice": host::control(host, &line())? })))
}

/// Keeps the board alive for some milliseconds. Suspends. The answer has `state`, `fault` and `telemetry`.
#[unsafe(no_mangle)]
pub extern "C" fn host_wait(wait_ms: f64) -> i32 {
    with_host(|host| {
        host.wait(Duration::from_secs_f64(1e-3 * wait_ms.max(0.0)))?;
        let natural_n = host.playing().map_or(0.0, |playing| playing.program().reach.natural_friction_n);
        let messages = std::mem::take(host.recorder_mut());
        let telemetry = messages.iter().map(|message| answer::telemetry(message, natural_n));
        let telemetry: Vec<Value> = telemetry.collect();
        let (state, fault) = host.state();
        let (state, fault) = (state.word(), fault.as_ref().map(Fault::to_string));
        Ok(json!({ "state": state, "fault": fault, "telemetry": telemetry }))
    })
}

/// The word and the sentence of a state and a fault by number, for the simulator's numbers.
#[unsafe(no_mangle)]
pub extern "C" fn state_words(state: u32, fault: u32) -> i32 {
    respond(|| {
        let state = u8::try_from(state).ok().and_then(|state| State::try_from(state).ok());
        let fault = u8::try_from(fault).ok().and_then(|fault| Fault::try_from(fault).ok());
        let (state, fault) = (state.map(State::word), fault.as_ref().map(Fault::to_string));
        Ok(json!({ "state": state, "fault": fault }))
    })
}

fn request() -> Result<Request, HostError> {
    let request = INPUT.with_borrow(|input| Request::parse(input));
    request.map_err(|error| HostError::Program(error.into()))
}

fn line() -> String {
    INPUT.with_borrow(|input| String::from_utf8_lossy(input).into_owned())
}

fn with_simulator<T: Serialize>(act: impl FnOnce(&mut Simulator) -> Result<T, HostError>) -> i32 {
    respond(|| SIMULATOR.with_borrow_mut(|simulator| act(simulator.as_mut().ok_or(HostError::NoBoard)?)))
}

fn with_host<T: Serialize>(act: impl FnOnce(&mut Host<LinkStream>) -> Result<T, HostError>) -> i32 {
    respond(|| HOST.with_borrow_mut(|host| act(host.as_mut().ok_or(HostError::NoBoard)?)))
}

fn respond<T: Serialize>(act: impl FnOnce() -> Result<T, HostError>) -> i32 {
    // Plain numbers and texts always serialize.
    respond_bytes(|| act().map(|answer| serde_json::to_vec(&answer).unwrap_or_default()))
}

fn respond_bytes(act: impl FnOnce() -> Result<Vec<u8>, HostError>) -> i32 {
    let (bytes, code) = match act() {
        Ok(bytes) => (bytes, 0),
        Err(error) => {
            let entry = request().map_or(String::new(), |request| request.entry);
            (answer::error(&error, &entry).to_string().into_bytes(), 1)
        }
    };
    OUTPUT.set(bytes);
    code
}
