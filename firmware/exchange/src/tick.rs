//! Input and output of a tick.

use frixel_control::{Drive, Sense};
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;

use crate::words::{TOUCH_MASK, put_bytes, put_touch, take_bytes, take_touch, touch_kind};

/// Largest number of bytes on the serial line in one tick, in either direction.
pub const TICK_BYTES_MAX: usize = 64;
/// Bytes on the serial line in one tick.
pub type TickBytes = heapless::Vec<u8, TICK_BYTES_MAX>;
/// Largest number of words of a [`TickInput`].
pub const INPUT_WORDS_MAX: usize = 6 + TICK_BYTES_MAX / 4;
/// Largest number of words of a [`TickOutput`].
pub const OUTPUT_WORDS_MAX: usize = 2 + TICK_BYTES_MAX / 4;

const AMPLIFIER_FAULT: u32 = 1 << 2;
const ARM_SWITCH: u32 = 1 << 3;
const BYTES_SHIFT: u32 = 8;
const ROOM_SHIFT: u32 = 16;

const AMPLIFIER_ENABLE: u32 = 1 << 16;
const SENT_SHIFT: u32 = 24;

/// Input of a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TickInput {
    /// The tick, counted from 1 at reset.
    pub tick: u32,
    /// Bytes that have arrived on the serial line.
    pub received: TickBytes,
    /// Number of bytes that the serial line accepts, [`TICK_BYTES_MAX`] at most.
    pub room: u8,
    /// A report of the touch source, if one has arrived.
    pub touch: Option<Touch>,
    /// The inputs that the tick reads.
    pub sense: Sense,
}

impl TickInput {
    /// Encodes `self`: calls `put` for each word, [`INPUT_WORDS_MAX`] times at most.
    pub fn write(&self, mut put: impl FnMut(u32)) {
        let sense = &self.sense;
        let mut kind = touch_kind(self.touch);
        kind |= (self.received.len() as u32) << BYTES_SHIFT | u32::from(self.room) << ROOM_SHIFT;
        if sense.amplifier_fault {
            kind |= AMPLIFIER_FAULT;
        }
        if sense.arm_switch {
            kind |= ARM_SWITCH;
        }
        put(self.tick);
        put(kind);
        put(sense.monitor_v.to_bits());
        put_touch(self.touch, &mut put);
        put_bytes(&self.received, &mut put);
    }

    /// Decodes an input: calls `take` for each word.
    pub fn read(mut take: impl FnMut() -> u32) -> Self {
        let tick = take();
        let kind = take();
        let monitor_v = f32::from_bits(take());
        let touch = take_touch(kind & TOUCH_MASK, &mut take);
        let sense =
            Sense { amplifier_fault: kind & AMPLIFIER_FAULT != 0, monitor_v, arm_switch: kind & ARM_SWITCH != 0 };
        let received = take_bytes(usize::from((kind >> BYTES_SHIFT) as u8), &mut take);
        Self { tick, received, room: (kind >> ROOM_SHIFT) as u8, touch, sense }
    }
}

/// Output of a tick.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TickOutput {
    /// The tick, counted from 1 at reset.
    pub tick: u32,
    /// The board's output.
    pub drive: Drive,
    /// Bytes to send on the serial line.
    pub sent: TickBytes,
}

impl TickOutput {
    /// Encodes `self`: calls `put` for each word, [`OUTPUT_WORDS_MAX`] times at most.
    pub fn write(&self, mut put: impl FnMut(u32)) {
        put(self.tick);
        put(word_of(self.drive) | (self.sent.len() as u32) << SENT_SHIFT);
        put_bytes(&self.sent, &mut put);
    }

    /// Decodes an output: calls `take` for each word.
    pub fn read(mut take: impl FnMut() -> u32) -> Self {
        let tick = take();
        let word = take();
        Self { tick, drive: drive_of(word), sent: take_bytes((word >> SENT_SHIFT) as usize, &mut take) }
    }
}

/// Encodes a drive as a word: the DAC code in the lower half, the amplifier's enable in bit 16.
pub const fn word_of(drive: Drive) -> u32 {
    let code = drive.dac_code.bits() as u16 as u32;
    if drive.amplifier_enable { code | AMPLIFIER_ENABLE } else { code }
}

/// Decodes the drive from a word.
pub const fn drive_of(word: u32) -> Drive {
    Drive { dac_code: DacCode::from_bits(word as u16 as i16), amplifier_enable: word & AMPLIFIER_ENABLE != 0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn bytes() -> impl Strategy<Value = TickBytes> {
        prop::collection::vec(any::<u8>(), 0..=TICK_BYTES_MAX).prop_map(|bytes| bytes.into_iter().collect())
    }

    fn touch() -> impl Strategy<Value = Option<Touch>> {
        let down = (-1.0_f32..1.0, -1.0_f32..1.0, any::<u32>());
        prop_oneof![
            Just(None),
            Just(Some(Touch::Up)),
            down.prop_map(|(x_m, y_m, age_ticks)| Some(Touch::Down { x_m, y_m, age_ticks })),
        ]
    }

    proptest! {
        #[test]
        fn inputs_and_outputs_come_back_from_their_words(
            (tick, received, room, sent) in (any::<u32>(), bytes(), any::<u8>(), bytes()),
            (touch, amplifier_fault) in (touch(), any::<bool>()),
            (monitor_v, arm_switch) in (-300.0_f32..300.0, any::<bool>()),
            (dac_code, amplifier_enable) in (any::<i16>(), any::<bool>()),
        ) {
            let sense = Sense { amplifier_fault, monitor_v, arm_switch };
            let input = TickInput { tick, received, room, touch, sense };
            let drive = Drive { dac_code: DacCode::from_bits(dac_code), amplifier_enable };
            let output = TickOutput { tick, drive, sent };
            let mut words = std::vec::Vec::new();
            input.write(|word| words.push(word));
            prop_assert!(words.len() <= INPUT_WORDS_MAX);
            let input_len = words.len();
            output.write(|word| words.push(word));
            prop_assert!(words.len() - input_len <= OUTPUT_WORDS_MAX);
            let mut words = words.into_iter();
            prop_assert_eq!(TickInput::read(|| words.next().unwrap()), input);
            prop_assert_eq!(TickOutput::read(|| words.next().unwrap()), output);
            prop_assert_eq!(words.next(), None);
        }
    }
}
