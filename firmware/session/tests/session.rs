//! The commands of a host, and the board's answers.

#[cfg(feature = "bitmap")]
use crate::support::bitmap;
use crate::support::{COMMIT_POLLS_MAX, HEADER, TestBoard, constant, constant_scene, record, request, scene};
use frixel_control::{Board, Order};
use frixel_layers::{Constant, HEADER_LEN, Header, Layer, RECORD_LEN};
#[cfg(feature = "bitmap")]
use frixel_layers::{Record, Region};
use frixel_session::Touch;
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::crc32;
use frixel_wire::hello::{BoardLimits, feature};
#[cfg(feature = "telemetry")]
use frixel_wire::message::TickTimes;
use frixel_wire::message::{Accepted, Command, ConfigField, FromBoard, Refusal};
use frixel_wire::payload::CHUNK_LEN;
#[cfg(feature = "bitmap")]
use frixel_wire::scene::bitmap_crc32;
use frixel_wire::scene::{RECORDS_MAX, SceneError};
use proptest::prelude::*;

#[test]
fn a_scene_is_used_whole_or_not_at_all() {
    let mut board = TestBoard::connected();
    let first = constant_scene(0.01);
    board.load(&first).unwrap();

    let mut second = constant_scene(0.02);
    second.resize(second.len() * 4, 0);
    board.command(Command::UploadScene { len: second.len() as u32, crc32: crc32(&second) }).unwrap();
    board.chunk(0, &second[..CHUNK_LEN]);
    assert_eq!(
        board.command(Command::Commit { crc32: crc32(&second) }),
        Err(Refusal::UploadIncomplete { next_chunk: 1 })
    );
    assert_eq!(board.command(Command::UploadEnd), Err(Refusal::UploadIncomplete { next_chunk: 1 }));
    assert_eq!(board.hello().scene_crc32, crc32(&first));
}

#[cfg(feature = "bitmap")]
#[test]
fn chunks_may_repeat_and_a_gap_is_reported_once() {
    let mut board = TestBoard::connected();
    let samples: Vec<u8> = (0..1000_u32).map(|i| (i * 7) as u8).collect();
    board.command(Command::UploadBitmap { width: 100, height: 10, crc32: bitmap_crc32(100, 10, &samples) }).unwrap();
    let chunks: Vec<&[u8]> = samples.chunks(CHUNK_LEN).collect();
    board.chunk(0, chunks[0]);
    board.chunk(0, chunks[0]);
    board.chunk(2, chunks[2]);
    board.chunk(3, chunks[3]);
    let gaps: Vec<FromBoard> = board.messages.drain(..).collect();
    assert!(matches!(gaps[..], [FromBoard::Progress { next_chunk: 1, .. }]), "{gaps:?}");
    for (number, chunk) in chunks.iter().enumerate().skip(1) {
        board.chunk(number as u16, chunk);
    }
    assert_eq!(board.command(Command::UploadEnd), Ok(Accepted::Done));
    assert_eq!(board.upload_bitmap(100, 10, &samples), Ok(Accepted::AlreadyHeld));
}

#[cfg(feature = "bitmap")]
#[test]
fn a_bitmap_with_a_wrong_byte_is_refused_and_forgotten() {
    let mut board = TestBoard::connected();
    let samples = vec![3; 400];
    let expected = bitmap_crc32(20, 20, &samples);
    board.command(Command::UploadBitmap { width: 20, height: 20, crc32: expected }).unwrap();
    let mut wrong = samples.clone();
    wrong[200] ^= 1;
    board.chunks(&wrong);
    let found = bitmap_crc32(20, 20, &wrong);
    assert_eq!(board.command(Command::UploadEnd), Err(Refusal::CrcMismatch { expected, found }));
    assert_eq!(board.upload_bitmap(20, 20, &samples), Ok(Accepted::Done), "not already held");
}

#[cfg(feature = "bitmap")]
#[test]
fn the_pool_keeps_playing_bitmaps_and_evicts_them_when_nothing_plays() {
    let mut board = TestBoard::connected();
    let first = vec![1; 250 * 250];
    let second = vec![2; 250 * 250];
    board.upload_bitmap(250, 250, &first).unwrap();
    board.play(&scene(&HEADER, &[record(bitmap(bitmap_crc32(250, 250, &first)))]));
    let full = board.upload_bitmap(250, 250, &second);
    assert_eq!(full, Err(Refusal::BitmapPoolFull { len: 62_500, free: 65_536 - 62_500 }));
    board.command(Command::Stop).unwrap();
    assert_eq!(board.upload_bitmap(250, 250, &second), Ok(Accepted::Done));
    assert_eq!(board.command(Command::Play), Err(Refusal::NoScene), "its bitmap is overwritten");
    assert_eq!(
        board.load(&scene(&HEADER, &[record(bitmap(bitmap_crc32(250, 250, &first)))])),
        Err(Refusal::BitmapMissing { crc32: bitmap_crc32(250, 250, &first) })
    );
    board.load(&scene(&HEADER, &[record(bitmap(bitmap_crc32(250, 250, &second)))])).unwrap();
}

