//! The frozen hello, and hellos of future protocol versions.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::{
    BoardKind, BoardLimits, Core, HELLO_LEN, HELLO_MAX_LEN, Hello, HelloError, Mismatch, PROTOCOL_MAJOR, ResetCause,
};
use support::hex::from_hex;
use support::samples::hello;

/// Offset of the number of bytes of limits, and of the limits.
const LIMITS_LEN_AT: usize = 43;
const LIMITS_AT: usize = 44;

/// A hello, written by hand field by field as in `PROTOCOL.md`. These bytes never change: later minor versions append
/// values.
#[test]
fn the_layout_is_frozen() {
    let bytes = from_hex(
        "46 52 58 4c  01 00  00 01 02  02  00 01 02 03 04 05 06 07 08 09 0a 0b  40 9c 00 00  c0 00  \
         01 00 00 80  26 39 f4 cb  04  03  0d 0c 0b 0a  03  49 \
         01 04 00 40 01 00  02 01 10  03 02 00 10  04 04 00 00 48 43  05 04 00 00 7a 43  06 04 00 00 80 3f \
         07 04 00 00 00 40  08 04 00 00 40 40  09 04 00 00 80 40  0a 04 00 00 a0 40  0b 04 f6 09 00 00 \
         0c 01 00  0d 04 00 00 80 7f  0e 01 00",
    );
    let hello = Hello {
        protocol: (1, 0),
        firmware: (0, 1, 2),
        board: BoardKind::NucleoG474re,
        id: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
        tick_hz: 40_000,
        frame_max_len: 192,
        features: 0x8000_0001,
        scene_crc32: 0xcbf4_3926,
        reset_cause: ResetCause::Watchdog,
        last_fault: Some(Fault::Deadline),
        fault_detail: 0x0a0b_0c0d,
        state: State::Faulted,
        limits: BoardLimits {
            bitmap_pool_bytes: 80 * 1024,
            records_max: 16,
            receive_window_bytes: 4_096,
            voltage_max_v_peak: 200.0,
            full_scale_v_peak: 250.0,
            edge_time_constant_s: 1.0,
            electrode_capacitance_max_f: 2.0,
            current_max_a_rms: 3.0,
            current_max_a_peak: 4.0,
            touch_report_period_s: 5.0,
            tick_cycles_max: BoardLimits::SMALLEST_TICK_CYCLES_MAX,
            series_resistance_ohm: f32::INFINITY,
            core: Core::CortexM4f,
        },
        notices: 0,
    };
    assert_eq!(Hello::parse(&bytes), Ok(hello));
    assert_eq!(bytes.len(), HELLO_LEN);
    assert_eq!(hello.write().as_slice(), bytes);
}

/// Another protocol, unknown numbers and limits, a known limit of another length, bytes after the end.
#[test]
fn a_hello_of_a_later_protocol_is_read() {
    let now = hello();
    let mut bytes = now.write().to_vec();
    bytes[4] = 9;
    bytes[9] = 200;
    bytes[36] = 201;
    bytes[37] = 202;
    bytes[42] = 203;
    let unknown = [200, 1, 7, 201, 0, 4, 1, 0xff];
    bytes.splice(LIMITS_AT..LIMITS_AT, unknown);
    bytes[LIMITS_LEN_AT] += unknown.len() as u8;
    bytes.extend([0x55; 2]);
    assert!(bytes.len() <= HELLO_MAX_LEN);
    let read = Hello::parse(&bytes).unwrap();
    let expected = Hello {
        protocol: (9, 0),
        board: BoardKind::Other(200),
        reset_cause: ResetCause::Other(201),
        last_fault: Some(Fault::Other(202)),
        state: State::Faulted,
        ..now
    };
    assert_eq!(read, expected);
    assert!(!read.board.is_simulated());
}

