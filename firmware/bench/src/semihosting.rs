//! Requests to the emulator: the command line, and an exit on panic.

use core::panic::PanicInfo;

use cortex_m_semihosting::{debug, hprintln, nr, syscall1};

/// Room for the emulator's command line.
pub(crate) const COMMAND_LINE_MAX_LEN: usize = 256;

/// Returns the command line of the image, which may be empty.
pub(crate) fn command_line(buffer: &mut [u8; COMMAND_LINE_MAX_LEN]) -> &[u8] {
    let mut block = [buffer.as_mut_ptr() as usize, buffer.len()];
    // SAFETY: the block is a pointer and the length behind it, as `SYS_GET_CMDLINE` of the semihosting specification
    // takes them; it writes no more than that, and the length of the text into the block.
    let failed = unsafe { syscall1(nr::GET_CMDLINE, block.as_mut_ptr() as usize) } != 0;
    let [_, len] = block;
    if failed { &[] } else { buffer.get(..len).unwrap_or_default() }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}
