//! Frames of the AD5761R, a 16-bit DAC of +-10 V with a reference of its own (Analog Devices data sheet, rev. C).
//!
//! A frame is 24 bits, the most significant first: four zeros, an address, 16 bits of data. The DAC takes a bit at every
//! falling edge of SCLK while SYNC is low, and acts on the frame at the rising edge of SYNC. A frame cut short is
//! ignored.

/// Bytes of a frame.
pub const FRAME_LEN: usize = 3;
/// A frame.
pub type Frame = [u8; FRAME_LEN];

/// Address: write the DAC register, which puts the code out at the rising edge of SYNC whatever LDAC is.
const WRITE_DAC: u8 = 0x3;
/// Address: write the control register.
const WRITE_CONTROL: u8 = 0x4;
/// Address: tell the control register in the next frame.
const READ_CONTROL_ADDRESS: u8 = 0xc;
/// Address: all registers as after power-on, output tied to ground.
const RESET_ADDRESS: u8 = 0xf;

// Control register (data sheet, table 11).
/// CLEAR puts out midscale, which is 0 V.
const CLEAR_TO_MIDSCALE: u16 = 0b01 << 9;
/// Codes are two's complement.
const TWOS_COMPLEMENT: u16 = 1 << 7;
/// An overheated DAC shuts itself off.
const THERMAL_SHUTDOWN: u16 = 1 << 6;
/// The internal reference of 2.5 V.
const INTERNAL_REFERENCE: u16 = 1 << 5;
/// Midscale after power-on.
const POWER_ON_MIDSCALE: u16 = 0b01 << 3;
/// -10 V to 10 V, without overrange.
const RANGE_10_V: u16 = 0b000;

const CONTROL: u16 =
    CLEAR_TO_MIDSCALE | TWOS_COMPLEMENT | THERMAL_SHUTDOWN | INTERNAL_REFERENCE | POWER_ON_MIDSCALE | RANGE_10_V;
/// Bits of the control register that can be written; above them stand what went wrong: brownout, short circuit.
const CONTROL_MASK: u16 = 0x07ff;

/// Puts the DAC into the state after power-on.
pub const RESET: Frame = frame(RESET_ADDRESS, 0);
/// Sets +-10 V, two's complement, the internal reference, and zero as what CLEAR puts out.
pub const CONFIGURE: Frame = frame(WRITE_CONTROL, CONTROL);
/// Asks for the control register, which comes back in the next frame.
pub const READ_CONTROL: Frame = frame(READ_CONTROL_ADDRESS, 0);
/// Does nothing but take the answer to [`READ_CONTROL`].
pub const NOTHING: Frame = frame(0, 0);

/// Puts a code out: 32,767 is one step below 10 V.
pub const fn output(code: i16) -> Frame {
    frame(WRITE_DAC, code.cast_unsigned())
}

/// Whether the frame that came back after [`READ_CONTROL`] shows what [`CONFIGURE`] has set.
pub const fn is_configured(answer: Frame) -> bool {
    let [_, high, low] = answer;
    u16::from_be_bytes([high, low]) & CONTROL_MASK == CONTROL
}

const fn frame(address: u8, data: u16) -> Frame {
    let [high, low] = data.to_be_bytes();
    [address, high, low]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The control register bit by bit, as the data sheet's table lists them from bit 10 down.
    #[test]
    fn the_control_register_is_what_the_data_sheet_wants() {
        let fields = [
            (0b01, 2), // CV: clear to midscale
            (0, 1),    // OVR: no overrange
            (1, 1),    // B2C: two's complement
            (1, 1),    // ETS: thermal shutdown
            (1, 1),    // IRO: internal reference
            (0b01, 2), // PV: midscale after power-on
            (0, 3),    // RA: -10 V to 10 V
        ];
        let register = fields.iter().fold(0_u16, |register, (value, bits)| register << bits | value);
        assert_eq!(CONFIGURE, [0x04, (register >> 8) as u8, register as u8]);
    }

    #[test]
    fn codes_are_twos_complement_behind_the_address() {
        assert_eq!(output(0), [0x03, 0x00, 0x00]);
        assert_eq!(output(1), [0x03, 0x00, 0x01]);
        assert_eq!(output(-1), [0x03, 0xff, 0xff]);
        assert_eq!(output(i16::MAX), [0x03, 0x7f, 0xff]);
        assert_eq!(output(-i16::MAX), [0x03, 0x80, 0x01]);
    }

    #[test]
    fn an_answer_counts_whatever_status_stands_above() {
        let [_, high, low] = CONFIGURE;
        assert!(is_configured([0x0c, high, low]));
        assert!(is_configured([0x0c, high | 0x18, low]), "short circuit and brownout are told apart");
        for wrong in [[0x0c, 0, 0], [0x0c, 0xff, 0xff], [0x0c, high, low ^ 1], [0x0c, high ^ 2, low]] {
            assert!(!is_configured(wrong), "{wrong:02x?}");
        }
    }
}
