//! Computes how deep the stack of a board's image can get, from its machine code: the bytes that every function puts on
//! the stack, and the functions that it calls.
//!
//! The stack of panics and faults is not included: they end the program, and if the stack then overflows, the
//! resulting fault has a handler with its own stack.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use object::elf::STT_FUNC;
use object::read::elf::{FileHeader, Sym as _};
use object::{Endianness, Object, ObjectSection, ObjectSymbol};

use super::thumb::{Instruction, decode};
use crate::command::bytes;

/// Bytes that an exception puts on the stack, with floating-point state and alignment (Armv7-M architecture reference,
/// B1.5.6).
const EXCEPTION_BYTES: u64 = 27 * 4;
/// Parts of the names of functions that end the program; the last one overflows the stack for a test.
const ENDS: [&str; 5] = ["panic", "rust_begin_unwind", "5fault15Ending", "5fault5never", "15fault_injection8overflow"];

/// Part of the names of functions that format texts and numbers.
const FORMATS: &str = "4core3fmt";

/// Prefix of the names of functions that the linker outlined from several functions.
const OUTLINED: &str = "OUTLINED_FUNCTION";

/// Parts of the names of functions that divide by a number that is never zero: the length of a queue.
const DIVIDES: [&str; 1] = ["8heapless4spsc"];

/// A function of the image.
#[derive(Default)]
struct Function {
    name: String,
    len: u32,
    own_bytes: u64,
    calls: Vec<u32>,
    /// Registers through which the function calls.
    called_registers: BTreeSet<u8>,
    /// Registers that the function loads words into, with the addresses of the words.
    loads: Vec<(u8, u32)>,
    calls_register: bool,
    moves_stack: bool,
}

/// The functions of an image by address.
pub(super) struct Functions(BTreeMap<u32, Function>);

impl Functions {
    /// Reads the functions of an image.
    pub(super) fn read(image: &Path) -> Result<Self, String> {
        let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", image.display());
        let bytes = bytes(image)?;
        let file = object::read::elf::ElfFile32::<Endianness>::parse(&*bytes).map_err(|error| explain(&error))?;
        let endian = file.elf_header().endian().map_err(|error| explain(&error))?;
        let mut functions = BTreeMap::new();
        // Mapping symbols: code begins at `$t`, and tables and literals begin at `$d`.
        let mut kinds = BTreeMap::new();
        for symbol in file.symbols() {
            let (name, address) = (symbol.name().unwrap_or_default(), symbol.address() as u32);
            match name.get(..2) {
                Some("$t") => drop(kinds.insert(address, true)),
                Some("$d") => drop(kinds.insert(address, false)),
                _ if symbol.elf_symbol().st_type() == STT_FUNC && symbol.size() > 0 => {
                    let len = symbol.elf_symbol().st_size(endian);
                    functions.insert(address & !1, Function { name: name.to_owned(), len, ..Function::default() });
                }
                _ => {}
            }
        }
        // Images that run from RAM have their code in a section of their own.
        let text = file.section_by_name(".code").or_else(|| file.section_by_name(".text"));
        let text = text.ok_or_else(|| explain(&"no section .code or .text"))?;
        let code = text.data().map_err(|error| explain(&error))?;
        let start = text.address() as u32;
        let is_code = |place: u32| kinds.range(..=place).next_back().is_some_and(|(_, code)| *code);
        let addresses: BTreeSet<u32> = functions.keys().copied().collect();
        for (address, function) in &mut functions {
            let range = address.checked_sub(start).map(|from| from as usize..(from + function.len) as usize);
            function.scan(*address, range.and_then(|range| code.get(range)).unwrap_or_default(), &is_code);
        }
        call_for_outlined(&mut functions);
        for function in functions.values_mut() {
            function.look_up_calls(|place| {
                let from = place.checked_sub(start)? as usize;
                let bytes = code.get(from..)?.first_chunk()?;
                let word = u32::from_le_bytes(*bytes);
                (word & 1 == 1 && addresses.contains(&(word & !1))).then_some(word & !1)
            });
        }
        Ok(Self(functions))
    }

    /// Largest depth of the stack in bytes: the main program, and on top of it all of `exceptions`, each interrupting
    /// the one before.
    pub(super) fn depth(&self, main: &str, exceptions: &[&str]) -> Result<u64, String> {
        let mut bytes = self.depth_of(main)?;
        for exception in exceptions {
            bytes += EXCEPTION_BYTES + self.depth_of(exception)?;
        }
        // A hard fault also starts with a frame on this stack.
        Ok(bytes + EXCEPTION_BYTES)
    }