/// `frixel-layers` tests the ranges of all numbers of header and records.
#[test]
fn numbers_out_of_range_are_refused_by_name() {
    for (header, friction_n, expected) in [
        (Header { finger_radius_m: f32::NAN, ..HEADER }, 0.01, ConfigField::FingerRadius),
        (Header { carrier_hz: 5_000.0, ..HEADER }, 0.01, ConfigField::CurrentRms),
        (HEADER, f32::NAN, ConfigField::Friction),
    ] {
        let refused = TestBoard::connected().load(&scene(&header, &[constant(friction_n)]));
        assert!(matches!(refused, Err(Refusal::Config(refusal)) if refusal.field == expected), "{refused:?}");
    }
}

/// The touch bound for a person without a coating, at each carrier frequency of the board: 68 kOhm allow 28.6 V peak at
/// 125 Hz, 43.8 V at 1 kHz and 65.6 V at 5 kHz (`frixel_model::TouchBound`).
#[test]
fn a_peak_above_the_touch_bound_is_refused_at_every_carrier() {
    let limits = BoardLimits { series_resistance_ohm: 68e3, current_max_a_rms: 1.0, ..Board::SIMULATOR.limits };
    let mut board = TestBoard::of(Board { limits, ..Board::SIMULATOR });
    board.hello();
    // The bound is that of the carrier in whole ticks: 4.4 kHz is played as 4 kHz, whose bound is lower.
    for (carrier_hz, bound_v_peak) in
        [(125.0, 28.688), (250.0, 30.855), (1_000.0, 43.86), (4_400.0, 60.18), (5_000.0, 65.62)]
    {
        for (voltage_max_v_peak, is_taken) in [(bound_v_peak - 0.01, true), (bound_v_peak + 0.01, false)] {
            // The rms limit does not matter: the carrier bounds its volt-seconds by the peak.
            let header = Header { carrier_hz, voltage_max_v_peak, voltage_max_v_rms: 20.0, ..HEADER };
            let answer = board.load(&scene(&header, &[constant(0.001)]));
            match answer {
                Ok(_) => assert!(is_taken, "{voltage_max_v_peak} V at {carrier_hz} Hz"),
                Err(Refusal::Config(refusal)) => {
                    assert!(!is_taken && refusal.field == ConfigField::VoltagePeak, "{refusal}");
                    assert!((refusal.max - bound_v_peak).abs() < 1e-3, "{refusal}");
                }
                Err(other) => panic!("{other:?}"),
            }
        }
    }
}

/// `00 00 00 80` is a zero, as `PROTOCOL.md` states.
#[test]
fn minus_zero_is_a_zero() {
    let mut board = TestBoard::connected();
    let fine = Layer::Constant(Constant { electric_friction_n: 0.01 });
    let load = |board: &mut TestBoard, header: &Header, layer| board.load(&scene(header, &[record(layer)]));
    assert_eq!(load(&mut board, &Header { normal_load_n: -0.0, ..HEADER }, fine).err(), None);
    let minus = Layer::Constant(Constant { electric_friction_n: -0.0 });
    assert_eq!(load(&mut board, &HEADER, minus).err(), None);
    let refused = load(&mut board, &Header { friction_coefficient: -0.0, ..HEADER }, fine);
    assert!(matches!(refused, Err(Refusal::Config(refusal)) if refusal.field == ConfigField::FrictionCoefficient));
}

#[test]
fn bytes_that_are_not_a_scene_are_refused() {
    let mut board = TestBoard::connected();
    let mut unknown = constant_scene(0.01);
    unknown[56] = 99;
    assert_eq!(board.load(&unknown), Err(Refusal::Scene(SceneError::UnknownKind { record: 0, kind: 99 })));
    assert!(matches!(
        board.command(Command::UploadScene { len: 1 << 20, crc32: 0 }),
        Err(Refusal::SceneTooLarge { len: 1_048_576, max: 4792 })
    ));
    assert_eq!(
        board.command(Command::Commit { crc32: 1 }),
        Err(Refusal::CrcMismatch { expected: 1, found: crc32(&unknown) })
    );
}

