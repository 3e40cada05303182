//! The byte layout of a hello, which never changes.

use core::fmt;

use super::{BoardKind, BoardLimits, Core, HELLO_LEN, Hello, MAGIC, ResetCause};
use crate::bytes::{get, get_u8, get_u16, get_u32, put, put_u8, put_u16, put_u32};
use crate::fault::{Fault, State};

/// Number of bytes before the limits.
pub(super) const FIXED_LEN: usize = 44;
/// Length of the limits before the notices, including tags and lengths: one of 1 byte, one of 2, nine of 4.
const LIMITS_LEN: usize = 11 * 2 + 1 + 2 + 9 * 4;
/// Length of the limits, the notices, and the limits after them.
pub(super) const VALUES_LEN: usize = LIMITS_LEN + (2 + 1) + (2 + 4) + (2 + 1);

const TAG_BITMAP_POOL_BYTES: u8 = 1;
const TAG_RECORDS_MAX: u8 = 2;
const TAG_RECEIVE_WINDOW_BYTES: u8 = 3;
const TAG_VOLTAGE_MAX_V_PEAK: u8 = 4;
const TAG_FULL_SCALE_V_PEAK: u8 = 5;
const TAG_EDGE_TIME_CONSTANT_S: u8 = 6;
const TAG_ELECTRODE_CAPACITANCE_MAX_F: u8 = 7;
const TAG_CURRENT_MAX_A_RMS: u8 = 8;
const TAG_CURRENT_MAX_A_PEAK: u8 = 9;
const TAG_TOUCH_REPORT_PERIOD_S: u8 = 10;
const TAG_TICK_CYCLES_MAX: u8 = 11;
const TAG_NOTICES: u8 = 12;
const TAG_SERIES_RESISTANCE_OHM: u8 = 13;
const TAG_CORE: u8 = 14;

/// Why bytes are not a hello of any protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HelloError {
    /// The first four bytes are not [`MAGIC`].
    Magic {
        /// The first four bytes.
        found: [u8; 4],
    },
    /// The hello is truncated.
    Truncated {
        /// Number of bytes received.
        len: usize,
    },
}

impl fmt::Display for HelloError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Magic { found } => {
                write!(f, "a hello begins with {MAGIC:02x?}, this one with {found:02x?}: is it a frixel board?")
            }
            Self::Truncated { len } => write!(f, "the hello is truncated after {len} bytes: request it again"),
        }
    }
}

impl core::error::Error for HelloError {}

impl Hello {
    /// Encodes the hello.
    pub fn write(&self) -> [u8; HELLO_LEN] {
        let mut b = [0; HELLO_LEN];
        put::<0, 4, _>(&mut b, MAGIC);
        put_u8::<4, _>(&mut b, self.protocol.0);
        put_u8::<5, _>(&mut b, self.protocol.1);
        put_u8::<6, _>(&mut b, self.firmware.0);
        put_u8::<7, _>(&mut b, self.firmware.1);
        put_u8::<8, _>(&mut b, self.firmware.2);
        put_u8::<9, _>(&mut b, self.board.number());
        put::<10, 12, _>(&mut b, self.id);
        put_u32::<22, _>(&mut b, self.tick_hz);
        put_u16::<26, _>(&mut b, self.frame_max_len);
        put_u32::<28, _>(&mut b, self.features);
        put_u32::<32, _>(&mut b, self.scene_crc32);
        put_u8::<36, _>(&mut b, self.reset_cause.number());
        put_u8::<37, _>(&mut b, self.last_fault.map_or(0, Fault::number));
        put_u32::<38, _>(&mut b, self.fault_detail);
        put_u8::<42, _>(&mut b, self.state.number());
        put_u8::<43, _>(&mut b, VALUES_LEN as u8);
        put::<FIXED_LEN, LIMITS_LEN, _>(&mut b, self.limits.write());
        let values = [TAG_NOTICES, 1, self.notices, TAG_SERIES_RESISTANCE_OHM, 4];
        put::<{ FIXED_LEN + LIMITS_LEN }, 5, _>(&mut b, values);
        put_u32::<{ FIXED_LEN + LIMITS_LEN + 5 }, _>(&mut b, self.limits.series_resistance_ohm.to_bits());
        put::<{ FIXED_LEN + LIMITS_LEN + 9 }, 3, _>(&mut b, [TAG_CORE, 1, self.limits.core.number()]);
        b
    }

    /// Decodes a hello of any protocol. Bytes after the hello and limits that this crate does not know are ignored.
    pub fn parse(bytes: &[u8]) -> Result<Self, HelloError> {
        let truncated = HelloError::Truncated { len: bytes.len() };
        let magic = *bytes.first_chunk().ok_or(truncated)?;
        if magic != MAGIC {
            return Err(HelloError::Magic { found: magic });
        }
        let (b, rest) = bytes.split_first_chunk::<FIXED_LEN>().ok_or(truncated)?;
        let values = rest.get(..usize::from(get_u8::<43, _>(b))).ok_or(truncated)?;
        let (mut limits, mut notices) = (BoardLimits::UNSTATED, 0);
        for value in tagged(values) {
            match value.ok_or(truncated)? {
                (TAG_NOTICES, &[bits]) => notices = bits,
                (tag, value) => limits.set(tag, value),
            }
        }
        Ok(Self {
            protocol: (get_u8::<4, _>(b), get_u8::<5, _>(b)),
            firmware: (get_u8::<6, _>(b), get_u8::<7, _>(b), get_u8::<8, _>(b)),
            board: BoardKind::from(get_u8::<9, _>(b)),
            id: get::<10, 12, _>(b),
            tick_hz: get_u32::<22, _>(b),
            frame_max_len: get_u16::<26, _>(b),
            features: get_u32::<28, _>(b),
            scene_crc32: get_u32::<32, _>(b),
            reset_cause: ResetCause::from(get_u8::<36, _>(b)),
            last_fault: Fault::try_from(get_u8::<37, _>(b)).ok(),
            fault_detail: get_u32::<38, _>(b),
            state: State::try_from(get_u8::<42, _>(b)).unwrap_or(State::Faulted),
            limits,
            notices,
        })
    }
}

