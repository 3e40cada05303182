//! A reader of Thrift's compact protocol that keeps nothing:
//! <https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md>.

use super::damaged;
use crate::recording::RecordingError;

/// Types of fields and of elements of lists.
pub(super) const I32: u8 = 5;
pub(super) const I64: u8 = 6;
pub(super) const LIST: u8 = 9;
pub(super) const STRUCT: u8 = 12;
const TRUE: u8 = 1;
const FALSE: u8 = 2;
const I8: u8 = 3;
const I16: u8 = 4;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const SET: u8 = 10;
const MAP: u8 = 11;

/// Most structs, lists and maps inside one another; a footer has six.
const DEPTH_MAX: u32 = 16;

/// Bytes that are read from the front.
pub(super) struct Thrift<'b> {
    bytes: &'b [u8],
    depth: u32,
}

impl<'b> Thrift<'b> {
    pub(super) fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, depth: 0 }
    }

    /// The bytes that are not read yet.
    pub(super) fn rest(&self) -> &'b [u8] {
        self.bytes
    }

    /// Reads a struct. `take` is called with the number and the type of each field; a field that it does not take is
    /// skipped.
    pub(super) fn fields(
        &mut self,
        mut take: impl FnMut(&mut Self, i64, u8) -> Result<bool, RecordingError>,
    ) -> Result<(), RecordingError> {
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            return Err(RecordingError::nested());
        }
        let mut id = 0;
        loop {
            let head = self.byte()?;
            if head == 0 {
                break;
            }
            let (delta, kind) = (i64::from(head >> 4), head & 15);
            id = if delta == 0 { self.signed()? } else { id + delta };
            if !take(self, id, kind)? {
                // A switch is in the head.
                if kind != TRUE && kind != FALSE {
                    self.skip(kind)?;
                }
            }
        }
        self.depth -= 1;
        Ok(())
    }

    /// Reads the head of a list, and returns its length. Each element takes a byte at least.
    pub(super) fn list(&mut self) -> Result<u64, RecordingError> {
        self.list_head().map(|(len, _)| len)
    }

    fn list_head(&mut self) -> Result<(u64, u8), RecordingError> {
        let head = self.byte()?;
        let len = if head >> 4 == 15 { self.unsigned()? } else { u64::from(head >> 4) };
        if len > self.bytes.len() as u64 { Err(damaged("a list ends early")) } else { Ok((len, head & 15)) }
    }

    /// Reads a number that is not negative.
    pub(super) fn count(&mut self) -> Result<u64, RecordingError> {
        u64::try_from(self.signed()?).map_err(|_| damaged("a count is negative"))
    }

    /// Skips a value, which is in a list or in a field that is not a switch.
    pub(super) fn skip(&mut self, kind: u8) -> Result<(), RecordingError> {
        match kind {
            TRUE | FALSE | I8 => self.byte().map(drop),
            I16 | I32 | I64 => self.unsigned().map(drop),
            DOUBLE => self.skip_bytes(8),
            BINARY => {
                let len = self.unsigned()?;
                self.skip_bytes(len)
            }
            LIST | SET => {
                let (len, kind) = self.list_head()?;
                self.deeper(|list| (0..len).try_for_each(|_| list.skip(kind)))
            }
            MAP => {
                let len = self.unsigned()?;
                let kinds = if len == 0 { 0 } else { self.byte()? };
                self.deeper(|map| (0..len).try_for_each(|_| map.skip(kinds >> 4).and_then(|()| map.skip(kinds & 15))))
            }
            STRUCT => self.fields(|_, _, _| Ok(false)),
            _ => Err(damaged("a field has no type")),
        }
    }

    fn deeper(&mut self, skip: impl FnOnce(&mut Self) -> Result<(), RecordingError>) -> Result<(), RecordingError> {
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            return Err(RecordingError::nested());
        }
        skip(self)?;
        self.depth -= 1;
        Ok(())
    }

    fn byte(&mut self) -> Result<u8, RecordingError> {
        let (first, rest) = self.bytes.split_first().ok_or_else(|| damaged("its metadata ends early"))?;
        self.bytes = rest;
        Ok(*first)
    }

    fn skip_bytes(&mut self, len: u64) -> Result<(), RecordingError> {
        let rest = usize::try_from(len).ok().and_then(|len| self.bytes.get(len..));
        self.bytes = rest.ok_or_else(|| damaged("its metadata ends early"))?;
        Ok(())
    }

    fn signed(&mut self) -> Result<i64, RecordingError> {
        let value = self.unsigned()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    fn unsigned(&mut self) -> Result<u64, RecordingError> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(damaged("a number has too many bytes"))
    }
}