/// A scene with few points and many records is no longer, in bytes, than an accepted one with many points.
#[test]
fn a_scene_with_more_records_than_the_boards_limit_is_refused() {
    let mut board = Board::SIMULATOR;
    board.limits.records_max = 2;
    let mut board = TestBoard::of(board);
    board.hello();
    board.load(&scene(&HEADER, &[constant(0.01); 2])).unwrap();
    let refused = Err(Refusal::Scene(SceneError::TooManyRecords { found: 3 }));
    assert_eq!(board.load(&scene(&HEADER, &[constant(0.01); 3])), refused);
}

/// A commit checks the records in several steps.
#[test]
fn a_scene_is_refused_for_any_malformed_record() {
    let mut board = TestBoard::connected();
    let records = [constant(0.01); RECORDS_MAX];
    for record in [0, 15, 16, 40, RECORDS_MAX - 1] {
        let mut bytes = scene(&HEADER, &records);
        bytes[HEADER_LEN + (record + 1) * RECORD_LEN - 1] = 1;
        let offset = RECORD_LEN as u8 - 1;
        let refusal = Refusal::Scene(SceneError::NotZero { record: record as u8, offset });
        assert_eq!(board.load(&bytes), Err(refusal));
    }
}

fn answered(board: &mut TestBoard) -> Vec<u16> {
    board.answers().into_iter().map(|(sequence, _)| sequence).collect()
}

/// Signs of life, stops and disarms do not wait for a commit.
#[test]
fn a_commit_delays_no_sign_of_life_and_no_stop() {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.01));
    let next = constant_scene(0.015);
    board.upload_scene(&next).unwrap();
    board.messages.clear();
    let bytes = [
        request(901, Command::Commit { crc32: crc32(&next) }),
        request(902, Command::Ping),
        request(903, Command::Stop),
        request(904, Command::Disarm),
    ];
    board.session.receive(&bytes.concat(), &board.status());
    assert_eq!(answered(&mut board), [902, 903, 904]);
    let mut orders = 0;
    while let Some(order) = board.session.next_order() {
        assert!(matches!(order, Order::Stop | Order::Disarm));
        board.ticker.apply(order);
        orders += 1;
    }
    assert_eq!(orders, 2, "each is a sign of life");
    let committed = (0..COMMIT_POLLS_MAX).any(|_| {
        board.session.poll(&board.status());
        answered(&mut board) == [901]
    });
    assert!(committed);
    board.deliver_orders();
    assert_eq!(board.hello().scene_crc32, crc32(&next));
}

/// A board with a scene that was uploaded and is not committed.
fn with_uploaded_scene(scene: &[u8]) -> TestBoard {
    let mut board = TestBoard::connected();
    board.upload_scene(scene).unwrap();
    board.messages.clear();
    board
}

#[test]
fn requests_that_depend_on_a_commit_are_carried_out_after_it_in_order() {
    let scene = constant_scene(0.01);
    let mut board = with_uploaded_scene(&scene);
    let bytes = [
        request(901, Command::Commit { crc32: crc32(&scene) }),
        request(902, Command::Arm),
        request(903, Command::Play),
        request(904, Command::FaultText { offset: 0 }),
    ];
    board.session.receive(&bytes.concat(), &board.status());
    assert_eq!(answered(&mut board), [904], "it depends on no commit");
    let mut sequences = Vec::new();
    for _ in 0..COMMIT_POLLS_MAX {
        board.tick();
        sequences.extend(answered(&mut board));
    }
    assert_eq!(sequences, [901, 902, 903]);
    assert_eq!(board.status().telemetry.state, State::Active);
}

#[test]
fn a_stop_or_disarm_refuses_requests_that_wait_for_a_commit() {
    for last in [Command::Stop, Command::Disarm] {
        let scene = constant_scene(0.01);
        let mut board = with_uploaded_scene(&scene);
        board.command(Command::Arm).unwrap();
        let bytes = [
            request(901, Command::Commit { crc32: crc32(&scene) }),
            request(902, Command::Play),
            request(903, Command::Commit { crc32: crc32(&scene) }),
            request(904, last),
        ];
        board.session.receive(&bytes.concat(), &board.status());
        board.collect();
        let refused = [902, 903].map(|sequence| board.take_answer(sequence).unwrap().outcome);
        assert_eq!(refused, [Err(Refusal::Busy); 2]);
        let state_after = if last == Command::Stop { State::Armed } else { State::Disarmed };
        assert_eq!(board.take_answer(904).unwrap().state, state_after);
        board.ticks(COMMIT_POLLS_MAX);
        assert_eq!(board.take_answer(901).unwrap().outcome, Ok(Accepted::Done), "the commit goes on");
        assert_eq!(board.status().telemetry.state, state_after);
    }
}

