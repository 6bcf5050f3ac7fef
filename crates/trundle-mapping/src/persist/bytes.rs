//! Numbers as bytes, little endian, and back.

use super::error::FilterFileError;
use nalgebra::Matrix3;
use trundle_core::Pose2;

type Read<T> = Result<T, FilterFileError>;

/// Writer of bytes.
#[derive(Debug, Default)]
pub(crate) struct Writer(pub(crate) Vec<u8>);

impl Writer {
    pub(crate) fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    pub(crate) fn u16(&mut self, value: u16) {
        self.0.extend(value.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.0.extend(value.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    /// Writes the number of following elements.
    pub(crate) fn count(&mut self, value: usize) {
        self.u32(u32::try_from(value).expect("invariant: fewer than 2^32 things are kept"));
    }

    pub(crate) fn pose(&mut self, pose: Pose2) {
        [pose.x, pose.y, pose.theta].into_iter().for_each(|v| self.f64(v));
    }

    pub(crate) fn matrix(&mut self, matrix: &Matrix3<f64>) {
        matrix.iter().for_each(|v| self.f64(*v));
    }
}

/// Reader of untrusted bytes: every length and value is checked.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
    /// The part that is being read, for errors.
    pub(crate) within: &'static str,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(rest: &'a [u8], within: &'static str) -> Self {
        Self { rest, within }
    }

    fn take<const N: usize>(&mut self) -> Read<[u8; N]> {
        let cut = FilterFileError::Cut { within: self.within };
        let (taken, rest) = self.rest.split_first_chunk::<N>().ok_or(cut)?;
        self.rest = rest;
        Ok(*taken)
    }

    pub(crate) fn u8(&mut self) -> Read<u8> {
        Ok(self.take::<1>()?[0])
    }

    pub(crate) fn u16(&mut self) -> Read<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Read<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Read<u64> {
        self.take().map(u64::from_le_bytes)
    }

    /// A finite number within a plausible range.
    pub(crate) fn f64(&mut self, what: &'static str) -> Read<f64> {
        let value = f64::from_bits(self.u64()?);
        self.require(value.abs() <= 1e9, what)?;
        Ok(value)
    }

    /// Reads the number of following elements of at least `min` bytes; the rest of the bytes must be able to hold them.
    pub(crate) fn count(&mut self, min: usize) -> Read<usize> {
        let count = self.u32()? as usize;
        if count.saturating_mul(min) > self.rest.len() {
            return Err(FilterFileError::Cut { within: self.within });
        }
        Ok(count)
    }

    /// An index below `bound`.
    pub(crate) fn index(&mut self, bound: usize, what: &'static str) -> Read<usize> {
        let index = self.u32()? as usize;
        self.require(index < bound, what)?;
        Ok(index)
    }

    pub(crate) fn pose(&mut self, what: &'static str) -> Read<Pose2> {
        Ok(Pose2 { x: self.f64(what)?, y: self.f64(what)?, theta: self.f64(what)? })
    }

    pub(crate) fn covariance(&mut self, what: &'static str) -> Read<Matrix3<f64>> {
        let mut matrix = Matrix3::zeros();
        for v in matrix.iter_mut() {
            *v = self.f64(what)?;
        }
        self.require(matrix.cholesky().is_some(), what)?;
        Ok(matrix)
    }

    pub(crate) fn require(&self, holds: bool, what: &'static str) -> Read<()> {
        if holds { Ok(()) } else { Err(FilterFileError::Content { what }) }
    }

    pub(crate) fn end(&self) -> Read<()> {
        self.require(self.rest.is_empty(), "there is more than the map")
    }
}

/// FNV-1a, by words of 8 bytes.
pub(crate) fn checksum(bytes: &[u8]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for chunk in bytes.chunks(8) {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        hash = (hash ^ u64::from_le_bytes(word)).wrapping_mul(0x0000_0100_0000_01b3);
        hash ^= hash >> 29;
    }
    hash ^ bytes.len() as u64
}
