//! State machines of the two PIOs (RP2040, 3, "PIO"), which run at [`MACHINE_HZ`] whatever the clock of the core is.

use frixel_drivers::pio::Instruction;
use rp_pac::pio::Pio;
use rp_pac::pio::regs::{SmPinctrl, SmShiftctrl};

use crate::clock::CORE_HZ;

/// Clock of the state machines, in Hz.
pub(crate) const MACHINE_HZ: u32 = 25_000_000;
/// Cycles of the core in a cycle of a state machine.
pub(crate) const CORE_CYCLES: u32 = CORE_HZ / MACHINE_HZ;

const _: () = assert!(CORE_HZ.is_multiple_of(MACHINE_HZ));

/// A state machine, which runs its program from beginning to end and again.
pub(crate) struct Machine {
    pub(crate) pio: Pio,
    pub(crate) number: usize,
    /// Address of its program in the PIO's memory. The program's jumps contain it.
    pub(crate) address: usize,
}

impl Machine {
    /// Stops the machine, and loads its program. It starts at its beginning, by [`start`].
    pub(crate) fn load(
        &self,
        program: &[Instruction],
        set_pins: impl FnOnce(&mut SmPinctrl),
        set_shift: impl FnOnce(&mut SmShiftctrl),
    ) {
        let Self { pio, number, address } = *self;
        pio.ctrl().modify(|w| {
            w.set_sm_enable(w.sm_enable() & !(1 << number));
            w.set_sm_restart(1 << number);
        });
        for (place, instruction) in (address..).zip(program) {
            pio.instr_mem(place).write(|w| w.set_instr_mem(instruction.word()));
        }
        let machine = pio.sm(number);
        machine.clkdiv().write(|w| w.set_int(CORE_CYCLES as u16));
        machine.execctrl().write(|w| {
            w.set_wrap_bottom(address as u8);
            w.set_wrap_top((address + program.len() - 1) as u8);
            // STATUS_SEL and STATUS_N: the status is all ones while the transmit FIFO holds less than one word. Both
            // chips have the number in the lowest bits, and zero as the selector of the transmit FIFO.
            w.0 |= 1;
        });
        machine.shiftctrl().write(set_shift);
        machine.pinctrl().write(set_pins);
    }

    /// Executes an instruction at once.
    pub(crate) fn execute(&self, instruction: Instruction) {
        self.pio.sm(self.number).instr().write(|w| w.set_instr(instruction.word()));
    }

    /// Writes a word into the transmit FIFO.
    #[inline]
    pub(crate) fn transmit(&self, word: u32) {
        self.pio.txf(self.number).write_value(word);
    }

    /// Whether the machine has taken all words from the transmit FIFO.
    #[inline]
    pub(crate) fn has_taken_all(&self) -> bool {
        self.pio.fstat().read().txempty() & 1 << self.number != 0
    }

    /// The next word of the receive FIFO.
    pub(crate) fn receive(&self) -> Option<u32> {
        let is_empty = self.pio.fstat().read().rxempty() & 1 << self.number != 0;
        (!is_empty).then(|| self.pio.rxf(self.number).read())
    }
}

/// Starts machines of a PIO together.
pub(crate) fn start(pio: Pio, machines: u8) {
    pio.ctrl().modify(|w| {
        w.set_sm_enable(w.sm_enable() | machines);
        w.set_clkdiv_restart(machines);
    });
}
