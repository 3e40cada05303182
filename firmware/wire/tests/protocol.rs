//! `PROTOCOL.md` agrees with the code: these tests read its tables and examples and compare them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use std::fmt::Debug;

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, encode};
use frixel_wire::hello::{
    BoardKind, BoardLimits, HELLO_LEN, Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR, ResetCause, notice,
};
use frixel_wire::message::{Accepted, Command, ConfigField, FromBoard, Refusal, telemetry_period_ticks};
use frixel_wire::payload::{PAYLOAD_MAX_LEN, Payload};
use frixel_wire::scene::SceneError;
use support::hex::{from_hex, to_hex};
use support::{samples, variants};

const PROTOCOL: &str = include_str!("../PROTOCOL.md");
const FAULTS: &str = include_str!("../../../docs/board/faults.md");

/// Rows of the protocol's first table after this line, their cells without spaces and backticks around.
fn table(line: &str) -> Vec<Vec<&'static str>> {
    table_of(PROTOCOL, line)
}

/// Rows of a page's first table after this line.
fn table_of(page: &'static str, line: &str) -> Vec<Vec<&'static str>> {
    let (_, after) = page.split_once(&format!("\n{line}\n")).expect(line);
    let rows = after.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    rows.skip(2)
        .map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect())
        .collect()
}

/// Number and name in the table of this enum.
fn numbered(name: &str) -> Vec<(usize, &'static str)> {
    numbers_and_names(&table(&format!("### `{name}`")))
}

