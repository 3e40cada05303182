//! Counting instructions with SysTick.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_semihosting::hprintln;

/// SysTick runs at 25 MHz, and an instruction takes 1,024 ns: 25.6 counts.
const COUNTS_PER_FIVE_INSTRUCTIONS: u32 = 128;
/// SysTick is 24 bits wide.
const WRAP: u32 = 1 << 24;

/// Counts instructions.
pub struct Counter {
    _systick: SYST,
}

/// The largest count so far.
pub struct Worst {
    instructions: u32,
    input: u32,
    inputs: u32,
}

impl Counter {
    /// Starts the timer.
    pub fn new(mut systick: SYST) -> Self {
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(WRAP - 1);
        systick.clear_current();
        systick.enable_counter();
        Self { _systick: systick }
    }

    /// Instructions of `run`, and those of reading the timer.
    #[inline(always)]
    pub fn count<T>(&self, run: impl FnOnce() -> T) -> (u32, T) {
        let begin = SYST::get_current();
        let result = run();
        let end = SYST::get_current();
        let counts = begin.wrapping_sub(end) % WRAP;
        ((counts * 5 + COUNTS_PER_FIVE_INSTRUCTIONS / 2) / COUNTS_PER_FIVE_INSTRUCTIONS, result)
    }
}

impl Worst {
    /// Nothing was counted yet.
    pub const fn new() -> Self {
        Self { instructions: 0, input: 0, inputs: 0 }
    }

    /// Takes the count of the next input.
    pub fn take(&mut self, instructions: u32) {
        if instructions > self.instructions {
            self.instructions = instructions;
            self.input = self.inputs;
        }
        self.inputs += 1;
    }

    /// Tells the largest count.
    pub fn report(&self, name: &str) {
        hprintln!("{} {} {}", name, self.instructions, self.input);
    }
}
