//! The optical touch frame, a Neonode zForce module on I2C3, by DMA: a transfer is begun, looked after, and given up when it
//! takes too long, all without waiting (RM0440, "I2C": "I2C master mode", "DMA requests").
//!
//! The module lies along the top edge of the screen, its corner at the screen's.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC8 | I2C3_SCL | |
//! | PC9 | I2C3_SDA | |
//! | PD2 | input, pulled down | data ready |

use core::sync::atomic::{AtomicU8, Ordering};

use frixel_parts::zforce::{self, ENABLE, I2C_ADDRESS, LENGTH_LEN, MESSAGE_MAX_LEN, Message, SET_FREQUENCY};
use frixel_render::Touch;
use stm32_metapac::bdma::vals::{Dir as DmaDir, Pl};
use stm32_metapac::i2c::vals::{Autoend, Dir};
use stm32_metapac::rcc::vals::I2csel;
use stm32_metapac::{GPIOC, GPIOD, I2C3, RCC};

use crate::board::TICK_HZ;
use crate::{dma, pins};

const SCL: u32 = 8;
const SDA: u32 = 9;
const DATA_READY: u32 = 2;
const I2C3_FUNCTION: u8 = 8;

/// Longest that a transfer may take: the longest message is 2.9 ms on the bus, and the module may stretch the clock.
const TRANSFER_TICKS: u32 = TICK_HZ / 1000 * 6;
/// After a transfer that failed, the module is left alone for so long.
const REST_TICKS: u32 = TICK_HZ / 10;
/// Age of a place when it is read: two scans at 200 Hz, one that sees the finger and one that is reported. To be measured
/// at bring-up.
const AGE_TICKS: u32 = TICK_HZ / 100;

/// In the memory for DMA (`memory.x`); what DMA has not written is written before it is read.
#[unsafe(link_section = ".dma.BYTES")]
static BYTES: [AtomicU8; MESSAGE_MAX_LEN] = [const { AtomicU8::new(0) }; MESSAGE_MAX_LEN];

/// What is under way.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Doing {
    Nothing,
    Request,
    Length,
    Message(usize),
    Resting,
}

/// The frame.
pub struct OpticalFrame {
    doing: Doing,
    since_tick: u32,
    /// Requests that the module has had since it started.
    requests: usize,
}

/// How a transfer stands.
enum Transfer {
    UnderWay,
    Done,
    Failed,
}

impl OpticalFrame {
    /// Takes the bus, at 400 kHz.
    pub fn new() -> Self {
        RCC.ccipr().modify(|w| w.set_i2c3sel(I2csel::HSI));
        pins::alternate_open_drain(GPIOC, SCL, I2C3_FUNCTION);
        pins::alternate_open_drain(GPIOC, SDA, I2C3_FUNCTION);
        pins::input_pulled_down(GPIOD, DATA_READY);
        enable();
        Self { doing: Doing::Nothing, since_tick: 0, requests: 0 }
    }

    /// Does the next small thing that there is to do. To be called again and again.
    pub fn step(&mut self, now_tick: u32) -> Option<Touch> {
        match self.doing {
            Doing::Nothing => self.begin(now_tick),
            Doing::Resting if now_tick.wrapping_sub(self.since_tick) > REST_TICKS => self.doing = Doing::Nothing,
            Doing::Resting => {}
            Doing::Request | Doing::Length | Doing::Message(_) => match self.transfer(now_tick) {
                Transfer::UnderWay => {}
                Transfer::Done => return self.done(now_tick),
                Transfer::Failed => self.rest(now_tick),
            },
        }
        None
    }

    fn begin(&mut self, now_tick: u32) {
        let requests: [&[u8]; 2] = [&SET_FREQUENCY, &ENABLE];
        self.since_tick = now_tick;
        if let Some(request) = requests.get(self.requests) {
            self.requests += 1;
            self.doing = Doing::Request;
            write(request);
        } else if pins::is_high(GPIOD, DATA_READY) {
            self.doing = Doing::Length;
            read(LENGTH_LEN);
        }
    }

