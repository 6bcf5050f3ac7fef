//! Size limit of a service's reply.
//!
//! RustDDS 0.15 writes the first byte of an option before the parameter list of each `DATA_FRAG` submessage with such a list
//! (`messages/submessages/data_frag.rs`: `write_value` of an `Option`). Replies have such a list, which identifies the request. Receivers
//! refuse the submessage, request it again, and accept no later reply of the same service. A reply that fits into one datagram is a `DATA`
//! submessage, which is correct.

use ros2_client::dds::rustdds::RepresentationIdentifier;
use ros2_client::dds::rustdds::serialization::to_writer_with_rep_id;
use serde::Serialize;
use std::io::{self, Write};

/// Largest reply \[bytes\] that RustDDS sends in one datagram to every peer. The size is the smallest MTU of IPv6, 1280 bytes, minus the
/// headers of IP, UDP and RTPS (48), of a heartbeat (32) and of the submessage (48). Larger replies are not delivered. Source: RFC 8200,
/// section 5, and DDSI-RTPS.
pub const MAX_REPLY_BYTES: usize = 1152;
/// Bytes before a message with its encoding. Source: DDSI-RTPS, 10.2.
const ENCAPSULATION_BYTES: usize = 4;

/// The size of a reply on the wire \[bytes\] if it is too large for delivery.
pub(super) fn excess(reply: &impl Serialize) -> Option<usize> {
    let mut counter = Counter(ENCAPSULATION_BYTES);
    // A reply that cannot be written is refused by the middleware.
    to_writer_with_rep_id(&mut counter, reply, RepresentationIdentifier::CDR_LE).ok()?;
    (counter.0 > MAX_REPLY_BYTES).then_some(counter.0)
}

/// Whether a reply is small enough to arrive.
#[must_use]
pub fn arrives(reply: &impl Serialize) -> bool {
    excess(reply).is_none()
}

/// Diagnostics of a reply of `bytes` bytes.
pub(super) fn message(bytes: usize) -> String {
    format!(
        "a reply has {bytes} bytes, expected at most {MAX_REPLY_BYTES}: an empty reply was sent; ask for fewer values"
    )
}

/// Counts bytes.
struct Counter(usize);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::std_srvs::TriggerResponse;

    #[test]
    fn the_size_of_a_reply_counts_its_encapsulation_and_its_text() {
        // A flag, padding to 4, the length of the text, the text and its 0.
        let reply = |length| TriggerResponse { success: true, message: "x".repeat(length) };
        let overhead = ENCAPSULATION_BYTES + 4 + 4 + 1;
        assert!(arrives(&reply(MAX_REPLY_BYTES - overhead)));
        assert_eq!(excess(&reply(MAX_REPLY_BYTES - overhead + 1)), Some(MAX_REPLY_BYTES + 1));
    }
}
