//! Drivers of the parts on a driver board, over `embedded-hal` 1.0, `embedded-hal-async` and `embedded-io`. A board's
//! own crate contains only registers and wiring, and implements those traits; the chip models of `frixel-hil-sim`
//! implement them too, and the tests run these drivers against the models.
//!
//! | module | part | traits |
//! |---|---|---|
//! | [`ad5761r`] | 16-bit bipolar DAC | `SpiDevice`, `DelayNs` |
//! | [`bus_handover`] | sharing the DAC's bus with the tick | |
//! | [`zforce`] | optical touch frame | asynchronous `I2c` and `DelayNs`, `InputPin` |
//! | [`polling`] | futures without an executor | |
//! | [`amplifier`] | enable and ready lines of the amplifier | `KickedEnable`, `InputPin` |
//! | [`pin`] | a pin of the processor | `InputPin`, `OutputPin` |
//! | [`monitor`] | the amplifier's monitor output behind an ADC | |
//! | [`arm_switch`] | switch that a person holds | `InputPin` |
//! | [`state_light`] | light that shows the state | `OutputPin` |
//! | [`serial`] | bytes between port and session | `embedded-io` |
//! | [`ring`] | a ring of received bytes, which DMA or an interrupt writes | |
//! | [`fault_record`] | the last fault, kept in RAM over a reset | |
//! | [`i2c_bus_clear`] | freeing an I2C bus whose data line is held low | `OutputPin`, `InputPin`, `DelayNs` |
//! | [`i2c_fifo`] | transfers over the FIFOs of the I2C of the RP2040 and RP2350 | |
//! | [`stm32g4`], [`rp2`] | interpretation of registers of the STM32G4, and of the RP2040 and RP2350 | |
//! | [`pio`] | instructions of the programmable I/O of the RP2040 and RP2350 | |
//!
//! With the feature `defmt`, the errors implement `defmt::Format`.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod ad5761r;
pub mod amplifier;
pub mod arm_switch;
pub mod bus_handover;
pub mod fault_record;
pub mod i2c_bus_clear;
pub mod i2c_fifo;
pub mod monitor;
pub mod pin;
pub mod pio;
pub mod polling;
pub mod ring;
pub mod rp2;
pub mod serial;
pub mod state_light;
pub mod stm32g4;
pub mod zforce;