impl BoardLimits {
    fn write(&self) -> [u8; LIMITS_LEN] {
        let mut b = [0; LIMITS_LEN];
        limit::<0, 4>(&mut b, TAG_BITMAP_POOL_BYTES, self.bitmap_pool_bytes.to_le_bytes());
        limit::<6, 1>(&mut b, TAG_RECORDS_MAX, [self.records_max]);
        limit::<9, 2>(&mut b, TAG_RECEIVE_WINDOW_BYTES, self.receive_window_bytes.to_le_bytes());
        limit::<13, 4>(&mut b, TAG_VOLTAGE_MAX_V_PEAK, self.voltage_max_v_peak.to_le_bytes());
        limit::<19, 4>(&mut b, TAG_FULL_SCALE_V_PEAK, self.full_scale_v_peak.to_le_bytes());
        limit::<25, 4>(&mut b, TAG_EDGE_TIME_CONSTANT_S, self.edge_time_constant_s.to_le_bytes());
        limit::<31, 4>(&mut b, TAG_ELECTRODE_CAPACITANCE_MAX_F, self.electrode_capacitance_max_f.to_le_bytes());
        limit::<37, 4>(&mut b, TAG_CURRENT_MAX_A_RMS, self.current_max_a_rms.to_le_bytes());
        limit::<43, 4>(&mut b, TAG_CURRENT_MAX_A_PEAK, self.current_max_a_peak.to_le_bytes());
        limit::<49, 4>(&mut b, TAG_TOUCH_REPORT_PERIOD_S, self.touch_report_period_s.to_le_bytes());
        limit::<55, 4>(&mut b, TAG_TICK_CYCLES_MAX, self.tick_cycles_max.to_le_bytes());
        b
    }

    /// Stores a limit. A limit with an unknown tag or an unexpected length is ignored.
    fn set(&mut self, tag: u8, value: &[u8]) {
        match (tag, value) {
            (TAG_RECORDS_MAX, &[a]) => self.records_max = a,
            (TAG_CORE, &[a]) => self.core = Core::from(a),
            (TAG_RECEIVE_WINDOW_BYTES, &[a, b]) => self.receive_window_bytes = u16::from_le_bytes([a, b]),
            (TAG_BITMAP_POOL_BYTES, &[a, b, c, d]) => self.bitmap_pool_bytes = u32::from_le_bytes([a, b, c, d]),
            (TAG_TICK_CYCLES_MAX, &[a, b, c, d]) => self.tick_cycles_max = u32::from_le_bytes([a, b, c, d]),
            (_, &[a, b, c, d]) => {
                if let Some(limit) = self.real(tag) {
                    *limit = f32::from_le_bytes([a, b, c, d]);
                }
            }
            _ => {}
        }
    }

    /// The `f32` limit with this tag.
    fn real(&mut self, tag: u8) -> Option<&mut f32> {
        match tag {
            TAG_VOLTAGE_MAX_V_PEAK => Some(&mut self.voltage_max_v_peak),
            TAG_FULL_SCALE_V_PEAK => Some(&mut self.full_scale_v_peak),
            TAG_EDGE_TIME_CONSTANT_S => Some(&mut self.edge_time_constant_s),
            TAG_ELECTRODE_CAPACITANCE_MAX_F => Some(&mut self.electrode_capacitance_max_f),
            TAG_CURRENT_MAX_A_RMS => Some(&mut self.current_max_a_rms),
            TAG_CURRENT_MAX_A_PEAK => Some(&mut self.current_max_a_peak),
            TAG_TOUCH_REPORT_PERIOD_S => Some(&mut self.touch_report_period_s),
            TAG_SERIES_RESISTANCE_OHM => Some(&mut self.series_resistance_ohm),
            _ => None,
        }
    }
}

/// Iterates over the tags and values in these bytes. Ends with `None` if the last one is truncated.
fn tagged(mut bytes: &[u8]) -> impl Iterator<Item = Option<(u8, &[u8])>> {
    core::iter::from_fn(move || {
        let (tag, rest) = bytes.split_first()?;
        let value = rest.split_first().and_then(|(len, rest)| rest.split_at_checked(usize::from(*len)));
        bytes = value.map_or(&[], |(_, rest)| rest);
        Some(value.map(|(value, _)| (*tag, value)))
    })
}

/// Writes tag, length and value of a limit.
fn limit<const AT: usize, const N: usize>(b: &mut [u8; LIMITS_LEN], tag: u8, value: [u8; N]) {
    const { assert!(AT + 2 + N <= LIMITS_LEN, "the limit lies outside the layout") };
    if let Some([to_tag, to_len, to @ ..]) = b.get_mut(AT..)
        && let Some(to) = to.first_chunk_mut()
    {
        *to_tag = tag;
        *to_len = N as u8;
        *to = value;
    }
}
