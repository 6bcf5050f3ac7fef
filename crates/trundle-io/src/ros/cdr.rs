//! Reader of the CDR encoding of ROS 2 messages, and of ROS 1's, which is CDR without alignment and header.

use thiserror::Error;

/// Reason why a message cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{message}: {field} at byte {offset}: {problem}")]
pub(crate) struct CdrError {
    /// The type of the message.
    pub message: &'static str,
    /// Name of the field.
    pub field: &'static str,
    /// Offset of the field in the message.
    pub offset: usize,
    /// The problem.
    pub problem: String,
}

/// Serialisation format of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wire {
    /// The format of ROS 2's middleware.
    Cdr,
    /// The format of ROS 1: little endian, without alignment.
    Ros1,
}

/// Reads a message in the Common Data Representation of DDS: version 1, and version 2 of final types, little or big endian.
///
/// The first four bytes hold version and byte order. Every following value is aligned to its own size, counted from the end of these bytes
/// (at most to 4 in version 2). Source: OMG DDS-XTypes 1.3, section 7.4.
#[derive(Debug, Clone)]
pub(crate) struct CdrReader<'a> {
    message: &'static str,
    bytes: &'a [u8],
    at: usize,
    little: bool,
    max_aligned: usize,
    /// Start of the alignment.
    start: usize,
    wire: Wire,
}

/// Length of the header with the encoding of the rest \[bytes\]. Source: DDSI-RTPS, 10.2.
const HEADER_BYTES: usize = 4;

impl<'a> CdrReader<'a> {
    /// A reader of a message of type `message`.
    pub(crate) fn new(message: &'static str, bytes: &'a [u8], wire: Wire) -> Result<Self, CdrError> {
        let mut reader = Self { message, bytes, at: 0, little: true, max_aligned: 1, start: 0, wire };
        if wire == Wire::Cdr {
            reader.read_encapsulation()?;
        }
        Ok(reader)
    }

    /// Serialisation format of the message.
    pub(crate) fn wire(&self) -> Wire {
        self.wire
    }

