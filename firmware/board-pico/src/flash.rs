//! The part of the flash that holds the limits: after the first MiB, which belongs to the image. This image only reads
//! it.

use core::ptr;

use frixel_drivers::rp2::LIMITS_OFFSET;
use frixel_session::store::Flash;

/// Address at which the flash is mapped.
const FLASH: u32 = 0x1000_0000;
/// Number of bytes that are read: one page for each copy of the limits.
const LEN: u32 = 2 * StoreFlash::PAGE_LEN;

/// The flash after the image.
pub struct StoreFlash;

impl Flash for StoreFlash {
    const PAGE_LEN: u32 = 4096;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let end = offset.checked_add(bytes.len() as u32);
        if end.is_none_or(|end| end > LEN) {
            return false;
        }
        for (address, byte) in (FLASH + LIMITS_OFFSET + offset..).zip(bytes) {
            // SAFETY: the address lies in the flash, as checked above, and any byte there is valid.
            *byte = unsafe { ptr::with_exposed_provenance::<u8>(address as usize).read_volatile() };
        }
        true
    }
}
