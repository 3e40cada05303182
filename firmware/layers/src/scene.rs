//! A scene read from its bytes.

use frixel_wire::hello::feature;
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX, SceneError};

use crate::header::{Carrier, HEADER_LEN, Header, SCENE_VERSION};
use crate::point::{POINT_LEN, Point};
use crate::record::{RECORD_LEN, Record};

/// Bytes of the largest scene.
pub const SCENE_MAX_LEN: usize = HEADER_LEN + RECORDS_MAX * RECORD_LEN + POINTS_MAX * POINT_LEN;

/// Bits of [`feature`] that a board needs to play a scene.
pub fn features_of(header: &Header, records: impl Iterator<Item = Record>) -> u32 {
    let carrier = if header.carrier == Carrier::Sine { feature::SINE_CARRIER } else { 0 };
    records.fold(carrier, |features, record| features | record.layer.feature() | record.region.feature())
}

/// A complete scene whose structure has been checked. The ranges of its numbers have not: a board checks them at the
/// commit.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    header: Header,
    records: &'a [[u8; RECORD_LEN]],
    points: &'a [[u8; POINT_LEN]],
}

impl<'a> Scene<'a> {
    /// Checks version, length, header and every record.
    #[inline(never)]
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
        let (header, record_count, point_count) = Header::parse(header)?;
        let records_len = usize::from(record_count) * RECORD_LEN;
        let points_len = usize::from(point_count) * POINT_LEN;
        let expected = (HEADER_LEN + records_len + points_len) as u32;
        let Some((records, points)) = rest.split_at_checked(records_len) else {
            return Err(SceneError::Length { found, expected });
        };
        if points.len() != points_len {
            return Err(SceneError::Length { found, expected });
        }
        let (records, _) = records.as_chunks::<RECORD_LEN>();
        let (points, _) = points.as_chunks::<POINT_LEN>();
        for (number, record) in (0..).zip(records) {
            Record::parse(record, number)?.check_structure(point_count, number)?;
        }
        Ok(Self { header, records, points })
    }

    /// The settings of the whole scene.
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// The layers, the first one at the bottom.
    pub fn records(&self) -> impl Iterator<Item = Record> + use<'a> {
        (0..).zip(self.records).filter_map(|(number, record)| Record::parse(record, number).ok())
    }

    /// Number of records.
    pub const fn record_count(&self) -> usize {
        self.records.len()
    }

    /// The points that polygons and curves of speed refer to.
    pub fn points(&self) -> impl ExactSizeIterator<Item = Point> + use<'a> {
        self.points.iter().map(Point::parse)
    }

    /// Number of points.
    pub const fn point_count(&self) -> usize {
        self.points.len()
    }
}
