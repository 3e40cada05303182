//! The words between this program and the emulator's process (`hil-sim/pico/protocol.mjs`).

use std::time::Duration;

/// A request, as its first word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Request {
    Run = 1,
    PowerCycle = 2,
    RunPin = 3,
    Hang = 4,
    HangMainLoop = 5,
    Jump = 6,
    AddressOf = 8,
    StopCrystal = 9,
    StopPio = 10,
    WriteFlash = 11,
    Watch = 12,
    TakeCalls = 13,
    AnswerI2c = 14,
}

/// Bits of the inputs in a [`Request::Run`].
pub(super) const READY: u32 = 1;
pub(super) const ARM: u32 = 2;
pub(super) const FRAME_READY: u32 = 4;
pub(super) const SDA_HELD: u32 = 8;
pub(super) const SCL_HELD: u32 = 16;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// The time has passed.
    Time,
    /// SYNC rose.
    Frame,
    /// The number of instructions was executed.
    Instructions,
    /// The board has reset itself, and has started again.
    Reset,
    /// The touch frame was addressed.
    FrameAsked,
}

/// Why a board starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartCause {
    /// Power-on.
    Power,
    /// The RUN pin was released.
    RunPin,
    /// The watchdog, after its time or at the firmware's request.
    Watchdog,
    /// The processor's own request for a reset.
    Software,
}

/// Event on the board's wires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WireEvent {
    /// SYNC rose after a frame for the DAC.
    Frame {
        /// The last bits of the frame.
        bits: u32,
        /// Number of clocks while SYNC was low, 255 at most.
        clocks: u8,
        /// Time for which SYNC was low.
        lasted: Duration,
    },
    /// The amplifier's enable has this level now.
    Enable(bool),
    /// The DAC's CLEAR has this level now; low clears.
    Clear(bool),
    /// The light has this level now.
    Light(bool),
    /// The board starts, with every wire undriven.
    Start(StartCause),
    /// The firmware reads the amplifier's monitor.
    MonitorRead {
        /// Time since SYNC rose last, which latches a code.
        since_frame: Duration,
    },
    /// A transfer on I2C begins, and waits for an acknowledgement.
    I2cAddress {
        /// The address, 7 bits.
        address: u8,
        /// Whether it reads.
        reads: bool,
    },
    /// This byte on I2C waits for an acknowledgement.
    I2cWrite(u8),
    /// A byte is read on I2C.
    I2cRead,
    /// A transfer on I2C ends.
    I2cStop,
    /// The firmware itself lets SCL go high, or pulls it low.
    Scl(bool),
}

/// An event with its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamped {
    /// Time since the board was first switched on.
    pub at: Duration,
    /// The event.
    pub event: WireEvent,
}

/// The answer to a [`Request::Run`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Ran {
    pub(super) ended: Ended,
    pub(super) elapsed: Duration,
    pub(super) instructions: u32,
    /// Events, with their time since the beginning of the run.
    pub(super) events: Vec<Stamped>,
    /// Bytes that the host has received.
    pub(super) received: Vec<u8>,
}

impl Ran {
    /// Decodes an answer; `None` for one that no emulator gives.
    pub(super) fn read(words: &[u32]) -> Option<Self> {
        let [ended, elapsed_ns, instructions, count, rest @ ..] = words else { return None };
        let ended = match ended {
            0 => Ended::Time,
            1 => Ended::Frame,
            2 => Ended::Instructions,
            3 => Ended::Reset,
            4 => Ended::FrameAsked,
            _ => return None,
        };
        let (events, bytes) = rest.split_at_checked(4 * *count as usize)?;
        Some(Self {
            ended,
            elapsed: Duration::from_nanos((*elapsed_ns).into()),
            instructions: *instructions,
            events: events.as_chunks().0.iter().map(stamped).collect::<Option<_>>()?,
            received: bytes.iter().map(|word| *word as u8).collect(),
        })
    }
}

fn stamped(&[kind, at_ns, first, second]: &[u32; 4]) -> Option<Stamped> {
    let event = match kind {
        1 => WireEvent::Frame {
            bits: first,
            clocks: (second >> 24) as u8,
            lasted: Duration::from_nanos((second & 0xff_ffff).into()),
        },
        2 => WireEvent::Enable(first != 0),
        3 => WireEvent::Clear(first != 0),
        4 => WireEvent::Light(first != 0),
        5 => WireEvent::Start(match first {
            1 => StartCause::Power,
            2 => StartCause::RunPin,
            3 => StartCause::Watchdog,
            4 => StartCause::Software,
            _ => return None,
        }),
        7 => WireEvent::MonitorRead { since_frame: Duration::from_nanos(first.into()) },
        8 => WireEvent::I2cAddress { address: first as u8, reads: second != 0 },
        9 => WireEvent::I2cWrite(first as u8),
        10 => WireEvent::I2cRead,
        11 => WireEvent::I2cStop,
        12 => WireEvent::Scl(first != 0),
        _ => return None,
    };
    Some(Stamped { at: Duration::from_nanos(at_ns.into()), event })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_has_events_and_bytes() {
        let words = [1, 99_000, 7, 2, 5, 0, 3, 0, 1, 98_000, 0x3_8000, 0x1800_0fa0, 104, 105];
        let ran = Ran::read(&words).unwrap();
        assert_eq!((ran.ended, ran.elapsed, ran.instructions), (Ended::Frame, Duration::from_micros(99), 7));
        assert_eq!(ran.received, b"hi");
        let frame = WireEvent::Frame { bits: 0x3_8000, clocks: 24, lasted: Duration::from_micros(4) };
        let start = WireEvent::Start(StartCause::Watchdog);
        assert_eq!(ran.events.iter().map(|stamped| stamped.event).collect::<Vec<_>>(), [start, frame]);
        assert_eq!(ran.events[1].at, Duration::from_micros(98));
        for broken in [&words[..3], &words[..8], &[9, 0, 0, 0]] {
            assert_eq!(Ran::read(broken), None);
        }
    }
}
