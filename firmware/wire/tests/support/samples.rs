//! At least one value of every variant of everything that goes over the wire. `golden.rs` says so.

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::{BoardKind, BoardLimits, Hello, ResetCause};
use frixel_wire::message::{
    Accepted, Answer, Command, ConfigField, ConfigRefusal, FromBoard, Refusal, Request, Telemetry,
};
use frixel_wire::payload::{CHUNK_LEN, CHUNK_NUMBER_MAX, Payload, SAMPLES_MAX};
use frixel_wire::scene::{
    Beat, Blend, Burst, Carrier, Click, Header, Layer, Leader, Point, Record, Region, SceneError, Wave,
};

pub const STATES: [State; 4] = [State::Disarmed, State::Armed, State::Active, State::Faulted];

/// All faults that have a name, and one that has none yet.
pub fn faults() -> impl Iterator<Item = Fault> {
    (1..=9).map(|number| Fault::try_from(number).unwrap())
}

/// What a host sends.
pub fn from_host() -> Vec<Payload<'static>> {
    static FULL_CHUNK: [u8; CHUNK_LEN] = [0xa5; CHUNK_LEN];
    static FULL_SAMPLES: [[u8; 2]; SAMPLES_MAX] = [[0x5a, 0xa5]; SAMPLES_MAX];
    let sequences = [0, 1, 127, 128, 300, 16_383, 16_384, 65_535].into_iter().cycle();
    let mut payloads = vec![Payload::HelloRequest { protocol: (1, 2) }];
    payloads
        .extend(sequences.zip(commands()).map(|(sequence, command)| Payload::Request(Request { sequence, command })));
    payloads.extend([
        Payload::Chunk { number: 0, bytes: &[0x00] },
        Payload::Chunk { number: 300, bytes: &[0x00, 0x01, 0xff] },
        Payload::Chunk { number: CHUNK_NUMBER_MAX, bytes: &FULL_CHUNK },
        Payload::Samples { first_index: 0, samples: &[[0x00, 0x00]] },
        Payload::Samples { first_index: 70_000, samples: &[[0xff, 0xff], [0x00, 0x80], [0x34, 0x12]] },
        Payload::Samples { first_index: u32::MAX, samples: &FULL_SAMPLES },
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

/// What a board sends.
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
        },
    }
}

