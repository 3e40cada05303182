//! Follows the benchmark image instruction by instruction, in the manner of a debugger.

use std::collections::HashMap;
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use object::{Object, ObjectSegment, ObjectSymbol};

use super::cycles::cycles;
use super::gdb::Gdb;
use crate::command::bytes;

/// Words of the image's `nothing` that are not its frame: they were added to the timer's count.
const NOTHING: Seen = Seen { instructions: 2, cycles: 2 };

/// Instructions and cycles of a case at its worst input, without call and return.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Seen {
    pub(super) instructions: u64,
    pub(super) cycles: u64,
}

/// Kills the emulator on drop.
struct Emulator(Child);

impl Drop for Emulator {
    fn drop(&mut self) {
        // Ignore the error if the emulator has already exited.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs the image in `emulator` and follows each case in order at its given input.
pub(super) fn follow(mut emulator: Command, image: &Path, inputs: &[u32]) -> Result<Vec<Seen>, String> {
    let code = Code::read(image)?;
    let listener = TcpListener::bind("127.0.0.1:0").map_err(|error| format!("listening to a debugger: {error}"))?;
    let address = listener.local_addr().map_err(|error| format!("listening to a debugger: {error}"))?;
    let line = format!("socket,id=gdb,host={},port={},nodelay=on", address.ip(), address.port());
    let emulator = emulator
        .args(["-S", "-chardev", &line, "-gdb", "chardev:gdb"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("the emulator could not be started: {error}"))?;
    let mut emulator = Emulator(emulator);
    let mut gdb = Gdb::accept(&listener, &mut emulator.0)?;
    let words: Vec<u8> = inputs.iter().flat_map(|input| input.to_le_bytes()).collect();
    gdb.write(code.symbol("FOLLOWED")?, &words)?;
    let (begin, end) = (code.symbol("follow_begin")? & !1, code.symbol("follow_end")? & !1);
    gdb.set_breakpoint(begin)?;
    let mut seen = vec![Seen::default(); inputs.len()];
    for _ in inputs {
        let (case, empty) = span(&mut gdb, &code, end)?;
        let (_, full) = span(&mut gdb, &code, end)?;
        let seen = seen.get_mut(case as usize).ok_or("the benchmark follows a case that was not requested")?;
        seen.instructions = full.instructions + NOTHING.instructions - empty.instructions;
        seen.cycles = full.cycles + NOTHING.cycles - empty.cycles;
    }
    Ok(seen)
}

/// Continues to the start of the next case, reads its number, and steps through it to the end.
fn span(gdb: &mut Gdb, code: &Code, end: u32) -> Result<(u32, Seen), String> {
    gdb.resume()?;
    let case = gdb.register(0)?;
    let mut seen = Seen::default();
    let mut place = gdb.program_counter()?;
    while place != end {
        let (first, second) = code.instruction(place)?;
        gdb.step()?;
        let next = gdb.program_counter()?;
        seen.instructions += 1;
        seen.cycles += cycles(first, second, place, next);
        place = next;
    }
    Ok((case, seen))
}

/// The code and the symbols of the image.
struct Code {
    halfwords: HashMap<u32, u16>,
    symbols: HashMap<String, u32>,
}

impl Code {
    fn read(image: &Path) -> Result<Self, String> {
        let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", image.display());
        let bytes = bytes(image)?;
        let file = object::File::parse(&*bytes).map_err(|error| explain(&error))?;
        let mut halfwords = HashMap::new();
        for segment in file.segments() {
            let data = segment.data().map_err(|error| explain(&error))?;
            let start = segment.address() as u32;
            halfwords.extend((start..).step_by(2).zip(data.as_chunks().0.iter().map(|b| u16::from_le_bytes(*b))));
        }
        let symbols = file
            .symbols()
            .filter_map(|symbol| symbol.name().ok().map(|name| (name.to_owned(), symbol.address() as u32)))
            .collect();
        Ok(Self { halfwords, symbols })
    }

    fn symbol(&self, name: &str) -> Result<u32, String> {
        self.symbols.get(name).copied().ok_or_else(|| format!("the benchmark image has no symbol {name}"))
    }

    /// The halfwords of the instruction at an address; the second is undefined if the instruction has only one.
    fn instruction(&self, place: u32) -> Result<(u16, u16), String> {
        let halfword = |place| self.halfwords.get(&place).copied();
        let first =
            halfword(place).ok_or_else(|| format!("the benchmark image runs where it has no code, {place:#x}"))?;
        Ok((first, halfword(place + 2).unwrap_or_default()))
    }
}
