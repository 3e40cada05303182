//! Counting instructions with `SysTick`.

use core::arch::naked_asm;
use core::hint::black_box;
use core::mem::{MaybeUninit, transmute};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_semihosting::hprintln;

/// Equal durations in counts of `SysTick` and in instructions. An instruction takes 1,024 ns: 25.6 counts at the 25 MHz
/// of an MPS2 board with AN385 or AN386, and 20.48 at the 20 MHz of one with AN505.
const COUNTS: u32 = if cfg!(an505) { 512 } else { 128 };
const INSTRUCTIONS: u32 = if cfg!(an505) { 25 } else { 5 };
/// `SysTick` is 24 bits wide.
const WRAP: u32 = 1 << 24;

/// Largest number of cases.
const CASES_MAX: usize = 64;

/// For every case, by number, the input that a debugger traces, counted from 1; zero for no input. The debugger writes
/// it before the image starts, so the start-up code must not clear it.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".uninit.FOLLOWED")]
static mut FOLLOWED: MaybeUninit<[u32; CASES_MAX]> = MaybeUninit::uninit();

/// A debugger starts to trace the case here.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn follow_begin(_case: usize) {
    naked_asm!("bx lr")
}

/// A debugger stops tracing here. This function differs from the other, so that the two are not merged.
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

/// One operation, counted for many inputs.
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
        // SAFETY: in bounds, and any bits are a valid number; nothing writes while the image runs.
        let followed = unsafe { (&raw const FOLLOWED).cast::<u32>().add(self.cases).read_volatile() };
        let number = self.cases;
        self.cases += 1;
        Case { name, number, followed, inputs: 0, instructions: 0, worst_input: 0, sum: 0 }
    }
}

impl Case {
    /// A case that a debugger cannot trace. There may be any number of them.
    pub fn unfollowed() -> Self {
        Self { name: "", number: 0, followed: 0, inputs: 0, instructions: 0, worst_input: 0, sum: 0 }
    }

    /// Returns the largest count, and its input.
    pub fn worst(&self) -> (u32, u32) {
        (self.instructions, self.worst_input)
    }

    /// Counts a call of `function`, minus a call of [`nothing`]: the instructions of call and return are not counted.
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

    /// Writes the largest count, its input, and the mean of all.
    pub fn report(self) {
        let inputs = u64::from(self.inputs).max(1);
        hprintln!("{} {} {} {}", self.name, self.instructions, self.worst_input, self.sum.div_ceil(inputs));
    }
}

/// Number of instructions of [`nothing`] without call, frame and return.
const NOTHING: u32 = 2;

/// An empty function with an ordinary call and an ordinary frame that returns zero. A result in a floating-point
/// register is its first floating-point argument.
#[unsafe(naked)]
extern "C" fn nothing() {
    naked_asm!("push {{r7, lr}}", "mov r7, sp", "movs r0, #0", "movs r1, #0", "pop {{r7, pc}}")
}

/// Number of instructions of a call, including the reads of the timer. All calls go through this one function, so its
/// own overhead is constant.
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
    ((counts * INSTRUCTIONS + COUNTS / 2) / COUNTS, result)
}
