//! Replies of the device to one request.
//!
//! The device sends the data requested, and then a completion: magic, sequence of the request, and two further words.

use std::fmt;

/// First word of a completion. Source: \[Freenect2\].
pub const COMPLETION_MAGIC: u32 = 0x0a6f_e000;
/// Bytes of a completion. Source: \[Freenect2\].
pub const COMPLETION_BYTES: usize = 16;

/// Reason why a reply is invalid.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReplyFault {
    /// The completion came before the data.
    NoData,
    /// Data came after the data.
    NoCompletion {
        /// Length of the further data \[bytes\].
        bytes: usize,
    },
    /// More data came than the request allows.
    TooLong {
        /// Length \[bytes\].
        bytes: usize,
        /// Limit \[bytes\].
        limit: usize,
    },
    /// The completion belongs to another request.
    WrongSequence {
        /// Sequence of the request.
        expected: u32,
        /// Sequence of the completion.
        found: u32,
    },
}

impl fmt::Display for ReplyFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoData => f.write_str("the reply ended before its data"),
            Self::NoCompletion { bytes } => write!(f, "{bytes} bytes came in place of the end of the reply"),
            Self::TooLong { bytes, limit } => {
                write!(f, "the reply has {bytes} bytes, expected at most {limit}")
            }
            Self::WrongSequence { expected, found } => {
                write!(f, "the reply has sequence {found}, expected {expected}")
            }
        }
    }
}

/// The reply to one request, put together from bulk transfers.
#[derive(Debug, Clone)]
pub struct ReplyReader {
    sequence: u32,
    limit: usize,
    data: Option<Vec<u8>>,
}

impl ReplyReader {
    /// The reply to the request `sequence`, with at most `limit` bytes of data; 0 if only the completion comes.
    pub fn new(sequence: u32, limit: u32) -> Self {
        Self { sequence, limit: limit as usize, data: None }
    }

    /// Adds one transfer; returns the data of a complete reply. Empty transfers and completions of earlier requests are skipped.
    ///
    /// # Errors
    /// When the reply cannot be used.
    pub fn push(&mut self, transfer: &[u8]) -> Result<Option<Vec<u8>>, ReplyFault> {
        match completed_sequence(transfer) {
            Some(found) if found == self.sequence => self.complete().map(Some),
            Some(found) if self.is_earlier(found) => Ok(None),
            Some(found) => Err(ReplyFault::WrongSequence { expected: self.sequence, found }),
            None if transfer.is_empty() => Ok(None),
            None => self.take_data(transfer).map(|()| None),
        }
    }

    fn is_earlier(&self, found: u32) -> bool {
        found.wrapping_sub(self.sequence).cast_signed() < 0
    }

    fn complete(&mut self) -> Result<Vec<u8>, ReplyFault> {
        let data = self.data.take();
        if self.limit == 0 { Ok(Vec::new()) } else { data.ok_or(ReplyFault::NoData) }
    }

    fn take_data(&mut self, transfer: &[u8]) -> Result<(), ReplyFault> {
        let (bytes, limit) = (transfer.len(), self.limit);
        if limit == 0 || self.data.is_some() {
            return Err(ReplyFault::NoCompletion { bytes });
        }
        if bytes > limit {
            return Err(ReplyFault::TooLong { bytes, limit });
        }
        self.data = Some(transfer.to_vec());
        Ok(())
    }
}

/// The sequence in a completion; `None` if `transfer` is no completion.
fn completed_sequence(transfer: &[u8]) -> Option<u32> {
    let (words, []) = transfer.as_chunks::<4>() else { return None };
    let [magic, sequence, _, _] = *words else { return None };
    (u32::from_le_bytes(magic) == COMPLETION_MAGIC).then_some(u32::from_le_bytes(sequence))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn completion(sequence: u32) -> Vec<u8> {
        [COMPLETION_MAGIC, sequence, 0, 0].iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    fn read(limit: u32, transfers: &[&[u8]]) -> Result<Option<Vec<u8>>, ReplyFault> {
        let mut reader = ReplyReader::new(5, limit);
        let mut result = Ok(None);
        for transfer in transfers {
            result = reader.push(transfer);
            if result != Ok(None) {
                break;
            }
        }
        result
    }

    #[test]
    fn data_and_completion_are_a_reply() {
        assert_eq!(read(8, &[b"data", &completion(5)]), Ok(Some(b"data".to_vec())));
        assert_eq!(read(0, &[&completion(5)]), Ok(Some(Vec::new())));
        assert_eq!(read(8, &[b"data"]), Ok(None), "the completion is awaited");
    }

    #[test]
    fn doubled_completions_of_earlier_requests_are_passed_over() {
        let (old, own) = (completion(4), completion(5));
        assert_eq!(read(8, &[&old, &old, b"data", b"", &own]), Ok(Some(b"data".to_vec())));
        assert!(ReplyReader::new(0, 0).push(&completion(u32::MAX)).is_ok_and(|data| data.is_none()), "wraps");
    }

    #[test]
    fn lost_cut_and_reordered_transfers_are_named() {
        assert_eq!(read(8, &[&completion(5), b"data"]), Err(ReplyFault::NoData));
        assert_eq!(read(8, &[b"data", &completion(5)[..9]]), Err(ReplyFault::NoCompletion { bytes: 9 }));
        assert_eq!(read(0, &[b"data"]), Err(ReplyFault::NoCompletion { bytes: 4 }));
        assert_eq!(read(3, &[b"data"]), Err(ReplyFault::TooLong { bytes: 4, limit: 3 }));
        let wrong = ReplyFault::WrongSequence { expected: 5, found: 6 };
        assert_eq!(read(8, &[b"data", &completion(6)]), Err(wrong.clone()));
        assert_eq!(wrong.to_string(), "the reply has sequence 6, expected 5");
    }
}
