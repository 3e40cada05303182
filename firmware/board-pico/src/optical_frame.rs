//! I2C 0 for the optical touch frame of [`frixel_board::optical_frame`]. The FIFOs of 16 bytes are served whenever the
//! main loop polls; between two polls the peripheral holds SCL low, so that no byte is lost (RP2040, 4.3, "I2C").
//!
//! | pin | function | |
//! |---|---|---|
//! | GP16 | I2C0 SDA | |
//! | GP17 | I2C0 SCL | |
//! | GP18 | input, pulled down | data ready |

use core::task::Poll;

use embedded_hal_async::i2c::Operation;
use frixel_board::main_loop::MainLoop;
use frixel_board::optical_frame::{self, BusError, I2cPort};
use frixel_drivers::i2c_fifo::{FifoTransfer, I2cFifos};
use frixel_drivers::pin::DirectPin;
use rp_pac::I2C0;
use rp_pac::i2c::vals::Speed;
use rp_pac::resets::regs::Peripherals;

use crate::board::Pico;
use crate::clock::{self, CORE_HZ};
use crate::pins::{self, Function, OpenDrain, Pin};

const SDA: usize = 16;
const SCL: usize = 17;
const DATA_READY: usize = 18;

/// Cycles of the core in a period of SCL, and in its low part: 400 kHz, low for 1.5 us of 2.5.
const PERIOD: u32 = CORE_HZ / 400_000;
const LOW: u32 = PERIOD * 3 / 5;

/// Takes the bus, and runs the main loop forever with the frame as its touch source.
pub fn run(main_loop: MainLoop<Pico>) -> ! {
    clock::restart(Peripherals::set_i2c0);
    pins::connect_pulled_up(SDA, Function::I2c);
    let mut port = Port(FifoTransfer::default());
    port.give_clock();
    optical_frame::run(main_loop, port, pins::input_pulled_down(DATA_READY))
}

/// I2C 0 at 400 kHz, with the transfer that is under way.
struct Port(FifoTransfer);

impl I2cPort for Port {
    type Clock = DirectPin<OpenDrain>;
    type Data = Pin;

    fn data(&self) -> Pin {
        pins::reads(SDA)
    }

    fn take_clock(&mut self) -> DirectPin<OpenDrain> {
        pins::released(SCL)
    }

    fn give_clock(&mut self) {
        pins::connect_pulled_up(SCL, Function::I2c);
    }

    /// Disables the peripheral, which clears its FIFOs.
    fn stop(&mut self) {
        I2C0.ic_enable().write(|w| w.set_enable(false));
    }

    /// Whether the peripheral has stopped; until then, it ignores configuration (RP2040, 4.3.10, "Disabling").
    fn has_stopped(&mut self) -> bool {
        !I2C0.ic_enable_status().read().ic_en()
    }

    fn begin(&mut self, address: u8, _: &Operation<'_>) {
        // Clears the flags of an earlier transfer.
        let _ = I2C0.ic_clr_intr().read();
        self.0 = FifoTransfer::default();
        enable(address);
    }

    fn poll(&mut self, operation: &mut Operation<'_>) -> Poll<Result<(), BusError>> {
        self.0.receive(&mut Fifos, operation);
        self.0.send(&mut Fifos, operation);
        let status = I2C0.ic_raw_intr_stat().read();
        if status.tx_abrt() {
            // Only a lost arbitration and a missing acknowledgement are possible.
            let lost = I2C0.ic_tx_abrt_source().read().arb_lost();
            return Poll::Ready(Err(if lost { BusError::ArbitrationLoss } else { BusError::NoAcknowledge }));
        }
        // The last byte may have come between the two.
        self.0.receive(&mut Fifos, operation);
        if status.stop_det() && self.0.is_complete(operation) { Poll::Ready(Ok(())) } else { Poll::Pending }
    }
}

/// The FIFOs of I2C 0.
struct Fifos;

impl I2cFifos for Fifos {
    fn has_room(&self) -> bool {
        I2C0.ic_status().read().tfnf()
    }

    fn command(&mut self, write: Option<u8>, is_last: bool) {
        I2C0.ic_data_cmd().write(|w| {
            w.set_cmd(write.is_none());
            w.set_dat(write.unwrap_or(0));
            w.set_stop(is_last);
        });
    }

    fn receive(&mut self) -> Option<u8> {
        I2C0.ic_status().read().rfne().then(|| I2C0.ic_data_cmd().read().dat())
    }
}

/// Configures the peripheral, which is disabled, as controller for this target, and enables it.
fn enable(address: u8) {
    I2C0.ic_con().write(|w| {
        w.set_master_mode(true);
        w.set_speed(Speed::FAST);
        w.set_ic_restart_en(true);
        w.set_ic_slave_disable(true);
    });
    I2C0.ic_tar().write(|w| w.set_ic_tar(u16::from(address)));
    I2C0.ic_fs_scl_hcnt().write(|w| w.set_ic_fs_scl_hcnt((PERIOD - LOW) as u16));
    I2C0.ic_fs_scl_lcnt().write(|w| w.set_ic_fs_scl_lcnt(LOW as u16));
    // Spikes of up to 50 ns are filtered; SDA changes 300 ns after SCL has fallen.
    I2C0.ic_fs_spklen().write(|w| w.set_ic_fs_spklen((CORE_HZ / 20_000_000) as u8));
    I2C0.ic_sda_hold().modify(|w| w.set_ic_sda_tx_hold((CORE_HZ / 10_000_000 * 3 + 1) as u16));
    I2C0.ic_enable().write(|w| w.set_enable(true));
}
