//! The part of GDB's remote serial protocol that is needed to follow a program: packets `$data#sum`, acknowledged by
//! `+`.

use std::fmt::Write as _;
use std::io::{BufReader, ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Child;
use std::thread;
use std::time::Duration;

/// Wall time within which the emulator must reach a breakpoint.
const WALL_TIMEOUT: Duration = Duration::from_mins(2);

/// Index of the program counter among the registers.
const PROGRAM_COUNTER: usize = 15;

/// A connection to the debugger interface of a halted emulator.
pub(super) struct Gdb(BufReader<TcpStream>);

impl Gdb {
    /// Accepts the connection that the emulator opens.
    pub(super) fn accept(listener: &TcpListener, emulator: &mut Child) -> Result<Self, String> {
        listener.set_nonblocking(true).map_err(|error| explain(&error))?;
        loop {
            match listener.accept() {
                Ok((stream, _)) => {
                    stream.set_nonblocking(false).map_err(|error| explain(&error))?;
                    stream.set_nodelay(true).map_err(|error| explain(&error))?;
                    stream.set_read_timeout(Some(WALL_TIMEOUT)).map_err(|error| explain(&error))?;
                    return Ok(Self(BufReader::new(stream)));
                }
                Err(error) if error.kind() != ErrorKind::WouldBlock => return Err(explain(&error)),
                Err(_) => {}
            }
            if let Some(status) = emulator.try_wait().map_err(|error| explain(&error))? {
                return Err(format!("the emulator does not start with a debugger ({status})"));
            }
            thread::sleep(Duration::from_millis(1));
        }
    }

    /// Writes bytes to memory.
    pub(super) fn write(&mut self, place: u32, bytes: &[u8]) -> Result<(), String> {
        let mut packet = format!("M{place:x},{:x}:", bytes.len());
        for byte in bytes {
            // Writing to a string cannot fail.
            let _ = write!(packet, "{byte:02x}");
        }
        self.expect_ok(&packet)
    }

    /// Sets a breakpoint at an address.
    pub(super) fn set_breakpoint(&mut self, place: u32) -> Result<(), String> {
        self.expect_ok(&format!("Z0,{place:x},2"))
    }

    /// Continues to the next breakpoint.
    pub(super) fn resume(&mut self) -> Result<(), String> {
        self.expect_stop("c")
    }

    /// Executes one instruction.
    pub(super) fn step(&mut self) -> Result<(), String> {
        self.expect_stop("s")
    }

    /// Reads the program counter.
    pub(super) fn program_counter(&mut self) -> Result<u32, String> {
        self.register(PROGRAM_COUNTER)
    }

    /// Reads a core register, counted from r0.
    pub(super) fn register(&mut self, number: usize) -> Result<u32, String> {
        // The answer has all registers, each as eight digits.
        let answer = self.request("g")?;
        let digits = answer.get(8 * number..8 * (number + 1)).unwrap_or_default();
        u32::from_str_radix(digits, 16)
            .map(u32::swap_bytes)
            .map_err(|_| format!("the emulator reports its registers as `{answer}`"))
    }

    fn expect_ok(&mut self, packet: &str) -> Result<(), String> {
        match self.request(packet)?.as_str() {
            "OK" => Ok(()),
            answer => Err(format!("the emulator answers `{packet}` with `{answer}`")),
        }
    }

    /// Expects that the program stops. The emulator answers `T` when the program has stopped, and `W` when it has
    /// exited.
    fn expect_stop(&mut self, packet: &str) -> Result<(), String> {
        match self.request(packet)? {
            answer if answer.starts_with('T') => Ok(()),
            answer => Err(format!("the benchmark image did not reach the case to follow: `{answer}`")),
        }
    }

    fn request(&mut self, packet: &str) -> Result<String, String> {
        let sum = packet.bytes().fold(0_u8, u8::wrapping_add);
        self.0.get_mut().write_all(format!("${packet}#{sum:02x}").as_bytes()).map_err(|error| explain(&error))?;
        let mut answer = Vec::new();
        while self.byte()? != b'$' {}
        loop {
            match self.byte()? {
                b'#' => break,
                byte => answer.push(byte),
            }
        }
        for _ in 0..2 {
            self.byte()?;
        }
        self.0.get_mut().write_all(b"+").map_err(|error| explain(&error))?;
        Ok(String::from_utf8_lossy(&answer).into_owned())
    }

    fn byte(&mut self) -> Result<u8, String> {
        let mut byte = [0];
        self.0.read_exact(&mut byte).map_err(|error| explain(&error))?;
        Ok(byte[0])
    }
}

fn explain(error: &std::io::Error) -> String {
    format!("debugging the benchmark image: {error}")
}
