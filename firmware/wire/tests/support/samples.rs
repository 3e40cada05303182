//! At least one value of every variant of every message; `golden.rs` checks that the set is complete.

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::{BoardKind, BoardLimits, Core, Hello, ResetCause, notice};
use frixel_wire::message::{
    Accepted, Answer, Command, ConfigField, ConfigRefusal, FromBoard, Refusal, Request, TICK_TIME_CLASSES, Telemetry,
    TickTimes,
};
use frixel_wire::payload::{CHUNK_LEN, CHUNK_NUMBER_MAX, Payload, SAMPLES_MAX};
use frixel_wire::scene::SceneError;

pub const STATES: [State; 4] = [State::Disarmed, State::Armed, State::Active, State::Faulted];

/// All named faults.
pub fn faults() -> impl Iterator<Item = Fault> {
    (1..=9).map(|number| Fault::try_from(number).unwrap())
}

/// Payloads that a host sends.
pub fn from_host() -> Vec<Payload<'static>> {
    static FULL_CHUNK: [u8; CHUNK_LEN] = [0xa5; CHUNK_LEN];
    static FULL_SAMPLES: [[u8; 2]; SAMPLES_MAX] = [[0x5a, 0xa5]; SAMPLES_MAX];
    let sequences = [0, 1, 127, 128, 300, 16_383, 16_384, 65_535].into_iter().cycle();
    let mut payloads = vec![Payload::HelloRequest { protocol: (1, 0) }];
    payloads
        .extend(sequences.zip(commands()).map(|(sequence, command)| Payload::Request(Request { sequence, command })));
    payloads.extend([
        Payload::Chunk { number: 0, bytes: &[0x00] },
        Payload::Chunk { number: 300, bytes: &[0x00, 0x01, 0xff] },
        Payload::Chunk { number: CHUNK_NUMBER_MAX, bytes: &FULL_CHUNK },
        Payload::Samples { first_index: 0, samples: &[[0x00, 0x00]] },
        Payload::Samples { first_index: 70_000, samples: &[[0xff, 0xff], [0x00, 0x80], [0x34, 0x12]] },
        Payload::Samples { first_index: u32::MAX, samples: &FULL_SAMPLES },
        Payload::Request(Request { sequence: 9, command: Command::TickTimes }),
    ]);
    payloads
}

fn commands() -> Vec<Command> {
    vec![
        Command::Ping,
        Command::UploadScene { len: 168, crc32: 0x0123_4567 },
        Command::UploadBitmap { width: 400, height: 267, crc32: 0xcbf4_3926 },
        Command::UploadEnd,
        Command::Commit { crc32: 0x0123_4567 },
        Command::Arm,
        Command::Disarm,
        Command::Play,
        Command::Stop,
        Command::ClearFault,
        Command::Subscribe { period_ticks: 0 },
        Command::Subscribe { period_ticks: 40 },
        Command::Subscribe { period_ticks: u32::MAX },
        Command::Touch { x_m: 0.05, y_m: 0.025, age_ticks: 400 },
        Command::Lift,
        Command::FaultText { offset: 32 },
        Command::SetLayer { layer: 2, on: true, gain: 0.5 },
        Command::SetLayer { layer: 63, on: false, gain: -1.0 },
        Command::StartStream { sample_hz: 8_000, start_level: 320 },
        Command::EndStream,
        Command::TouchFinger { finger: 3, x_m: 0.05, y_m: 0.025, age_ticks: 400 },
        Command::LiftFinger { finger: 3 },
    ]
}

/// Payloads that a board sends.
pub fn from_board() -> Vec<Payload<'static>> {
    let mut payloads: Vec<_> = hellos().into_iter().map(Payload::Hello).collect();
    payloads.extend(messages().into_iter().map(Payload::FromBoard));
    payloads
}

