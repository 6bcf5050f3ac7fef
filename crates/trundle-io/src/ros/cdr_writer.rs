//! Writer of the CDR encoding of ROS 2 messages: version 1, little endian.

use trundle_core::{Pose3, Stamp};

/// First bytes of a message: plain CDR, little endian. Source: OMG DDS-XTypes 1.3, section 7.4.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];
/// Number of nanoseconds in a second. Source: SI.
const NANOS_PER_S: i64 = 1_000_000_000;

/// Writes the fields of a message one after the other; each method returns the writer.
#[derive(Debug, Clone)]
pub(in crate::ros) struct CdrWriter(Vec<u8>);

impl CdrWriter {
    /// A message that begins with a header.
    pub(in crate::ros) fn with_header(stamp: Stamp, frame: &str) -> Self {
        Self::new().header(stamp, frame)
    }

    pub(in crate::ros) fn new() -> Self {
        Self(ENCAPSULATION.to_vec())
    }

    pub(in crate::ros) fn finish(self) -> Vec<u8> {
        self.0
    }

    /// A stamp; a stamp outside the range of 32-bit seconds becomes the nearest one inside.
    pub(in crate::ros) fn stamp(self, stamp: Stamp) -> Self {
        let seconds = stamp.nanos.div_euclid(NANOS_PER_S).clamp(i64::from(i32::MIN), i64::from(i32::MAX));
        let nanos = stamp.nanos.rem_euclid(NANOS_PER_S) as u32; // below 1e9
        self.put((seconds as i32).to_le_bytes()).u32(nanos)
    }

    pub(in crate::ros) fn header(self, stamp: Stamp, frame: &str) -> Self {
        self.stamp(stamp).string(frame)
    }

    pub(in crate::ros) fn u8(mut self, value: u8) -> Self {
        self.0.push(value);
        self
    }

    pub(in crate::ros) fn u32(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    /// A length.
    pub(in crate::ros) fn count(self, count: usize) -> Self {
        self.u32(u32::try_from(count).unwrap_or(u32::MAX))
    }

    pub(in crate::ros) fn f32(self, value: f32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(in crate::ros) fn f64(self, value: f64) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(in crate::ros) fn f32s(self, values: impl IntoIterator<Item = f32>) -> Self {
        values.into_iter().fold(self, Self::f32)
    }

    pub(in crate::ros) fn f64s(self, values: impl IntoIterator<Item = f64>) -> Self {
        values.into_iter().fold(self, Self::f64)
    }

    pub(in crate::ros) fn string(self, text: &str) -> Self {
        let mut writer = self.count(text.len() + 1);
        writer.0.extend(text.as_bytes());
        writer.0.push(0);
        writer
    }

    /// A list of bytes.
    pub(in crate::ros) fn bytes(self, bytes: &[u8]) -> Self {
        let mut writer = self.count(bytes.len());
        writer.0.extend(bytes);
        writer
    }

    /// Position, and quaternion (x, y, z, w).
    pub(in crate::ros) fn pose(self, pose: Pose3) -> Self {
        self.f64s(<[f64; 7]>::from(pose))
    }

    fn put<const N: usize>(mut self, bytes: [u8; N]) -> Self {
        let aligned = (self.0.len() - ENCAPSULATION.len()).next_multiple_of(N) + ENCAPSULATION.len();
        self.0.resize(aligned, 0);
        self.0.extend(bytes);
        self
    }
}
