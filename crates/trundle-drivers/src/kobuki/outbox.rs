//! Bytes queued for a link that may accept only a part of them.

use super::link::ByteLink;
use std::io;
use trundle_core::Stamp;

/// Maximum number of bytes that wait: 1024, a tenth of a second of the line. Source: ours.
const MAX_WAITING_BYTES: usize = 1024;
/// Time after which bytes that do not go out mean a lost link: 0.5 s. Source: ours.
const MAX_STUCK_S: f64 = 0.5;

/// Frames that are written whole, one after the other.
#[derive(Debug, Clone, Default)]
pub(super) struct Outbox {
    bytes: Vec<u8>,
    /// Time since which the link accepts no byte.
    stuck: Option<Stamp>,
}

impl Outbox {
    /// Adds a frame; without enough space the whole frame is dropped.
    pub(super) fn push(&mut self, frame: &[u8]) {
        if self.bytes.len() + frame.len() <= MAX_WAITING_BYTES {
            self.bytes.extend(frame);
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.bytes.clear();
        self.stuck = None;
    }

    /// Writes the bytes that the link accepts.
    ///
    /// # Errors
    /// When the link is lost, or has accepted no byte for half a second.
    pub(super) fn write(&mut self, link: &mut dyn ByteLink, now: Stamp) -> io::Result<()> {
        if self.bytes.is_empty() {
            return Ok(());
        }
        let written = link.write(&self.bytes)?;
        self.bytes.drain(..written.min(self.bytes.len()));
        let since = if written > 0 { None } else { Some(self.stuck.unwrap_or(now)) };
        self.stuck = since;
        if since.is_some_and(|since| now - since >= MAX_STUCK_S) {
            return Err(io::Error::new(
                io::ErrorKind::TimedOut,
                format!("no byte went out for {MAX_STUCK_S} s"),
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A link that accepts a fixed number of bytes per write.
    struct Narrow(usize, Vec<u8>);

    impl ByteLink for Narrow {
        fn read(&mut self, _: &mut [u8], _: Duration) -> io::Result<usize> {
            Ok(0)
        }

        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = self.0.min(bytes.len());
            self.1.extend(&bytes[..taken]);
            Ok(taken)
        }
    }

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn frames_go_out_in_order_through_a_narrow_link() {
        let (mut outbox, mut link) = (Outbox::default(), Narrow(3, Vec::new()));
        outbox.push(&[1, 2, 3, 4]);
        outbox.write(&mut link, at(0)).unwrap();
        outbox.push(&[5, 6]);
        (1..4).for_each(|ms| outbox.write(&mut link, at(ms)).unwrap());
        assert_eq!((link.1, outbox.is_empty()), (vec![1, 2, 3, 4, 5, 6], true));
    }

    #[test]
    fn a_stuck_link_is_an_error_and_its_bytes_are_bounded() {
        let (mut outbox, mut link) = (Outbox::default(), Narrow(0, Vec::new()));
        (0..1000).for_each(|_| outbox.push(&[0; 10]));
        assert_eq!(outbox.bytes.len(), 1020);
        assert!(outbox.write(&mut link, at(0)).is_ok() && outbox.write(&mut link, at(499)).is_ok());
        assert!(outbox.write(&mut link, at(500)).is_err());
    }
}
