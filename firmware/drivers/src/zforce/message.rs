//! Messages of the zForce modules (Neonode Touch Sensor Module User's Guide: serialization protocol quick start, ASN.1
//! PDU examples).
//!
//! On I2C, every message is preceded by two bytes, `ee` and its length. The module raises its data-ready pin while a
//! message is unread; the host reads the two bytes first, then the message.

/// Address on the I2C bus, 7 bits.
pub const I2C_ADDRESS: u8 = 0x50;
/// First byte on the bus.
const TRANSPORT: u8 = 0xee;
/// Bytes before a message.
pub const LENGTH_LEN: usize = 2;
/// Largest length of a message: a notification of up to eight touches.
pub const MESSAGE_MAX_LEN: usize = 127;

/// Request: 200 scans per second, with and without a finger.
pub const SET_FREQUENCY: [u8; 18] =
    [TRANSPORT, 0x10, 0xee, 0x0e, 0x40, 0x02, 0x00, 0x00, 0x68, 0x08, 0x80, 0x02, 0x00, 0xc8, 0x82, 0x02, 0x00, 0xc8];
/// Request: send notifications from now on.
pub const ENABLE: [u8; 13] = [TRANSPORT, 0x0b, 0xee, 0x09, 0x40, 0x02, 0x02, 0x00, 0x65, 0x03, 0x81, 0x01, 0x00];

const NOTIFICATION: u8 = 0xf0;
/// The sensor itself, as opposed to its module.
const SENSOR_ADDRESS: [u8; 4] = [0x40, 0x02, 0x02, 0x00];
const TOUCHES: u8 = 0xa0;
const TOUCH: u8 = 0x42;
const BOOT_COMPLETE: u8 = 0x63;
const EVENT_DOWN: u8 = 0;
const EVENT_MOVE: u8 = 1;
const EVENT_UP: u8 = 2;
/// A byte read while no device drives the bus.
const RELEASED: u8 = 0xff;
/// Coordinates are in tenths of a millimetre.
const M_PER_UNIT: f32 = 1e-4;

/// A report of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Touch {
    /// A finger, located from the sensor's own corner.
    Down {
        /// Distance along the sensor, m.
        x_m: f32,
        /// Distance from the sensor, m.
        y_m: f32,
    },
    /// The finger was lifted.
    Up,
}

/// A parsed message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Message {
    /// A report of a finger.
    Touch(Touch),
    /// The module has started and waits for its requests.
    Started,
    /// An ignored message: an answer, another notification, an invalid touch.
    Other,
}

/// Length of the message after this header; `None` for an invalid header.
pub fn message_len(length: [u8; LENGTH_LEN]) -> Option<usize> {
    let [transport, len] = length;
    (transport == TRANSPORT && len > 0 && usize::from(len) <= MESSAGE_MAX_LEN).then_some(usize::from(len))
}

/// Parses a message. If it contains several touches, returns the first.
pub fn parse(message: &[u8]) -> Message {
    let Some((NOTIFICATION, content, _)) = element(message) else { return Message::Other };
    let Some((address, body)) = content.split_first_chunk::<4>() else { return Message::Other };
    match element(body) {
        Some((TOUCHES, touches, _)) if *address == SENSOR_ADDRESS => match element(touches) {
            Some((TOUCH, touch, _)) => parse_touch(touch),
            _ => Message::Other,
        },
        Some((BOOT_COMPLETE, ..)) => Message::Started,
        _ => Message::Other,
    }
}

/// A module that stops in the middle of a report releases the bus, and the remaining bytes read as ones. A place is
/// therefore ignored if the last byte of its report is all ones: the place may be incomplete, and the byte would be a
/// confidence of 255, which is assumed not to occur. A complete lift is valid.
fn parse_touch(touch: &[u8]) -> Message {
    match *touch {
        [_, EVENT_UP, ..] => Message::Touch(Touch::Up),
        [.., RELEASED] => Message::Other,
        [_, EVENT_DOWN | EVENT_MOVE, x_high, x_low, y_high, y_low, ..] => Message::Touch(Touch::Down {
            x_m: f32::from(u16::from_be_bytes([x_high, x_low])) * M_PER_UNIT,
            y_m: f32::from(u16::from_be_bytes([y_high, y_low])) * M_PER_UNIT,
        }),
        _ => Message::Other,
    }
}

/// Splits off the first element: its tag, its content, and the remaining bytes. Lengths above 127 do not occur.
fn element(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let ([tag, len], rest) = bytes.split_first_chunk()?;
    let (content, rest) = rest.split_at_checked(usize::from(*len))?;
    Some((*tag, content, rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// One touch without a time stamp, as the ASN.1 PDU examples have it.
    fn one_touch(event: u8, x: u16, y: u16) -> Vec<u8> {
        let mut message = vec![0xf0, 0x11, 0x40, 0x02, 0x02, 0x00, 0xa0, 0x0b, 0x42, 0x09, 0x00, event];
        message.extend(x.to_be_bytes());
        message.extend(y.to_be_bytes());
        message.extend([0x10, 0x10, 0x80]);
        message
    }

    fn near(message: Message, x_m: f32, y_m: f32) -> bool {
        let Message::Touch(Touch::Down { x_m: x, y_m: y }) = message else { return false };
        (x - x_m).abs() < 1e-6 && (y - y_m).abs() < 1e-6
    }

    #[test]
    fn a_time_stamp_and_a_second_touch_change_nothing() {
        let mut message = one_touch(1, 100, 200);
        message.extend([0x58, 0x02, 0x12, 0x34]);
        message[1] += 4;
        message[7] += 4;
        assert!(near(parse(&message), 0.01, 0.02));
        let mut message = one_touch(1, 100, 200);
        message.extend([0x42, 0x09, 0x01, 0x01, 0x03, 0x00, 0x03, 0x00, 0x10, 0x10, 0x80]);
        message[1] += 11;
        message[7] += 11;
        assert!(near(parse(&message), 0.01, 0.02));
    }

    /// The module restarts in the middle of a report: what follows is read from a released bus.
    #[test]
    fn a_touch_that_is_cut_off_is_not_a_touch() {
        for event in [EVENT_DOWN, EVENT_MOVE, EVENT_UP] {
            let whole = one_touch(event, 1234, 300);
            for cut in 0..whole.len() {
                let mut message = whole.clone();
                message[cut..].fill(0xff);
                // The event is the byte at 11.
                let is_lift = event == EVENT_UP && cut > 11;
                let expected = if is_lift { Message::Touch(Touch::Up) } else { Message::Other };
                assert_eq!(parse(&message), expected, "event {event} after {cut} bytes");
            }
        }
    }

    #[test]
    fn invalid_lengths_are_refused() {
        for length in [[0xee, 0], [0xee, 128], [0xee, 255], [0xff, 10], [0, 10]] {
            assert_eq!(message_len(length), None, "{length:02x?}");
        }
    }

    proptest! {
        /// No bytes make it panic, and a truncated touch is not a touch.
        #[test]
        fn anything_can_be_parsed(bytes in proptest::collection::vec(any::<u8>(), 0..130), cut in 0_usize..19) {
            let _ = parse(&bytes);
            prop_assert_eq!(parse(&one_touch(1, 100, 200)[..cut]), Message::Other);
        }
    }
}