#[test]
fn a_board_that_stops_by_itself_refuses_the_requests_that_wait_for_a_commit() {
    let scene = constant_scene(0.01);
    let mut board = with_uploaded_scene(&scene);
    board.command(Command::Arm).unwrap();
    let bytes = [request(901, Command::Commit { crc32: crc32(&scene) }), request(902, Command::Play)];
    board.session.receive(&bytes.concat(), &board.status());
    board.sense.amplifier_fault = true;
    board.ticks(2);
    assert_eq!(board.status().telemetry.state, State::Faulted);
    assert_eq!(board.take_answer(902).unwrap().outcome, Err(Refusal::Busy));
    board.sense.amplifier_fault = false;
    board.ticks(COMMIT_POLLS_MAX);
    assert_eq!(board.status().telemetry.state, State::Faulted, "nothing that was sent before clears it");
}

#[test]
fn eight_requests_wait_for_a_commit_and_further_ones_are_refused() {
    let scene = constant_scene(0.01);
    let mut board = with_uploaded_scene(&scene);
    board.session.receive(&request(901, Command::Commit { crc32: crc32(&scene) }), &board.status());
    for sequence in 902..912 {
        board.session.receive(&request(sequence, Command::EndStream), &board.status());
    }
    assert_eq!(answered(&mut board), [910, 911]);
    let mut sequences = Vec::new();
    for _ in 0..COMMIT_POLLS_MAX {
        board.tick();
        sequences.extend(answered(&mut board));
    }
    assert_eq!(sequences, (901..910).collect::<Vec<_>>());
}

#[test]
fn a_hello_drops_a_commit_and_its_waiting_requests() {
    let scene = constant_scene(0.01);
    let mut board = with_uploaded_scene(&scene);
    let commit = request(901, Command::Commit { crc32: crc32(&scene) });
    let bytes = [commit.clone(), request(902, Command::Arm)].concat();
    board.session.receive(&bytes, &board.status());
    board.tick();
    let hello = board.hello();
    assert_eq!((hello.scene_crc32, hello.state), (0, State::Disarmed));
    board.ticks(COMMIT_POLLS_MAX);
    assert!(answered(&mut board).is_empty(), "the client that sent them is gone");
    assert_eq!(board.hello().scene_crc32, 0);
    board.command(Command::Commit { crc32: crc32(&scene) }).unwrap();
    assert_eq!(board.hello().scene_crc32, crc32(&scene));
}

#[cfg(feature = "telemetry")]
#[test]
fn telemetry_comes_at_its_period_and_ends() {
    let mut board = TestBoard::connected();
    assert!(matches!(
        board.command(Command::Subscribe { period_ticks: 39 }),
        Err(Refusal::TelemetryTooFast { period_min_ticks: 40 })
    ));
    board.command(Command::Subscribe { period_ticks: 40 }).unwrap();
    board.ticks(400);
    let count = board.messages.iter().filter(|m| matches!(m, FromBoard::Telemetry(_))).count();
    assert_eq!(count, 10);
    board.command(Command::Subscribe { period_ticks: 0 }).unwrap();
    board.messages.clear();
    board.ticks(400);
    assert!(board.messages.is_empty());
}

#[test]
fn orders_that_zero_the_output_always_have_room() {
    let mut board = TestBoard::connected();
    board.load(&constant_scene(0.01)).unwrap();
    // All in one call, before the ticker has run.
    let mut bytes = Vec::new();
    let commands = [Command::Arm, Command::Play, Command::Stop, Command::Play, Command::Stop, Command::Play];
    for (sequence, command) in
        commands.into_iter().cycle().take(40).chain([Command::Disarm, Command::Disarm]).enumerate()
    {
        bytes.extend(request(900 + sequence as u16, command));
    }
    board.send(&bytes);
    let refused = board.messages.iter().filter(
        |message| matches!(message, FromBoard::Answer(answer) if answer.sequence >= 940 && answer.outcome.is_err()),
    );
    assert_eq!(refused.count(), 0, "{:?}", board.messages);
    board.touch = Some(Touch::Down { x_m: 0.05, y_m: 0.05, age_ticks: 0 });
    assert_eq!(board.tick(), frixel_control::Drive::default());
    assert_eq!(board.status().telemetry.state, State::Disarmed);
}