/// With the defaults for limits that a board omits, no scene can be played. `protocol` holds them.
#[test]
fn omitted_limits_allow_nothing() {
    let mut bytes = hello().write()[..LIMITS_AT].to_vec();
    bytes[LIMITS_LEN_AT] = 0;
    let hello = Hello::parse(&bytes).unwrap();
    assert_eq!((hello.limits, hello.notices), (BoardLimits::UNSTATED, 0));
}

/// An omitted limit has its default value; the others have the values sent.
#[test]
fn each_limit_is_read_by_its_tag() {
    let limits = BoardLimits { core: Core::CortexM0Plus, ..hello().limits };
    let whole = Hello { notices: 0xff, limits, ..hello() }.write();
    let mut at = LIMITS_AT;
    let mut tags = 0;
    while at < whole.len() {
        let len = 2 + usize::from(whole[at + 1]);
        let mut bytes = whole.to_vec();
        bytes.drain(at..at + len);
        bytes[LIMITS_LEN_AT] -= len as u8;
        let read = Hello::parse(&bytes).unwrap();
        let differences = read
            .write()
            .iter()
            .zip(&whole)
            .enumerate()
            .filter(|(_, (a, b))| a != b)
            .map(|(i, _)| i)
            .collect::<Vec<_>>();
        assert!(
            !differences.is_empty() && differences.iter().all(|i| (at + 2..at + len).contains(i)),
            "{differences:?}"
        );
        at += len;
        tags += 1;
    }
    assert_eq!(tags, 14);
}

/// A hello truncated at any byte is an error.
#[test]
fn truncated_hellos_are_refused() {
    let bytes = hello().write();
    for len in 0..bytes.len() {
        assert_eq!(Hello::parse(&bytes[..len]), Err(HelloError::Truncated { len }));
    }
    let mut cut_limit = bytes;
    cut_limit[LIMITS_LEN_AT] -= 1;
    assert!(Hello::parse(&cut_limit).is_err());
}

#[test]
fn other_magic_is_refused() {
    let mut bytes = hello().write();
    bytes[3] = b'l';
    assert_eq!(Hello::parse(&bytes), Err(HelloError::Magic { found: *b"FRXl" }));
}

/// Only the major version decides on compatibility, and the sentence names the side to update.
#[test]
fn a_mismatch_names_the_side_to_update() {
    assert_eq!(hello().compatibility(), Ok(()));
    assert_eq!(Hello { protocol: (PROTOCOL_MAJOR, 255), ..hello() }.compatibility(), Ok(()));

    let older = Hello { protocol: (PROTOCOL_MAJOR - 1, 7), firmware: (0, 0, 9), ..hello() }.compatibility();
    assert_eq!(older, Err(Mismatch::Protocol { board: (PROTOCOL_MAJOR - 1, 7), firmware: (0, 0, 9) }));
    let sentence = older.unwrap_err().to_string();
    assert!(sentence.contains("firmware 0.0.9 speaks protocol 0.7") && sentence.contains("speaks 1.0"), "{sentence}");
    assert!(sentence.contains("flash newer firmware") && !sentence.contains("update"), "{sentence}");

    let newer = Hello { protocol: (PROTOCOL_MAJOR + 1, 3), ..hello() }.compatibility();
    assert_eq!(newer, Err(Mismatch::Protocol { board: (PROTOCOL_MAJOR + 1, 3), firmware: (0, 1, 0) }));
    let sentence = newer.unwrap_err().to_string();
    assert!(sentence.contains("speaks protocol 2.3") && sentence.contains("speaks 1.0"), "{sentence}");
    assert!(sentence.contains("update the frixel command") && !sentence.contains("flash"), "{sentence}");

    let short = Hello { frame_max_len: 191, ..hello() }.compatibility();
    assert_eq!(short, Err(Mismatch::FramesTooShort { max: 191 }));
    let sentence = short.unwrap_err().to_string();
    assert!(sentence.contains("191") && sentence.contains("192") && sentence.contains("flash"), "{sentence}");
    assert_eq!(Hello { frame_max_len: 256, ..hello() }.compatibility(), Ok(()));
}
