//! Numbers as bytes, little endian, and back.

use crate::persist::error::MapFileError;
use trundle_core::{Invalid, Pose3, Vector3};
use trundle_vision::Descriptor;

/// Largest coordinate (m) or covariance entry (m^2, rad^2) of a map: 1e9. A larger one is refused as damage. Source: ours.
const MAX_COORDINATE: f64 = 1e9;

/// Writer of bytes.
#[derive(Debug, Default)]
pub(crate) struct Writer(pub Vec<u8>);

impl Writer {
    pub fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    pub fn u32(&mut self, value: u32) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn u64(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn f32(&mut self, value: f32) {
        self.u32(value.to_bits());
    }

    pub fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    /// Writes a count or an index.
    pub fn count(&mut self, value: usize) {
        self.u32(u32::try_from(value).expect("invariant: an arena holds less than 2^32 things"));
    }

    pub fn f64s(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.f64(value));
    }

    pub fn descriptor(&mut self, descriptor: &Descriptor) {
        descriptor.0.iter().for_each(|word| self.u64(*word));
    }

    pub fn pose(&mut self, pose: &Pose3) {
        self.f64s(pose.rotation.coords.iter().copied());
        self.f64s(pose.translation.iter().copied());
    }
}

/// Reader of untrusted bytes: every length and value is checked.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
    /// The part that is being read, for errors.
    pub within: &'static str,
}

type Read<T> = Result<T, MapFileError>;

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8], within: &'static str) -> Self {
        Self { rest: bytes, within }
    }

    pub fn take<const N: usize>(&mut self) -> Read<[u8; N]> {
        let (taken, rest) =
            self.rest.split_first_chunk::<N>().ok_or(MapFileError::Cut { within: self.within })?;
        self.rest = rest;
        Ok(*taken)
    }

    pub fn u8(&mut self) -> Read<u8> {
        Ok(self.take::<1>()?[0])
    }

    pub fn u32(&mut self) -> Read<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Read<u64> {
        self.take().map(u64::from_le_bytes)
    }

    /// An f32 without a check of its range.
    pub fn f32(&mut self) -> Read<f32> {
        self.u32().map(f32::from_bits)
    }

    /// An f64 without a check of its range.
    pub fn f64(&mut self) -> Read<f64> {
        self.u64().map(f64::from_bits)
    }

    /// A count of elements of at least `min` bytes each; the rest of the bytes must be able to hold them.
    pub fn count(&mut self, min: usize) -> Read<usize> {
        let count = self.u32()? as usize;
        if count.saturating_mul(min) > self.rest.len() {
            return Err(MapFileError::Cut { within: self.within });
        }
        Ok(count)
    }

    /// An index below `bound`.
    pub fn index(&mut self, name: &str, bound: usize) -> Read<usize> {
        let index = self.u32()? as usize;
        self.require(index < bound, name, index, || format!("less than {bound}"))?;
        Ok(index)
    }

    /// A number in `low..=high`.
    pub fn f64_in(&mut self, name: &str, low: f64, high: f64) -> Read<f64> {
        let value = self.f64()?;
        self.require((low..=high).contains(&value), name, value, || format!("{low} to {high}"))?;
        Ok(value)
    }

    /// Reads an f32 in this range.
    pub fn f32_in(&mut self, name: &str, low: f32, high: f32) -> Read<f32> {
        let value = self.f32()?;
        self.require((low..=high).contains(&value), name, value, || format!("{low} to {high}"))?;
        Ok(value)
    }

    /// A coordinate, or a covariance of coordinates.
    pub fn length(&mut self, name: &str) -> Read<f64> {
        self.f64_in(name, -MAX_COORDINATE, MAX_COORDINATE)
    }

    pub fn vector(&mut self, name: &str) -> Read<Vector3> {
        Ok(Vector3::new(self.length(name)?, self.length(name)?, self.length(name)?))
    }

    /// A flag: whether a value follows.
    pub fn mark(&mut self, name: &str) -> Read<bool> {
        let mark = self.u8()?;
        self.require(mark < 2, name, mark, || "0 or 1".to_owned())?;
        Ok(mark == 1)
    }

    /// A vector of unit length.
    pub fn direction(&mut self, name: &str) -> Read<Vector3> {
        let direction = self.vector(name)?;
        let length = direction.norm();
        self.require((length - 1.0).abs() < 1e-6, name, length, || "a vector of length 1".to_owned())?;
        Ok(direction)
    }

    pub fn descriptor(&mut self) -> Read<Descriptor> {
        Ok(Descriptor([self.u64()?, self.u64()?, self.u64()?, self.u64()?]))
    }

    pub fn pose(&mut self, name: &str) -> Read<Pose3> {
        let [x, y, z, w] = [self.f64()?, self.f64()?, self.f64()?, self.f64()?];
        let rotation = nalgebra::Quaternion::new(w, x, y, z);
        let norm = rotation.norm();
        self.require((norm - 1.0).abs() < 1e-6, name, norm, || "a quaternion of norm 1".to_owned())?;
        Ok(Pose3::new(nalgebra::UnitQuaternion::new_unchecked(rotation), self.vector(name)?))
    }

    /// Requires the end of the bytes.
    pub fn end(&self) -> Read<()> {
        self.require(self.rest.is_empty(), "bytes behind the map", self.rest.len(), || "0".to_owned())
    }

    /// Refuses an impossible value.
    pub fn require(
        &self,
        anchors: bool,
        name: &str,
        value: impl ToString,
        expected: impl FnOnce() -> String,
    ) -> Read<()> {
        let refuse = || MapFileError::Content(Invalid::new(name, value, "", expected()));
        if anchors { Ok(()) } else { Err(refuse()) }
    }
}

/// FNV-1a over 8 bytes at a time, the last ones filled with zeros, and the length: any change of one word changes the checksum.
pub(crate) fn checksum(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(0xCBF2_9CE4_8422_2325 ^ bytes.len() as u64, |sum, chunk| {
        let word = chunk.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        (sum ^ word).wrapping_mul(0x0100_0000_01B3)
    })
}