pub fn hello() -> Hello {
    Hello {
        protocol: (1, 0),
        firmware: (0, 1, 0),
        board: BoardKind::Simulator,
        id: *b"frixel sim 1",
        tick_hz: 40_000,
        frame_max_len: FRAME_MAX_LEN as u16,
        features: 0,
        scene_crc32: 0,
        reset_cause: ResetCause::PowerOn,
        last_fault: None,
        fault_detail: 0,
        state: State::Disarmed,
        limits: BoardLimits {
            bitmap_pool_bytes: 80 * 1024,
            records_max: 16,
            receive_window_bytes: 4096,
            voltage_max_v_peak: 200.0,
            full_scale_v_peak: 250.0,
            edge_time_constant_s: 20e-6,
            electrode_capacitance_max_f: 10e-9,
            current_max_a_rms: 0.005,
            current_max_a_peak: 0.1,
            touch_report_period_s: 0.01,
            tick_cycles_max: 2_000,
            series_resistance_ohm: 68e3,
            core: Core::CortexM4f,
        },
        notices: 0,
    }
}

fn hellos() -> Vec<Hello> {
    let mut hellos = vec![hello()];
    hellos.extend((2..=6).map(|number| Hello { board: BoardKind::from(number), ..hello() }));
    let core = Core::CortexM0Plus;
    hellos.push(Hello { limits: BoardLimits { core, ..hello().limits }, ..hello() });
    hellos.extend((2..=6).map(|number| Hello { reset_cause: ResetCause::from(number), ..hello() }));
    hellos.extend(faults().map(|fault| Hello { last_fault: Some(fault), fault_detail: 0x0a0b_0c0d, ..hello() }));
    hellos.extend(STATES.map(|state| Hello { state, scene_crc32: 0xcbf4_3926, ..hello() }));
    hellos.extend(notice::SENTENCES.map(|(notices, _)| Hello { notices, ..hello() }));
    hellos
}

fn messages() -> Vec<FromBoard> {
    let mut messages: Vec<_> = outcomes()
        .into_iter()
        .zip(1..)
        .map(|(outcome, sequence)| {
            FromBoard::Answer(Answer {
                sequence,
                received_bytes: 1_000 * u32::from(sequence),
                state: State::Armed,
                outcome,
            })
        })
        .collect();
    messages.extend([
        FromBoard::Answer(Answer {
            sequence: u16::MAX,
            received_bytes: u32::MAX,
            state: State::Faulted,
            outcome: Ok(Accepted::Done),
        }),
        FromBoard::Progress { next_chunk: 0, received_bytes: 0 },
        FromBoard::Progress { next_chunk: CHUNK_NUMBER_MAX, received_bytes: u32::MAX },
    ]);
    messages.extend([
        FromBoard::StreamProgress { next_index: 0, room: 1024, underruns: 0, gaps: 0, received_bytes: 40 },
        FromBoard::StreamProgress { next_index: 70_000, room: 300, underruns: 2, gaps: 130, received_bytes: u32::MAX },
    ]);
    messages.extend(STATES.map(|state| FromBoard::Telemetry(telemetry(state))));
    messages.push(FromBoard::StateChanged { state: State::Disarmed, fault: None, flags: Flags::HOST_SILENT });
    messages.extend(faults().map(|fault| FromBoard::StateChanged {
        state: State::Faulted,
        fault: Some(fault),
        flags: Flags::default(),
    }));
    messages.push(FromBoard::Answer(Answer {
        sequence: 200,
        received_bytes: 200_000,
        state: State::Armed,
        outcome: Err(Refusal::Config(config_refusal(ConfigField::ElectricFrictionMax, ConfigRefusal::WHOLE_SCENE))),
    }));
    let measured = TickTimes {
        deadline_cycles: 3_700,
        worst_cycles: 2_131,
        missed_deadlines: 2,
        histogram: [0, 127, 128, 39_600, 300, 0, 0, 0, 1],
    };
    let longest = TickTimes {
        deadline_cycles: u32::MAX,
        worst_cycles: u32::MAX,
        missed_deadlines: u32::MAX,
        histogram: [u32::MAX; TICK_TIME_CLASSES + 1],
    };
    messages.extend([TickTimes::default(), measured, longest].map(|times| {
        FromBoard::Answer(Answer {
            sequence: 9,
            received_bytes: 1_055,
            state: State::Disarmed,
            outcome: Ok(Accepted::TickTimes(times)),
        })
    }));
    messages.extend([ConfigField::LawExponent, ConfigField::LawPoint, ConfigField::LawFriction].map(|field| {
        FromBoard::Answer(Answer {
            sequence: 201,
            received_bytes: 200_001,
            state: State::Armed,
            outcome: Err(Refusal::Config(config_refusal(field, ConfigRefusal::WHOLE_SCENE))),
        })
    }));
    messages
}

