//! DMA channels (RM0440, "DMA", "DMAMUX"). Channel `n` here is channel `n + 1` of DMA1 in the manual.

use core::sync::atomic::{AtomicU8, Ordering, fence};

use stm32_metapac::bdma::Ch;
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::{DMA1, DMAMUX1};

/// Frames for the DAC.
pub(crate) const DAC: usize = 0;
/// Bytes from the host.
pub(crate) const RECEIVE: usize = 1;
/// Bytes for the host.
pub(crate) const TRANSMIT: usize = 2;
/// Messages of the optical frame, either way.
#[cfg(feature = "optical-frame")]
pub(crate) const OPTICAL_FRAME: usize = 3;

/// Peripherals that request transfers: inputs of DMAMUX1 (RM0440, "DMAMUX1 mapping").
#[derive(Clone, Copy)]
pub(crate) enum Request {
    Spi2Tx = 13,
    #[cfg(feature = "optical-frame")]
    I2c3Rx = 20,
    #[cfg(feature = "optical-frame")]
    I2c3Tx = 21,
    Usart2Rx = 26,
    Usart2Tx = 27,
}

/// Transfers of bytes between memory and a peripheral's data register.
pub(crate) struct Transfer {
    pub(crate) request: Request,
    pub(crate) direction: Dir,
    pub(crate) priority: Pl,
    /// Restarts from the beginning after the last byte.
    pub(crate) circular: bool,
    /// The peripheral's data register.
    pub(crate) register: *mut (),
}

/// Configures a channel for transfers between `memory` and the register. [`begin`] starts them.
pub(crate) fn set_up(channel: usize, transfer: &Transfer, memory: &'static [AtomicU8]) {
    let ch = DMA1.ch(channel);
    stop(ch);
    DMAMUX1.ccr(channel).write(|w| w.set_dmareq_id(transfer.request as u8));
    ch.par().write_value(transfer.register as u32);
    ch.mar().write_value(memory.as_ptr() as u32);
    // Byte size on both sides, which is encoded as zero.
    ch.cr().write(|w| {
        w.set_dir(transfer.direction);
        w.set_pl(transfer.priority);
        w.set_circ(transfer.circular);
        w.set_minc(true);
    });
}

/// Begins to transfer `len` bytes, from the start of the memory. Aborts a transfer that is under way.
pub(crate) fn begin(channel: usize, len: u16) {
    let ch = DMA1.ch(channel);
    stop(ch);
    ch.ndtr().write(|w| w.set_ndt(len));
    // Stores before this fence reach memory before DMA reads it.
    fence(Ordering::SeqCst);
    ch.cr().modify(|w| w.set_en(true));
}

/// Bytes that have not been transferred yet.
pub(crate) fn remaining(channel: usize) -> usize {
    let remaining = usize::from(DMA1.ch(channel).ndtr().read().ndt());
    // Loads after this fence find what DMA has written before.
    fence(Ordering::Acquire);
    remaining
}

fn stop(ch: Ch) {
    ch.cr().modify(|w| w.set_en(false));
}