fn hellos() -> Vec<Hello> {
    let mut hellos = vec![hello()];
    hellos.extend((2..=4).map(|number| Hello { board: BoardKind::from(number), ..hello() }));
    hellos.extend((2..=6).map(|number| Hello { reset_cause: ResetCause::from(number), ..hello() }));
    hellos.extend(faults().map(|fault| Hello { last_fault: Some(fault), fault_detail: 0x0a0b_0c0d, ..hello() }));
    hellos.extend(STATES.map(|state| Hello { state, scene_crc32: 0xcbf4_3926, ..hello() }));
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
        asked_electric_friction_n: 0.012,
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
    refusals.extend(
        config_fields().into_iter().zip(0..).map(|(field, layer)| Refusal::Config(config_refusal(field, layer))),
    );
    refusals.extend([
        Refusal::Config(config_refusal(ConfigField::VoltagePeak, ConfigRefusal::WHOLE_SCENE)),
        Refusal::Busy,
        Refusal::TelemetryTooFast { period_min_ticks: 40 },
        Refusal::ArmSwitch,
        Refusal::LeftOut { layer: 2 },
        Refusal::LeftOut { layer: ConfigRefusal::WHOLE_SCENE },
        Refusal::TouchSource,
        Refusal::NoSuchLayer { layer: 9, layers: 4 },
        Refusal::NoStreamLayer,
        Refusal::TooCostly { instructions: 812, max: 600, x_m: 0.0125, y_m: 0.25 },
        Refusal::LayersFixed,
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

pub fn config_fields() -> Vec<ConfigField> {
    use ConfigField::{
        Angle, BitmapPlacement, CarrierFrequency, ClickLayers, CurrentPeak, CurrentRms, CurveSpeed, Duration, Duty,
        EffectiveGap, FingerRadius, Friction, FrictionCoefficient, Gain, HostTimeout, NoiseLayers, NormalLoad, Phase,
        Region, SampleRate, ScreenHeight, ScreenWidth, Shape, Slew, StartLevel, Stiffness, TableRange, TouchPlace,
        Vertex, VibrationFrequency, VoltagePeak, VoltageRms, WaveVector, Wavelength,
    };
    vec![
        ScreenWidth,
        ScreenHeight,
        FingerRadius,
        Stiffness,
        FrictionCoefficient,
        NormalLoad,
        EffectiveGap,
        VoltageRms,
        VoltagePeak,
        Slew,
        CarrierFrequency,
        HostTimeout,
        CurrentRms,
        CurrentPeak,
        Region,
        Gain,
        Friction,
        WaveVector,
        Phase,
        BitmapPlacement,
        TableRange,
        TouchPlace,
        SampleRate,
        StartLevel,
        Duty,
        Angle,
        Wavelength,
        Shape,
        VibrationFrequency,
        Duration,
        Vertex,
        CurveSpeed,
        NoiseLayers,
        ClickLayers,
    ]
}

pub fn header() -> Header {
    Header {
        screen_width_m: 0.1,
        screen_height_m: 0.0625,
        finger_radius_m: 0.008,
        stiffness_pa_per_m: 1e8,
        friction_coefficient: 0.5,
        normal_load_n: 0.5,
        effective_gap_m: 250e-9,
        voltage_max_v_rms: 150.0,
        voltage_max_v_peak: 160.0,
        slew_v_per_s: 100_000.0,
        carrier_hz: 1_000.0,
        host_timeout_s: 0.25,
        carrier: Carrier::Square,
        autonomous: false,
        prediction: true,
        leader: Leader::First,
        layers_fixed: false,
    }
}

pub fn headers() -> Vec<Header> {
    vec![
        header(),
        Header { carrier: Carrier::Sine, prediction: false, ..header() },
        Header { autonomous: true, ..header() },
        Header { leader: Leader::Latest, ..header() },
        Header { layers_fixed: true, ..header() },
    ]
}

pub fn records() -> Vec<Record> {
    let rectangle = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };
    let ellipse = Region::Ellipse { x_m: 0.02, y_m: 0.01, width_m: 0.04, height_m: 0.03 };
    let polygon = Region::Polygon { first: 1, count: 3 };
    let grating = |wave| Layer::Grating {
        wave,
        cycles_per_m_x: 500.0,
        cycles_per_m_y: -250.0,
        phase_turns: 0.25,
        trough_n: 0.002,
        crest_n: 0.02,
    };
    let bitmap = |tiled, angle_turns| Layer::Bitmap {
        crc32: 0xcbf4_3926,
        x_m: 0.001,
        y_m: 0.002,
        pitch_m: 0.00025,
        black_n: 0.0,
        white_n: 0.025,
        pitch_y_m: 0.0003,
        angle_turns,
        tiled,
    };
    let click = Click { height_n: 0.015, decay_s: 0.02 };
    let edge =
        Layer::Edge { x_m: 0.05, y_m: 0.04, angle_turns: 0.125, width_m: 0.004, level_n: 0.001, ridge_n: 0.02, click };
    let vibration = |beat, burst| Layer::Vibration { beat, frequency_hz: 80.0, low_n: 0.001, high_n: 0.02, burst };
    let burst = Burst { period_s: 0.5, on_s: 0.25, ramp_s: 0.0625 };
    let layers = [
        (Region::Screen, Blend::Replace, 1.0, Layer::Constant { electric_friction_n: 0.01 }),
        (rectangle, Blend::Add, 0.5, grating(Wave::Sine)),
        (Region::Screen, Blend::Add, -1.0, grating(Wave::Square { duty: 0.25 })),
        (rectangle, Blend::Replace, 2.0, bitmap(false, 0.0)),
        (ellipse, Blend::Multiply, 1.0, grating(Wave::Triangle)),
        (polygon, Blend::Max, 1.0, grating(Wave::Saw)),
        (Region::Screen, Blend::Add, 1.0, bitmap(true, 0.125)),
        (
            Region::Screen,
            Blend::Add,
            1.0,
            Layer::Noise {
                seed: 0x0123_4567,
                wavelength_min_m: 0.001,
                wavelength_max_m: 0.004,
                low_n: 0.002,
                high_n: 0.02,
            },
        ),
        (polygon, Blend::Add, 1.0, edge),
        (ellipse, Blend::Replace, 1.0, Layer::Button { rim_width_m: 0.002, rim_n: 0.02, face_n: 0.005, click }),
        (Region::Screen, Blend::Max, 1.0, vibration(Beat::Sine, Burst::default())),
        (Region::Screen, Blend::Add, 1.0, vibration(Beat::Square, burst)),
        (Region::Screen, Blend::Multiply, 1.0, Layer::Speed { first: 0, count: 2 }),
        (rectangle, Blend::Replace, 1.0, Layer::Stream { low_n: 0.002, high_n: 0.02 }),
    ];
    layers.map(|(region, blend, gain, layer)| Record { region, blend, gain, layer }).to_vec()
}

pub fn points() -> Vec<Point> {
    [(0.0, 0.5), (0.0625, 0.03125), (0.09, 0.0625), (0.05, 0.0625)].map(|(x, y)| Point { x, y }).to_vec()
}

/// A whole scene of [`header`], [`records`] and [`points`].
pub fn scene() -> Vec<u8> {
    let (records, points) = (records(), points());
    let mut bytes = header().write(records.len() as u8, points.len() as u8).to_vec();
    bytes.extend(records.iter().flat_map(Record::write));
    bytes.extend(points.iter().flat_map(Point::write));
    bytes
}
