//! Counting instructions with `SysTick`.

use core::arch::naked_asm;
use core::hint::black_box;
use core::mem::{MaybeUninit, transmute};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_semihosting::hprintln;

/// `SysTick` runs at 25 MHz, and an instruction takes 1,024 ns: 25.6 counts.
const COUNTS_OF_FIVE_INSTRUCTIONS: u32 = 128;
/// `SysTick` is 24 bits wide.
const WRAP: u32 = 1 << 24;

/// Most cases.
const CASES_MAX: usize = 64;

/// For every case, by number, the input that a debugger wants to follow, counted from 1; zero for none. The debugger
/// writes it before the image starts, so the start-up code must not clear it.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".uninit.FOLLOWED")]
static mut FOLLOWED: MaybeUninit<[u32; CASES_MAX]> = MaybeUninit::uninit();

/// A debugger follows this case from here.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn follow_begin(_case: usize) {
    naked_asm!("bx lr")
}

/// A debugger follows to here. The two differ, so that they are not made one.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn follow_end() {
    naked_asm!("nop", "bx lr")
}

/// Counts instructions.
pub struct Counter {
    _systick: SYST,
    cases: usize,
}

/// One thing that is counted for many inputs.
pub struct Case {
    name: &'static str,
    number: usize,
    followed: u32,
    inputs: u32,
    instructions: u32,
    worst_input: u32,
    sum: u64,
}

impl Counter {
    /// Starts the timer.
    pub fn new(mut systick: SYST) -> Self {
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(WRAP - 1);
        systick.clear_current();
        systick.enable_counter();
        Self { _systick: systick, cases: 0 }
    }

    /// Begins the next case.
    pub fn case(&mut self, name: &'static str) -> Case {
        assert!(self.cases < CASES_MAX, "more cases than a debugger can tell inputs for");
        // SAFETY: in bounds, and any bits are a number; nobody writes while the image runs.
        let followed = unsafe { (&raw const FOLLOWED).cast::<u32>().add(self.cases).read_volatile() };
        let number = self.cases;
        self.cases += 1;
        Case { name, number, followed, inputs: 0, instructions: 0, worst_input: 0, sum: 0 }
    }
}

impl Case {
    /// A case that no debugger follows, of which there may be any number.
    pub fn unfollowed() -> Self {
        Self { name: "", number: 0, followed: 0, inputs: 0, instructions: 0, worst_input: 0, sum: 0 }
    }

    /// The largest count, and its input.
    pub fn worst(&self) -> (u32, u32) {
        (self.instructions, self.worst_input)
    }

    /// Counts a call of `function`, less a call of [`nothing`]: call and return are left out.
    pub fn take<S, T: Copy, R>(&mut self, function: fn(&mut S, T) -> R, state: &mut S, input: T) -> R {
        self.inputs += 1;
        let followed = (self.inputs == self.followed).then_some(self.number);
        // SAFETY: `nothing` takes whatever is in the registers, and returns zero or its argument, which are an `R`.
        let nothing = unsafe { transmute::<extern "C" fn(), fn(&mut S, T) -> R>(nothing) };
        let (call, _) = count(black_box(nothing), state, input, followed);
        let (gross, result) = count(black_box(function), state, input, followed);
        let net = gross - call + NOTHING;
        self.sum += u64::from(net);
        if net > self.instructions {
            self.instructions = net;
            self.worst_input = self.inputs;
        }
        result
    }

    /// Tells the largest count, its input, and the mean of all.
    pub fn report(self) {
        let inputs = u64::from(self.inputs).max(1);
        hprintln!("{} {} {} {}", self.name, self.instructions, self.worst_input, self.sum.div_ceil(inputs));
    }
}

/// Instructions that [`nothing`] takes beside call, frame and return.
const NOTHING: u32 = 2;

/// A function that is called like any other, sets up its frame like any other, and returns zero. A result in a
/// floating-point register is the first argument in one.
#[unsafe(naked)]
extern "C" fn nothing() {
    naked_asm!("push {{r7, lr}}", "mov r7, sp", "movs r0, #0", "movs r1, #0", "pop {{r7, pc}}")
}

/// Instructions of a call, with those of reading the timer. One function for all that is called, so that these are the
/// same.
#[inline(never)]
fn count<S, T, R>(function: fn(&mut S, T) -> R, state: &mut S, input: T, followed: Option<usize>) -> (u32, R) {
    if let Some(case) = followed {
        follow_begin(case);
    }
    let begin = SYST::get_current();
    let result = function(state, input);
    let end = SYST::get_current();
    if followed.is_some() {
        follow_end();
    }
    let counts = begin.wrapping_sub(end) % WRAP;
    ((counts * 5 + COUNTS_OF_FIVE_INSTRUCTIONS / 2) / COUNTS_OF_FIVE_INSTRUCTIONS, result)
}
