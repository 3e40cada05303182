//! The board's unique number, of 64 bits.

/// The number of the flash, since the RP2040 has none (data sheet of the W25Q16JV, "Read Unique ID Number", not read).
#[cfg(feature = "rp2040")]
pub(crate) fn unique_number() -> Option<[u8; 8]> {
    let rom = crate::rom::FlashFunctions::find()?;
    Some(rom.without_xip(|| {
        /// The command, and four dummy bytes.
        const COMMAND: [u8; 5] = [0x4b, 0, 0, 0, 0];
        let mut number = [0; 8];
        flash::select(true);
        for byte in COMMAND {
            let _ = flash::exchange(byte);
        }
        for byte in &mut number {
            *byte = flash::exchange(0);
        }
        flash::select(false);
        number
    }))
}

/// The number of the chip (RP2350, 13.10, "Predefined OTP Data Locations": CHIPID0).
#[cfg(feature = "rp2350")]
#[allow(clippy::unnecessary_wraps, reason = "on the other chip, there may be none")]
pub(crate) fn unique_number() -> Option<[u8; 8]> {
    let otp = rp_pac::OTP_DATA;
    let rows = [otp.chipid0(), otp.chipid1(), otp.chipid2(), otp.chipid3()];
    let mut number = [0; 8];
    for (bytes, row) in number.as_chunks_mut::<2>().0.iter_mut().zip(rows) {
        *bytes = row.read().to_le_bytes();
    }
    Some(number)
}

/// The interface of the flash as the boot ROM leaves it: bytes in both directions, with the chip select as software
/// sets it (RP2040, 4.10, "SSI").
#[cfg(feature = "rp2040")]
mod flash {
    use rp_pac::io::vals::Outover;
    use rp_pac::{IO_QSPI, SSI};

    /// Number of the chip select among the pins of the flash.
    const SELECT: usize = 1;
    /// Longest wait for a byte, in reads of a register; 8 clocks of the flash are far shorter.
    const ROUNDS_MAX: u32 = 10_000;

    /// Selects the flash, or not.
    pub(super) fn select(selected: bool) {
        let level = if selected { Outover::LOW } else { Outover::HIGH };
        IO_QSPI.gpio(SELECT).ctrl().modify(|w| w.set_outover(level));
    }

    /// Sends a byte, and returns the one received meanwhile; zero if there is none.
    pub(super) fn exchange(byte: u8) -> u8 {
        SSI.dr0().write_value(u32::from(byte));
        let received = (0..ROUNDS_MAX).any(|_| SSI.sr().read().rfne());
        if received { SSI.dr0().read() as u8 } else { 0 }
    }
}
