//! A scene read from its bytes.

use core::ops::Range;

use frixel_wire::hello::feature;
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX, SceneError};

use crate::finger_law::LAW_POINTS_MAX;
use crate::header::{HEADER_LEN, Header, SCENE_VERSION};
use crate::layout::RECORD_LEN;
use crate::point::{POINT_LEN, Point};
use crate::record::Record;
use frixel_model::Waveform;

/// Bytes of the largest scene.
pub const SCENE_MAX_LEN: usize = HEADER_LEN + RECORDS_MAX * RECORD_LEN + (POINTS_MAX + LAW_POINTS_MAX) * POINT_LEN;

/// Bits of [`feature`] needed to play a scene.
pub fn features_of(header: &Header, records: impl Iterator<Item = Record>) -> u32 {
    let carrier = if header.waveform == Waveform::Sine { feature::SINE_CARRIER } else { 0 };
    let law = if header.law.is_some() { feature::EMPIRICAL } else { 0 };
    records.fold(carrier | law, |features, record| features | record.layer.feature() | record.region.feature())
}

/// A complete scene with a checked structure. A board checks the ranges of its numbers at the commit.
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
        let scene = Self::open(bytes)?;
        scene.check_records(0..scene.record_count())?;
        Ok(scene)
    }

    /// Checks version, length and header, in much less time than [`Scene::parse`]. Check the records with
    /// [`Scene::check_records`] before using the scene.
    #[inline(never)]
    pub fn open(bytes: &'a [u8]) -> Result<Self, SceneError> {
        // The version comes first, since a scene of another version may have any length.
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
        let (mut header, record_count, point_count) = Header::parse(header)?;
        let law_len = header.law().map_or(0, |law| usize::from(law.point_count()) * POINT_LEN);
        let records_len = usize::from(record_count) * RECORD_LEN;
        let points_len = usize::from(point_count) * POINT_LEN;
        let expected = (HEADER_LEN + records_len + points_len + law_len) as u32;
        let Some((records, points)) = rest.split_at_checked(records_len) else {
            return Err(SceneError::Length { found, expected });
        };
        if points.len() != points_len + law_len {
            return Err(SceneError::Length { found, expected });
        }
        let (records, _) = records.as_chunks::<RECORD_LEN>();
        let (points, _) = points.as_chunks::<POINT_LEN>();
        let (points, law_points) = points.split_at_checked(usize::from(point_count)).unwrap_or((points, &[]));
        if cfg!(feature = "empirical")
            && let Some(law) = &mut header.law
        {
            law.read_points(law_points);
        }
        Ok(Self { header, records, points })
    }

    /// Checks the records with these numbers. Numbers without a record are ignored.
    pub fn check_records(&self, numbers: Range<usize>) -> Result<(), SceneError> {
        let records = (0_u8..).zip(self.records).skip(numbers.start).take(numbers.len());
        for (number, record) in records {
            Record::parse(record, number)?.check_structure(self.points.len() as u8, number)?;
        }
        Ok(())
    }

    /// The settings of the whole scene.
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// The layers, from bottom to top.
    pub fn records(&self) -> impl Iterator<Item = Record> + use<'a> {
        (0..).zip(self.records).filter_map(|(number, record)| Record::read(record, number).ok())
    }

    /// Layer number `number`; `None` if there are fewer.
    pub fn record(&self, number: usize) -> Option<Record> {
        self.records.get(number).and_then(|record| Record::read(record, number as u8).ok())
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
