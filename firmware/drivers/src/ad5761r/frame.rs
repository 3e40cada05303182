//! Frames and control register of the AD5761R (Analog Devices data sheet, rev. C, "Input shift register" and
//! "Control register").
//!
//! A frame is 24 bits, most significant first: four zeros, a 4-bit address, 16 bits of data. The DAC samples a bit at
//! every falling edge of SCLK while SYNC is low, and executes the frame at the rising edge of SYNC. It ignores a
//! truncated frame.

use frixel_wire::dac_code::DacCode;

/// Bytes of a frame.
pub const FRAME_LEN: usize = 3;
/// A frame as it goes over the bus.
pub type Frame = [u8; FRAME_LEN];

/// Address: write the DAC register and update the output at the rising edge of SYNC, regardless of LDAC.
const WRITE_DAC: u8 = 0x3;
/// Address: write the control register.
const WRITE_CONTROL: u8 = 0x4;
/// Address: shift the control register out with the next frame.
const READ_CONTROL_ADDRESS: u8 = 0xc;
/// Address: set all registers to their values after power-on and clamp the output to ground.
const RESET_ADDRESS: u8 = 0xf;

// Control register (data sheet, table 11).
/// CV: CLEAR sets the output to midscale, which is 0 V.
const CLEAR_TO_MIDSCALE: u16 = 0b01 << 9;
/// B2C: codes are two's complement.
const TWOS_COMPLEMENT: u16 = 1 << 7;
/// ETS: the DAC switches itself off when it overheats.
const THERMAL_SHUTDOWN: u16 = 1 << 6;
/// IRO: the internal reference of 2.5 V is on.
const INTERNAL_REFERENCE: u16 = 1 << 5;
/// PV: midscale after power-on.
const POWER_ON_MIDSCALE: u16 = 0b01 << 3;
/// RA: -10 V to 10 V.
const RANGE_10_V: u16 = 0b000;

const CONFIGURATION: u16 =
    CLEAR_TO_MIDSCALE | TWOS_COMPLEMENT | THERMAL_SHUTDOWN | INTERNAL_REFERENCE | POWER_ON_MIDSCALE | RANGE_10_V;
/// The bits of the control register that can be written.
const CONFIGURATION_MASK: u16 = 0x07ff;
/// BO: the supply has dipped since the control register was last written.
const BROWN_OUT: u16 = 1 << 11;
/// SC: the output has been short-circuited since the control register was last written.
const SHORT_CIRCUIT: u16 = 1 << 12;

/// Sets all registers to their values after power-on.
pub const RESET: Frame = frame(RESET_ADDRESS, 0);
/// Selects -10 V to 10 V, two's complement, the internal reference, and 0 V as the value of CLEAR.
pub const CONFIGURE: Frame = frame(WRITE_CONTROL, CONFIGURATION);
/// Requests the control register, which the DAC shifts out with the next frame.
pub const READ_CONTROL: Frame = frame(READ_CONTROL_ADDRESS, 0);
/// Has no effect, but clocks out the answer to [`READ_CONTROL`].
pub const NO_OPERATION: Frame = frame(0, 0);

/// Sets the output: a code is a fraction of 10 V.
pub const fn output(code: DacCode) -> Frame {
    frame(WRITE_DAC, code.bits().cast_unsigned())
}

const fn frame(address: u8, data: u16) -> Frame {
    let [high, low] = data.to_be_bytes();
    [address, high, low]
}

/// The control register as it was read back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Control(pub u16);

impl Control {
    /// The register in the frame that the DAC shifted out after [`READ_CONTROL`].
    pub const fn of_frame(frame: Frame) -> Self {
        let [_, high, low] = frame;
        Self(u16::from_be_bytes([high, low]))
    }

    /// Whether range, coding and reference match [`CONFIGURE`].
    pub const fn is_configured(self) -> bool {
        self.0 & CONFIGURATION_MASK == CONFIGURATION
    }

    /// Whether the supply has dipped since the register was last written.
    pub const fn has_brown_out(self) -> bool {
        self.0 & BROWN_OUT != 0
    }

    /// Whether the output has been short-circuited since the register was last written.
    pub const fn has_short_circuit(self) -> bool {
        self.0 & SHORT_CIRCUIT != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The control register bit by bit, as the data sheet's table lists them from bit 10 down.
    #[test]
    fn the_configuration_matches_the_data_sheet() {
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
}
