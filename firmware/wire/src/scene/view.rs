//! A scene read from its bytes.

use super::{HEADER_LEN, Header, RECORD_LEN, Record, SCENE_VERSION, SceneError};

/// A whole scene, every byte of it checked; only what its numbers mean is left to the board.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    header: Header,
    records: &'a [[u8; RECORD_LEN]],
}

impl<'a> Scene<'a> {
    /// Checks version, length, header and every record.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, SceneError> {
        // The version comes first: a scene of another version may be of any length.
        if let Some(version) = bytes.first_chunk::<2>() {
            let found = u16::from_le_bytes(*version);
            if found != SCENE_VERSION {
                return Err(SceneError::Version { found });
            }
        }
        let found = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let Some((header, rest)) = bytes.split_first_chunk::<HEADER_LEN>() else {
            return Err(SceneError::Length { found, expected: HEADER_LEN as u32 });
        };
        let (header, count) = Header::parse(header)?;
        let expected = HEADER_LEN + usize::from(count) * RECORD_LEN;
        let (records, []) = rest.as_chunks::<RECORD_LEN>() else {
            return Err(SceneError::Length { found, expected: expected as u32 });
        };
        if records.len() != usize::from(count) {
            return Err(SceneError::Length { found, expected: expected as u32 });
        }
        for (number, record) in (0..).zip(records) {
            Record::parse(record, number)?;
        }
        Ok(Self { header, records })
    }

    /// What holds for the whole scene.
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// The layers, the first one at the bottom.
    pub fn records(&self) -> impl Iterator<Item = Record> + use<'a> {
        (0..).zip(self.records).filter_map(|(number, record)| Record::parse(record, number).ok())
    }

    /// How many records there are.
    pub const fn record_count(&self) -> usize {
        self.records.len()
    }
}