#[cfg(feature = "bitmap")]
#[test]
fn the_same_bytes_in_another_shape_are_another_bitmap() {
    let mut board = TestBoard::connected();
    let samples = vec![7; 800];
    assert_eq!(board.upload_bitmap(40, 20, &samples), Ok(Accepted::Done));
    assert_eq!(board.upload_bitmap(20, 40, &samples), Ok(Accepted::Done));
    assert_eq!(board.upload_bitmap(40, 20, &samples), Ok(Accepted::AlreadyHeld));
}

/// Two pictures side by side. Overlapping, they would be too costly.
#[cfg(feature = "bitmap")]
fn side_by_side([left, right]: [u32; 2]) -> [Record; 2] {
    let beside = |x_m, crc32| {
        let region = Region::Rectangle { x_m, y_m: 0.0, width_m: 0.04, height_m: 0.1 };
        Record { region, ..record(bitmap(crc32)) }
    };
    [beside(0.0, left), beside(0.06, right)]
}

#[cfg(feature = "bitmap")]
#[test]
fn fragmented_free_space_is_compacted_when_nothing_plays() {
    let mut board = TestBoard::connected();
    let (first, second, third) = (vec![1; 30_000], vec![2; 30_000], vec![3; 33_000]);
    board.upload_bitmap(300, 100, &first).unwrap();
    board.upload_bitmap(300, 100, &second).unwrap();
    let both = side_by_side([bitmap_crc32(300, 100, &first), bitmap_crc32(300, 100, &second)]);
    board.load(&scene(&HEADER, &both)).unwrap();
    assert_eq!(board.upload_bitmap(300, 100, &second), Ok(Accepted::AlreadyHeld));
    assert_eq!(board.upload_bitmap(330, 100, &third), Ok(Accepted::Done));
    board.play(&scene(&HEADER, &[record(bitmap(bitmap_crc32(300, 100, &second)))]));
    board.slide(800);
    let commanded_n = board.status().telemetry.commanded_electric_friction_n;
    assert!((commanded_n - 0.02 * 2.0 / 255.0).abs() < 1e-9, "the bitmap that stayed was moved whole: {commanded_n}");
}

#[cfg(feature = "bitmap")]
#[test]
fn announced_bitmaps_stay_when_announced_again() {
    let mut board = TestBoard::connected();
    let (first, second, third) = (vec![1; 30_000], vec![2; 30_000], vec![3; 30_000]);
    board.upload_bitmap(300, 100, &first).unwrap();
    board.upload_bitmap(300, 100, &second).unwrap();
    for _ in 0..70 {
        assert_eq!(board.upload_bitmap(300, 100, &second), Ok(Accepted::AlreadyHeld));
    }
    assert!(matches!(board.upload_bitmap(300, 100, &third), Err(Refusal::BitmapPoolFull { .. })));
    let both = side_by_side([bitmap_crc32(300, 100, &first), bitmap_crc32(300, 100, &second)]);
    board.load(&scene(&HEADER, &both)).unwrap();
}

/// A refused scene frees its part of the pool for the next scene.
#[cfg(feature = "bitmap")]
#[test]
fn bitmaps_of_a_refused_scene_are_evicted() {
    let mut board = TestBoard::connected();
    let playing = vec![1; 20_000];
    board.upload_bitmap(200, 100, &playing).unwrap();
    board.play(&scene(&HEADER, &[record(bitmap(bitmap_crc32(200, 100, &playing)))]));
    for sample in 2..4 {
        board.upload_bitmap(200, 100, &vec![sample; 20_000]).unwrap();
    }
    assert!(matches!(board.upload_bitmap(200, 100, &vec![4; 20_000]), Err(Refusal::BitmapPoolFull { .. })));
    assert_eq!(board.upload_bitmap(200, 100, &vec![5; 20_000]), Ok(Accepted::Done));
}

/// The session's orders for a command, without signs of life.
fn orders_for(board: &mut TestBoard, command: Command) -> Vec<Order<'static>> {
    board.session.receive(&request(7, command), &board.ticker.status());
    std::iter::from_fn(|| board.session.next_order()).filter(|order| !matches!(order, Order::SignOfLife)).collect()
}