    /// Leaves out the formatting of texts and numbers, whose calls through tables cannot be followed.
    pub(super) fn without_formatting(mut self) -> Self {
        let formats: BTreeSet<u32> = self
            .0
            .iter()
            .filter(|(_, function)| function.name.contains(FORMATS))
            .map(|(address, _)| *address)
            .collect();
        for function in self.0.values_mut() {
            function.calls.retain(|call| !formats.contains(call));
        }
        self
    }

    /// The bytes of code that a function runs. Fails if it can end the program; the error states where.
    pub(super) fn code_that_never_ends(&self, name: &str) -> Result<u64, String> {
        let (mut open, mut seen, mut bytes) = (vec![self.address_of(name)?], BTreeSet::new(), 0);
        while let Some(address) = open.pop() {
            let Some(function) = self.0.get(&address).filter(|_| seen.insert(address)) else { continue };
            bytes += u64::from(function.len);
            if DIVIDES.iter().any(|divides| function.name.contains(divides)) {
                continue;
            }
            let called = function.calls.iter().filter_map(|call| self.0.get(call));
            if let Some(end) = called.clone().find(|called| ENDS.iter().any(|end| called.name.contains(end))) {
                return Err(format!("{name} can end in {}, by way of {}", end.name, function.name));
            }
            open.extend(&function.calls);
        }
        Ok(bytes)
    }

    fn depth_of(&self, name: &str) -> Result<u64, String> {
        self.from(self.address_of(name)?, &mut Vec::new(), &mut BTreeMap::new())
    }

    fn address_of(&self, name: &str) -> Result<u32, String> {
        let found = self.0.iter().find(|(_, function)| function.name == name);
        found.map(|(address, _)| *address).ok_or_else(|| format!("the image has no function {name}"))
    }

    /// Depth of the stack from a function on. `path` is the chain of calls to it; `known` caches the depths computed so
    /// far.
    fn from(&self, address: u32, path: &mut Vec<u32>, known: &mut BTreeMap<u32, u64>) -> Result<u64, String> {
        if let Some(bytes) = known.get(&address) {
            return Ok(*bytes);
        }
        let function = self.0.get(&address).ok_or_else(|| format!("nothing is known of the code at {address:#x}"))?;
        if ENDS.iter().any(|end| function.name.contains(end)) {
            return Ok(0);
        }
        if path.contains(&address) {
            return Err(format!("{} calls itself", function.name));
        }
        if function.calls_register || function.moves_stack {
            return Err(format!("{} makes an indirect call, or moves the stack pointer by a register", function.name));
        }
        path.push(address);
        let mut deepest = 0;
        for call in &function.calls {
            deepest = deepest.max(self.from(*call, path, known)?);
        }
        path.pop();
        known.insert(address, function.own_bytes + deepest);
        Ok(function.own_bytes + deepest)
    }
}

/// An outlined function may end in a call through a register that its caller has loaded. Such a call is attributed
/// to the caller.
fn call_for_outlined(functions: &mut BTreeMap<u32, Function>) {
    let mut outlined = BTreeMap::new();
    for (address, function) in functions.iter_mut().filter(|(_, function)| function.name.starts_with(OUTLINED)) {
        let loads = &function.loads;
        let theirs = |register: &u8| !loads.iter().any(|(to, _)| to == register);
        let registers: BTreeSet<u8> = function.called_registers.iter().copied().filter(theirs).collect();
        function.called_registers.retain(|register| !registers.contains(register));
        outlined.insert(*address, registers);
    }
    for function in functions.values_mut() {
        let registers = function.calls.iter().filter_map(|call| outlined.get(call)).flatten();
        function.called_registers.extend(registers);
    }
}

impl Function {
    /// Decodes every instruction. All stack growth in the function is added up, independent of the path of execution.
    fn scan(&mut self, address: u32, code: &[u8], is_code: &dyn Fn(u32) -> bool) {
        let end = address + self.len;
        let halfwords: Vec<u16> = code.as_chunks().0.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect();
        let mut index = 0;
        while let Some(first) = halfwords.get(index) {
            let second = halfwords.get(index + 1).copied().unwrap_or_default();
            let place = address + 2 * index as u32;
            if !is_code(place) {
                index += 1;
                continue;
            }
            match decode(*first, second, place) {
                Instruction::Push(bytes) => self.own_bytes += u64::from(bytes),
                Instruction::Call(target) => self.calls.push(target),
                Instruction::Branch(target) if !(address..end).contains(&target) => self.calls.push(target),
                Instruction::CallRegister(register) => drop(self.called_registers.insert(register)),
                Instruction::LoadWord(register, from) => self.loads.push((register, from)),
                Instruction::MoveStack => self.moves_stack = true,
                Instruction::Branch(_) | Instruction::Other => {}
            }
            index += if *first >= 0xe800 { 2 } else { 1 };
        }
    }