fn telemetry(state: State) -> Telemetry {
    Telemetry {
        tick: 1_234_567,
        state,
        flags: Flags::SATURATED.with(Flags::STILL),
        finger_x_m: 0.05,
        finger_y_m: 0.025,
        speed_m_per_s: 0.1,
        commanded_electric_friction_n: 0.012,
        voltage_v_rms: 75.5,
        dac_code: -9_895 + 64 * i16::from(state.number()),
    }
}

fn outcomes() -> Vec<Result<Accepted, Refusal>> {
    let mut outcomes = vec![Ok(Accepted::Done), Ok(Accepted::AlreadyHeld)];
    outcomes.extend(refusals().into_iter().map(Err));
    outcomes.push(Ok(Accepted::FaultText { len: 32, bytes: *b"panicked at firmware/render/src/" }));
    outcomes.push(Ok(Accepted::FaultText { len: 0, bytes: [0; 32] }));
    outcomes
}

pub fn refusals() -> Vec<Refusal> {
    let mut refusals = vec![Refusal::UnknownCommand];
    refusals.extend(STATES.map(Refusal::WrongState));
    refusals.extend(faults().map(Refusal::Faulted));
    refusals.extend([
        Refusal::NoScene,
        Refusal::UploadIncomplete { next_chunk: 300 },
        Refusal::CrcMismatch { expected: 0x0123_4567, found: 0xcbf4_3926 },
        Refusal::SceneTooLarge { len: 3_640, max: 952 },
        Refusal::BitmapPoolFull { len: 106_800, free: 81_920 },
        Refusal::BitmapMissing { crc32: 0xcbf4_3926 },
    ]);
    refusals.extend(scene_errors().map(Refusal::Scene));
    refusals.extend(config_fields().zip(0..).map(|(field, layer)| Refusal::Config(config_refusal(field, layer))));
    refusals.extend([
        Refusal::Config(config_refusal(ConfigField::VoltagePeak, ConfigRefusal::WHOLE_SCENE)),
        Refusal::Busy,
        Refusal::TelemetryTooFast { period_min_ticks: 40 },
        Refusal::ArmSwitch,
        Refusal::FeatureDisabled { layer: 2 },
        Refusal::FeatureDisabled { layer: ConfigRefusal::WHOLE_SCENE },
        Refusal::TouchSource,
        Refusal::NoSuchLayer { layer: 9, layers: 4 },
        Refusal::NoStreamLayer,
        Refusal::TooCostly { cycles: 812, cycles_max: 600, x_m: 0.0125, y_m: 0.25 },
        Refusal::LayersFixed,
        Refusal::OptionBytes,
    ]);
    refusals
}

pub fn config_refusal(field: ConfigField, layer: u8) -> ConfigRefusal {
    ConfigRefusal { field, found: 250.5, min: 0.125, max: 50.0, layer }
}

pub fn scene_errors() -> [SceneError; 12] {
    [
        SceneError::Version { found: 1 },
        SceneError::Length { found: 111, expected: 168 },
        SceneError::UnknownCarrier(7),
        SceneError::UnknownKind { record: 3, kind: 9 },
        SceneError::UnknownChoice { record: 3, offset: 2, value: 8 },
        SceneError::TooManyRecords { found: 65 },
        SceneError::UnknownFlags(0x84),
        SceneError::NotZero { record: 3, offset: 44 },
        SceneError::NotZero { record: SceneError::HEADER, offset: 54 },
        SceneError::TooManyPoints { found: 129 },
        SceneError::Points { record: 3, first: 120, count: 9 },
        SceneError::ButtonRegion { record: 3 },
    ]
}

/// The first quantities, in the order of their numbers; the others follow in samples of their own.
fn config_fields() -> impl Iterator<Item = ConfigField> {
    (0..34).map(|number: u8| postcard::from_bytes(&[number]).unwrap())
}