#[test]
fn a_touch_of_the_host_goes_to_the_ticker_once() {
    let board = Board { touch_from_host: true, ..Board::SIMULATOR };
    let mut board = TestBoard::of(board);
    board.hello();
    board.tick();
    assert!(orders_for(&mut board, Command::Ping).is_empty());
    let touched = orders_for(&mut board, Command::Touch { x_m: 0.02, y_m: 0.03, age_ticks: 1 });
    let [Order::Track(track)] = &touched[..] else { panic!("{} orders", touched.len()) };
    assert_eq!(track.place_m.map(f32::to_bits), [0.02_f32, 0.03].map(f32::to_bits));
    assert!(orders_for(&mut board, Command::Ping).is_empty());
    assert!(matches!(orders_for(&mut board, Command::Lift)[..], [Order::Lift]));
    assert!(orders_for(&mut board, Command::Ping).is_empty());
    for x_m in [f32::NAN, f32::INFINITY, -2.1] {
        assert!(orders_for(&mut board, Command::Touch { x_m, y_m: 0.03, age_ticks: 0 }).is_empty());
        let refused = board.command(Command::Touch { x_m, y_m: 0.03, age_ticks: 0 });
        assert!(
            matches!(refused, Err(Refusal::Config(refusal)) if refusal.field == ConfigField::TouchPlace),
            "{refused:?}"
        );
        board.tick();
    }
}

#[test]
fn a_board_with_a_touch_source_refuses_touches_of_the_host() {
    let mut board = TestBoard::new();
    let hello = board.hello();
    assert_eq!(hello.features & feature::HOST_TOUCH, 0);
    for command in [Command::Touch { x_m: 0.02, y_m: 0.03, age_ticks: 0 }, Command::Lift] {
        assert_eq!(board.command(command), Err(Refusal::TouchSource));
    }
    assert!(board.session.next_order().is_none());
}

/// The fault text, assembled from its pieces as a host does.
fn fault_text(board: &mut TestBoard) -> String {
    let mut text = Vec::new();
    loop {
        let Ok(Accepted::FaultText { len, bytes }) = board.command(Command::FaultText { offset: text.len() as u8 })
        else {
            panic!("no text")
        };
        text.extend(&bytes[..usize::from(len)]);
        if usize::from(len) < bytes.len() {
            return String::from_utf8(text).unwrap();
        }
    }
}

#[test]
fn the_text_of_a_fault_is_reported_whole() {
    for len in [0, 1, 31, 32, 33, 64, 191, 192, 250] {
        let reset_text: &'static str = "stack overflow at 0x1fff_fff8; ".repeat(9).leak().get(..len).unwrap();
        let board = Board {
            reset_fault: Some((Fault::StackOverflow, 7)),
            reset_text: reset_text.as_bytes(),
            ..Board::SIMULATOR
        };
        let mut board = TestBoard::of(board);
        let hello = board.hello();
        assert_eq!((hello.last_fault, hello.fault_detail), (Some(Fault::StackOverflow), 7));
        assert_eq!(fault_text(&mut board), reset_text[..len.min(192)]);
        let beyond = board.command(Command::FaultText { offset: 255 });
        assert!(matches!(beyond, Ok(Accepted::FaultText { len: 0, .. })));
    }
}

#[cfg(feature = "telemetry")]
#[test]
fn tick_times_are_the_recorded_ones_or_zero_without_a_meter() {
    static METER: frixel_control::TickMeter = frixel_control::TickMeter::new(3_700);
    let mut board = TestBoard::connected();
    assert_eq!(board.command(Command::TickTimes), Ok(Accepted::TickTimes(TickTimes::default())));
    board.session.attach_tick_meter(&METER);
    METER.record(3_701);
    board.ticker.raise(Fault::Deadline, 3_701);
    board.tick();
    assert_eq!(board.command(Command::TickTimes), Ok(Accepted::TickTimes(METER.times(1))));
}

proptest! {
    /// Arbitrary bytes never reach the output, and never stop the board.
    #[test]
    fn arbitrary_bytes_leave_the_board_disarmed_and_listening(
        bytes in proptest::collection::vec(any::<u8>(), 0..2000),
    ) {
        let mut board = TestBoard::new();
        board.send(&bytes);
        board.send(&[0]);
        board.touch = Some(Touch::Down { x_m: 0.05, y_m: 0.05, age_ticks: 0 });
        let drive = board.ticks(10);
        prop_assert_eq!(drive, frixel_control::Drive::default());
        prop_assert_eq!(board.hello().state, State::Disarmed);
    }
}