    /// Resolves calls through registers. The compiler calls a function through a register when it calls it several
    /// times and this makes the code smaller; the address is a word that was loaded before. `function_at` returns the
    /// function whose address is stored at a place.
    fn look_up_calls(&mut self, function_at: impl Fn(u32) -> Option<u32>) {
        for register in &self.called_registers {
            let loads = self.loads.iter().filter(|(to, _)| to == register);
            let called: Vec<u32> = loads.filter_map(|(_, from)| function_at(*from)).collect();
            self.calls_register |= called.is_empty();
            self.calls.extend(called);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes of code of each function.
    const LEN: u32 = 12;

    fn function(name: &str, own_bytes: u64, calls: &[u32]) -> Function {
        Function { name: name.to_owned(), len: LEN, own_bytes, calls: calls.to_vec(), ..Function::default() }
    }

    #[test]
    fn a_call_through_a_register_is_that_of_the_function_that_loaded_it() {
        let loads = Function { loads: vec![(4, 0x100)], ..function("loads", 8, &[0x20]) };
        let outlined = Function { called_registers: [4].into(), ..function("OUTLINED_FUNCTION_0", 0, &[]) };
        let stranger = Function { called_registers: [4].into(), ..function("stranger", 0, &[]) };
        let mut functions = BTreeMap::from([(0x10, loads), (0x20, outlined), (0x30, stranger)]);
        functions.insert(0x40, function("called", 100, &[]));
        call_for_outlined(&mut functions);
        for function in functions.values_mut() {
            function.look_up_calls(|place| (place == 0x100).then_some(0x40));
        }
        let functions = Functions(functions);
        assert_eq!(functions.depth("loads", &[]), Ok(8 + 100 + 108));
        assert!(functions.depth("stranger", &[]).is_err());
    }

    #[test]
    fn only_what_ends_the_program_does_not_count() {
        let depth = |called: &str| {
            let main = function("main", 8, &[0x20]);
            Functions(BTreeMap::from([(0x10, main), (0x20, function(called, 100, &[]))])).depth("main", &[])
        };
        assert_eq!(depth("_ZN12frixel_board5fault15Ending$LT$P$GT$3end17h0E"), Ok(8 + 108));
        assert_eq!(depth("_ZN12frixel_wire5fault1_9serialize17h0E"), Ok(8 + 100 + 108));
    }

    #[test]
    fn the_deepest_path_counts_and_one_without_end_is_named() {
        let mut functions = Functions(BTreeMap::from([
            (0x10, function("main", 8, &[0x20, 0x30])),
            (0x20, function("shallow", 16, &[0x60])),
            (0x30, function("deep", 100, &[0x20, 0x50])),
            (0x40, function("tick", 40, &[])),
            (0x50, function("core::panicking::panic", 1000, &[0x50])),
            (0x60, function("leaf", 4, &[])),
        ]));
        assert_eq!(functions.depth("main", &["tick"]), Ok(8 + 100 + 16 + 4 + 108 + 40 + 108));
        assert!(functions.depth("tock", &[]).is_err());
        assert_eq!(functions.code_that_never_ends("tick"), Ok(LEN.into()));
        assert!(functions.code_that_never_ends("main").unwrap_err().contains("by way of deep"));
        functions.0.insert(0x60, function("leaf", 4, &[0x30]));
        let refused = functions.depth("main", &[]).unwrap_err();
        assert!(refused.contains("calls itself"), "{refused}");
    }

    #[test]
    fn formatting_is_left_out_where_it_cannot_be_followed() {
        let functions = || {
            let formats = Function { calls_register: true, ..function("_RNvNtCs7ldSeZOOJos_4core3fmt5write", 50, &[]) };
            Functions(BTreeMap::from([(0x10, function("main", 8, &[0x20])), (0x20, formats)]))
        };
        assert!(functions().depth("main", &[]).is_err());
        assert_eq!(functions().without_formatting().depth("main", &[]), Ok(8 + 108));
    }
}