    fn done(&mut self, now_tick: u32) -> Option<Touch> {
        let mut bytes = [0; MESSAGE_MAX_LEN];
        for (to, from) in bytes.iter_mut().zip(&BYTES) {
            *to = from.load(Ordering::Relaxed);
        }
        match self.doing {
            Doing::Length => {
                let length = bytes.first_chunk().copied().unwrap_or_default();
                if let Some(len) = zforce::message_len(length) {
                    self.since_tick = now_tick;
                    self.doing = Doing::Message(len);
                    read(len);
                } else {
                    self.rest(now_tick);
                }
                None
            }
            Doing::Message(len) => {
                self.doing = Doing::Nothing;
                self.report(zforce::parse(bytes.get(..len).unwrap_or_default()))
            }
            _ => {
                self.doing = Doing::Nothing;
                None
            }
        }
    }

    fn report(&mut self, message: Message) -> Option<Touch> {
        match message {
            Message::Down { x_m, y_m } => Some(Touch::Down { x_m, y_m, age_ticks: AGE_TICKS }),
            Message::Up => Some(Touch::Up),
            Message::Started => {
                self.requests = 0;
                None
            }
            Message::Other => None,
        }
    }

    fn transfer(&self, now_tick: u32) -> Transfer {
        let status = I2C3.isr().read();
        if status.nackf() || status.berr() || status.arlo() || now_tick.wrapping_sub(self.since_tick) > TRANSFER_TICKS {
            Transfer::Failed
        } else if status.stopf() {
            I2C3.icr().write(|w| w.set_stopcf(true));
            Transfer::Done
        } else {
            Transfer::UnderWay
        }
    }

    /// Lets go of the bus, and tells the module everything anew later.
    fn rest(&mut self, now_tick: u32) {
        // Off for three clocks, which clears all that is under way (RM0440, "Software reset" of I2C).
        I2C3.cr1().write(|w| w.set_pe(false));
        for _ in 0..3 {
            let _ = I2C3.cr1().read();
        }
        enable();
        self.requests = 0;
        self.doing = Doing::Resting;
        self.since_tick = now_tick;
    }
}

/// 400 kHz from 16 MHz (RM0440, "I2C": "`I2C_TIMINGR` register configuration examples").
fn enable() {
    I2C3.timingr().write(|w| {
        w.set_presc(1);
        w.set_scll(9);
        w.set_sclh(3);
        w.set_sdadel(2);
        w.set_scldel(3);
    });
    I2C3.cr1().write(|w| {
        w.set_txdmaen(true);
        w.set_rxdmaen(true);
        w.set_pe(true);
    });
}

fn write(request: &[u8]) {
    for (to, from) in BYTES.iter().zip(request) {
        to.store(*from, Ordering::Relaxed);
    }
    let register = I2C3.txdr().as_ptr().cast();
    begin(Dir::WRITE, dma::Request::I2c3Tx, DmaDir::FROM_MEMORY, register, request.len());
}

fn read(len: usize) {
    let register = I2C3.rxdr().as_ptr().cast();
    begin(Dir::READ, dma::Request::I2c3Rx, DmaDir::FROM_PERIPHERAL, register, len);
}

fn begin(dir: Dir, request: dma::Request, direction: DmaDir, register: *mut (), len: usize) {
    let transfer = dma::Transfer { request, direction, priority: Pl::LOW, circular: false, register };
    dma::set_up(dma::OPTICAL_FRAME, &transfer, &BYTES);
    dma::begin(dma::OPTICAL_FRAME, len as u16);
    I2C3.cr2().write(|w| {
        w.set_sadd(u16::from(I2C_ADDRESS) << 1);
        w.set_dir(dir);
        w.set_nbytes(len as u8);
        w.set_autoend(Autoend::AUTOMATIC);
        w.set_start(true);
    });
}
