//! The start before `main`. The boot ROM reads a few words at the beginning of the flash and starts the image there,
//! with everything else still in the flash; the image then copies its code to RAM, and runs there.
//!
//! | | RP2040 | RP2350 |
//! |---|---|---|
//! | the boot ROM reads | 256 bytes with a checksum, which set the flash up for execution ([`BOOT_2`]) | a block with the type of the image (`IMAGE_DEFINITION`) |
//! | vector table | `0x1000_0100` | `0x1000_0000` |
//! | `Reset` of `cortex-m-rt` | after it | after it |
//! | code and constants, copied by `copy_code` | `0x1000_1000` | `0x1000_1000` |
//!
//! The copy takes 0.1 to 0.7 s, before the clocks run fast. Meanwhile the pins are as the reset has left them: the
//! amplifier's enable and CLEAR pulled low.

use crate::chip::INTERRUPTS;

/// The second stage of the boot (RP2040, 2.8.1.3.1, "Second Stage").
#[cfg(feature = "rp2040")]
#[unsafe(link_section = ".boot")]
#[used]
static BOOT_2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

/// A block with one item, the type of the image: an executable for the Arm cores of an RP2350, in secure state (RP2350,
/// 5.9.5, "Image definitions"; 5.1.5.1, "Block loops"). It is a loop of its own.
#[cfg(feature = "rp2350")]
#[unsafe(link_section = ".boot")]
#[used]
static IMAGE_DEFINITION: [u32; 5] = [
    0xffff_ded3, // Begin.
    0x1021_0142, // `IMAGE_TYPE`, 1 word: executable, secure, Arm, RP2350.
    0x0000_01ff, // `LAST`, after 1 word.
    0,           // The next block: this one.
    0xab12_3579, // End.
];

// Exceptions, with the initial stack pointer, and interrupts.
frixel_cortex_m::runs_from_ram!(16 + INTERRUPTS);