fn numbers_and_names(rows: &[Vec<&'static str>]) -> Vec<(usize, &'static str)> {
    rows.iter().map(|row| (row[0].parse().unwrap(), row[1])).collect()
}

/// Number and name in the list of fields.
fn config_fields() -> Vec<(usize, &'static str)> {
    let (_, list) = PROTOCOL.split_once("\n### `ConfigField`\n\n").unwrap();
    let (list, _) = list.split_once(".\n").unwrap();
    let fields = list.split(',').map(|field| field.trim().split_once(char::is_whitespace).unwrap());
    fields.map(|(number, name)| (number.parse().unwrap(), name.trim_matches('`'))).collect()
}

#[test]
fn examples_are_frames_and_can_be_read() {
    let mut lines = PROTOCOL.lines();
    let mut examples = 0;
    while let Some(line) = lines.next() {
        let Some(payload) = line.strip_prefix("    payload ").filter(|rest| !rest.contains("and")) else { continue };
        let payload = from_hex(payload);
        let frame = lines.next().unwrap().strip_prefix("    frame ").expect(line);
        assert_eq!(to_hex(encode(&payload, &mut [0; FRAME_MAX_LEN]).unwrap()), frame);
        let read = Payload::parse(&payload).expect(line);
        assert_eq!(read.write(&mut [0; PAYLOAD_MAX_LEN]).unwrap(), payload);

        let frame = from_hex(frame);
        let mut decoder = Decoder::new();
        assert_eq!(decoder.next_frame(&mut frame.as_slice()), Some(payload.as_slice()));
        examples += 1;
    }
    assert!(examples > 0 && examples == PROTOCOL.matches("\n    frame ").count(), "{examples}");
}

#[test]
fn examples_of_the_hello_request_have_the_version_of_the_page() {
    let title = PROTOCOL.lines().next().unwrap();
    assert_eq!(title, format!("# The frixel serial protocol, version {PROTOCOL_MAJOR}.{PROTOCOL_MINOR}"));
    let payload = format!("00 {PROTOCOL_MAJOR:02x} {PROTOCOL_MINOR:02x}");
    for example in [
        format!("the hello request of protocol {PROTOCOL_MAJOR}.{PROTOCOL_MINOR} has the payload `{payload}`"),
        format!("payload and CRC   {payload} "),
        format!("\n    payload {payload}\n"),
    ] {
        assert_eq!(PROTOCOL.matches(&example).count(), 1, "{example}");
    }
}

#[test]
fn enum_numbers_match_the_tables() {
    fn code<'de, T: serde::Deserialize<'de>>() -> Vec<(usize, &'static str)> {
        variants::all::<T>().into_iter().enumerate().collect()
    }
    fn check<'de, T: serde::Deserialize<'de>>(name: &str) {
        assert_eq!(numbered(name), code::<T>(), "{name}");
    }
    check::<Command>("Command");
    check::<FromBoard>("FromBoard");
    check::<State>("State");
    check::<Accepted>("Accepted");
    check::<Refusal>("Refusal");
    check::<SceneError>("SceneError");
    assert_eq!(config_fields(), code::<ConfigField>());
}

#[test]
fn names_of_numbers_match_the_tables() {
    fn check<T: Debug>(name: &str, named: impl Fn(u8) -> Option<T>) {
        let code: Vec<(usize, String)> =
            (0..=u8::MAX).filter_map(|n| Some((n.into(), format!("{:?}", named(n)?)))).collect();
        let page: Vec<(usize, String)> = numbered(name).into_iter().map(|(n, name)| (n, name.into())).collect();
        assert_eq!(page, code);
    }
    check("BoardKind", |n| Some(BoardKind::from(n)).filter(|kind| !matches!(kind, BoardKind::Other(_))));
    check("ResetCause", |n| Some(ResetCause::from(n)).filter(|cause| !matches!(cause, ResetCause::Other(_))));
    check("Fault", |n| Fault::try_from(n).ok().filter(|fault| !matches!(fault, Fault::Other(_))));
    for (number, name) in numbered("State") {
        let state = State::try_from(number as u8).unwrap();
        assert_eq!((state.number(), format!("{state:?}").as_str()), (number as u8, name));
    }
}

#[test]
fn flag_bits_match_the_table() {
    let page: Vec<(Flags, &str)> = numbered("Flags").into_iter().map(|(bit, name)| (Flags(1 << bit), name)).collect();
    let code = [
        (Flags::SATURATED, "SATURATED"),
        (Flags::SLEWED, "SLEWED"),
        (Flags::STILL, "STILL"),
        (Flags::NO_FINGER, "NO_FINGER"),
        (Flags::TOUCH_STALE, "TOUCH_STALE"),
        (Flags::CARRIER_BALANCED, "CARRIER_BALANCED"),
        (Flags::HOST_SILENT, "HOST_SILENT"),
        (Flags::STREAM_DRY, "STREAM_DRY"),
        (Flags::CLAMPED, "CLAMPED"),
    ];
    assert_eq!(page, code);
}

#[test]
fn notice_bits_match_the_table() {
    let page: Vec<(u8, &str)> = numbered("Notices").into_iter().map(|(bit, name)| (1 << bit, name)).collect();
    let code = [
        (notice::OPTION_BYTES, "OPTION_BYTES"),
        (notice::STORED_LIMITS_REFUSED, "STORED_LIMITS_REFUSED"),
        (notice::LIMITS_ABOVE_CEILINGS, "LIMITS_ABOVE_CEILINGS"),
    ];
    assert_eq!(page, code);
    assert_eq!(page.len(), notice::SENTENCES.len());
}

/// The page of faults has a row for each number of the protocol, and for each refusal to arm or to play.
#[test]
fn the_page_of_faults_lists_everything_that_a_board_reports() {
    let on_page = |heading: &str| numbers_and_names(&table_of(FAULTS, heading));
    assert_eq!(on_page("## Faults"), numbered("Fault"));
    assert_eq!(on_page("## Resets"), numbered("ResetCause"));
    assert_eq!(on_page("## Notices"), numbered("Notices"));
    let commands = table("### `Command`");
    let starts = commands.iter().filter(|row| ["Arm", "Play"].contains(&row[1]));
    let refusals: Vec<&str> = starts.flat_map(|row| row[4].split([',', ' ', '`'])).collect();
    let refused: Vec<_> = numbered("Refusal").into_iter().filter(|(_, name)| refusals.contains(name)).collect();
    assert_eq!(on_page("## Refusals to arm or to play"), refused);
}

/// The fields that a table names, in order, are those of the value.
#[test]
fn field_order_matches_the_tables() {
    fn check(name: &str, value: &impl Debug) -> usize {
        let table = table(&format!("### `{name}`"));
        let row = table.iter().find(|row| row[1] == variants::name(value)).unwrap();
        let page: Vec<_> = row[2].split('`').filter_map(|field| Some(field.split_once(':')?.0)).collect();
        if !page.is_empty() {
            assert_eq!(page, field_names(&format!("{value:?}")), "{value:?}");
        }
        page.len()
    }
    let mut named = 0;
    for payload in samples::from_host() {
        if let Payload::Request(request) = payload {
            named += check("Command", &request.command);
        }
    }
    for payload in samples::from_board() {
        if let Payload::FromBoard(message) = payload {
            named += check("FromBoard", &message);
        }
    }
    named += samples::refusals().iter().map(|refusal| check("Refusal", refusal)).sum::<usize>();
    named += samples::scene_errors().iter().map(|error| check("SceneError", error)).sum::<usize>();
    assert!(named > 100, "{named}");
}

/// Names of the outermost fields in a value's debug text.
fn field_names(debug: &str) -> Vec<&str> {
    let fields = debug.split_once('{').map_or("", |(_, fields)| fields);
    let mut depth = 0;
    let outermost = |c: char| {
        depth += i32::from(matches!(c, '{' | '(')) - i32::from(matches!(c, '}' | ')'));
        c == ',' && depth == 0
    };
    fields.split(outermost).filter_map(|field| Some(field.split_once(':')?.0.trim())).collect()
}

/// Every byte of a layout is in its table, exactly once. The golden bytes and `the_layout_is_frozen` check which field
/// it belongs to.
#[test]
fn layouts_have_no_gap() {
    for (line, len) in
        [("After the first byte of the payload, at these offsets:", 44), ("The header:", 56), ("A record:", 56)]
    {
        let mut end = 0;
        for row in table(line) {
            assert_eq!(row[0].parse(), Ok(end), "{row:?}");
            end += row[1].parse::<usize>().unwrap();
        }
        assert_eq!(end, len, "{line}");
    }
}

/// The table of limits: tags in order, lengths, and the defaults of omitted limits.
#[test]
fn limits_match_the_table() {
    let (_, after) = PROTOCOL.split_once("\n| tag | bytes |").unwrap();
    let rows: Vec<Vec<&str>> = after
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|row| row.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let unstated = Hello { limits: BoardLimits::UNSTATED, ..samples::hello() }.write();
    let mut at = 44;
    for row in rows {
        let (tag, len): (u8, u8) = (row[0].parse().unwrap(), row[1].parse().unwrap());
        assert_eq!(unstated[at..at + 2], [tag, len]);
        let value = &unstated[at + 2..at + 2 + usize::from(len)];
        let real = row[2].contains("`f32`");
        let expected = match (row[3], value.len()) {
            ("infinite", 4) if real => f32::INFINITY.to_le_bytes().to_vec(),
            (number, 4) if real => number.parse::<f32>().unwrap().to_le_bytes().to_vec(),
            (number, len) => number.parse::<u32>().unwrap().to_le_bytes()[..len].to_vec(),
        };
        assert_eq!(value, expected, "{row:?}");
        at += 2 + usize::from(len);
    }
    assert_eq!(at, HELLO_LEN);
}

#[test]
fn a_telemetry_period_is_rounded_up_to_whole_ticks() {
    assert_eq!([40_000, 8_000, 44_100, 999].map(|tick_hz| telemetry_period_ticks(tick_hz, 1_000)), [40, 8, 45, 1]);
}