    fn read_encapsulation(&mut self) -> Result<(), CdrError> {
        let reader = self;
        let [high, kind, ..] = *reader.take("encapsulation", HEADER_BYTES)? else {
            return Err(reader.error("encapsulation", 0, "too short".to_owned()));
        };
        // CDR 0 and 1, CDR2 6 and 7: even is big endian.
        (reader.little, reader.max_aligned) = match (high, kind) {
            (0, 0) => (false, 8),
            (0, 1) => (true, 8),
            (0, 6) => (false, 4),
            (0, 7) => (true, 4),
            _ => {
                let problem = format!("kind {high:#04x}{kind:02x}, expected plain CDR (0, 1, 6 or 7)");
                return Err(reader.error("encapsulation", 0, problem));
            }
        };
        reader.start = HEADER_BYTES;
        Ok(())
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, CdrError> {
        let little = self.little;
        let bytes = self.number::<4>(field)?;
        Ok(if little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    /// A number of one byte.
    pub(crate) fn u8(&mut self, field: &'static str) -> Result<u8, CdrError> {
        self.number::<1>(field).map(|[byte]| byte)
    }

    pub(crate) fn i32(&mut self, field: &'static str) -> Result<i32, CdrError> {
        self.u32(field).map(u32::cast_signed)
    }

    pub(crate) fn f32(&mut self, field: &'static str) -> Result<f32, CdrError> {
        self.u32(field).map(f32::from_bits)
    }

    pub(crate) fn f64(&mut self, field: &'static str) -> Result<f64, CdrError> {
        let little = self.little;
        let bytes = self.number::<8>(field)?;
        Ok(if little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    /// `N` numbers in a row.
    pub(crate) fn f64s<const N: usize>(&mut self, field: &'static str) -> Result<[f64; N], CdrError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.f64(field)?;
        }
        Ok(values)
    }

    /// A text: its length, in CDR with the zero at its end, and its bytes.
    pub(crate) fn string(&mut self, field: &'static str) -> Result<String, CdrError> {
        let length = self.u32(field)? as usize;
        let start = self.at;
        let bytes = self.take(field, length)?;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        let text =
            std::str::from_utf8(text).map_err(|_| self.error(field, start, "is not UTF-8".to_owned()))?;
        Ok(text.to_owned())
    }

    /// The number of following elements, each at least `min` bytes long. A number too large for the rest of the message is an error,
    /// which prevents a large allocation.
    pub(crate) fn count(&mut self, field: &'static str, min: usize) -> Result<usize, CdrError> {
        let count = self.u32(field)? as usize;
        let rest = self.bytes.len() - self.at;
        if count.checked_mul(min).is_none_or(|bytes| bytes > rest) {
            let problem = format!("{count} elements announced, {rest} bytes left");
            return Err(self.error(field, self.at - 4, problem));
        }
        Ok(count)
    }

    /// A list of numbers.
    pub(crate) fn f32_list(&mut self, field: &'static str) -> Result<Vec<f32>, CdrError> {
        let count = self.count(field, 4)?;
        (0..count).map(|_| self.f32(field)).collect()
    }

    /// A list of numbers.
    pub(crate) fn f64_list(&mut self, field: &'static str) -> Result<Vec<f64>, CdrError> {
        let count = self.count(field, 8)?;
        (0..count).map(|_| self.f64(field)).collect()
    }

    /// A list of bytes.
    pub(crate) fn bytes(&mut self, field: &'static str) -> Result<&'a [u8], CdrError> {
        let count = self.count(field, 1)?;
        self.take(field, count)
    }

    fn number<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], CdrError> {
        let align = N.min(self.max_aligned);
        let off = (self.at - self.start) % align;
        if off != 0 {
            self.take(field, align - off)?;
        }
        let bytes = self.take(field, N)?;
        Ok(bytes.try_into().expect("invariant: as many bytes as asked for"))
    }

    fn take(&mut self, field: &'static str, count: usize) -> Result<&'a [u8], CdrError> {
        let rest = &self.bytes[self.at..];
        let Some(taken) = rest.get(..count) else {
            let problem = format!("the message ends after {} of {count} bytes", rest.len());
            return Err(self.error(field, self.at, problem));
        };
        self.at += count;
        Ok(taken)
    }

    fn error(&self, field: &'static str, offset: usize, problem: String) -> CdrError {
        CdrError { message: self.message, field, offset, problem }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_aligned_and_of_either_endian() {
        // u32 7, then an f64 1.5 that begins at the next multiple of 8.
        let mut little = vec![0, 1, 0, 0, 7, 0, 0, 0, 9, 9, 9, 9];
        little.extend(1.5_f64.to_le_bytes());
        let mut reader = CdrReader::new("x", &little, Wire::Cdr).unwrap();
        assert_eq!((reader.u32("a"), reader.f64("b")), (Ok(7), Ok(1.5)));
        let mut big = vec![0, 0, 0, 0, 0, 0, 0, 7, 9, 9, 9, 9];
        big.extend(1.5_f64.to_be_bytes());
        let mut reader = CdrReader::new("x", &big, Wire::Cdr).unwrap();
        assert_eq!((reader.i32("a"), reader.f64("b")), (Ok(7), Ok(1.5)));
        // Version 2 aligns to 4 at most.
        let mut two = vec![0, 7, 0, 0, 7, 0, 0, 0];
        two.extend(1.5_f64.to_le_bytes());
        let mut reader = CdrReader::new("x", &two, Wire::Cdr).unwrap();
        assert_eq!((reader.u32("a"), reader.f64("b")), (Ok(7), Ok(1.5)));
    }

    #[test]
    fn ros1_aligns_nothing_and_ends_texts_with_nothing() {
        let bytes = [&[2, 0, 0, 0, b'a', b'b'][..], &1.5_f64.to_le_bytes()].concat();
        let mut reader = CdrReader::new("x", &bytes, Wire::Ros1).unwrap();
        assert_eq!((reader.string("name"), reader.f64("b")), (Ok("ab".to_owned()), Ok(1.5)));
    }

    #[test]
    fn texts_end_with_a_zero_and_the_next_number_is_aligned() {
        let mut reader =
            CdrReader::new("x", &[0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 9, 5, 0, 0, 0], Wire::Cdr).unwrap();
        assert_eq!((reader.string("name"), reader.u32("n")), (Ok("ab".to_owned()), Ok(5)));
    }

    #[test]
    fn errors_name_message_field_and_offset() {
        let message = "sensor_msgs/msg/LaserScan";
        let problem = |bytes: &[u8]| {
            CdrReader::new(message, bytes, Wire::Cdr)
                .and_then(|mut r| r.f32_list("ranges"))
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            problem(&[0, 1, 0, 0, 5, 0, 0, 0, 1, 1, 1, 1]),
            "sensor_msgs/msg/LaserScan: ranges at byte 4: 5 elements announced, 4 bytes left"
        );
        assert_eq!(
            problem(&[0, 1, 0, 0, 5]),
            "sensor_msgs/msg/LaserScan: ranges at byte 4: the message ends after 1 of 4 bytes"
        );
        assert!(problem(&[0, 3, 0, 0]).ends_with("kind 0x0003, expected plain CDR (0, 1, 6 or 7)"));
        assert!(problem(&[0]).contains("encapsulation at byte 0: the message ends after 1 of 4 bytes"));
    }

    proptest! {
        #[test]
        fn any_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
            if let Ok(mut reader) = CdrReader::new("x", &bytes, Wire::Cdr) {
                let _ = reader.string("a");
                let _ = reader.f64("b");
                let _ = reader.f32_list("c");
            }
        }
    }
}
