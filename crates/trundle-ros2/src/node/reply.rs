//! Size limit of a service's reply.
//!
//! RustDDS 0.15 writes the first byte of an option before the parameter list of each `DATA_FRAG` submessage with such a list
//! (`messages/submessages/data_frag.rs`: `write_value` of an `Option`). Replies have such a list, which identifies the request. Receivers
//! refuse the submessage, request it again, and accept no later reply of the same service. A reply that fits into one datagram is a `DATA`
//! submessage, which is correct.

use ros2_client::dds::rustdds::RepresentationIdentifier;
use ros2_client::dds::rustdds::serialization::to_writer_with_rep_id;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
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

/// Diagnostics of a result of `bytes` bytes whose lists and texts were shortened.
pub(super) fn shortening(bytes: usize) -> String {
    format!(
        "a result has {bytes} bytes, expected at most {MAX_REPLY_BYTES}: the first elements of its lists and the first {MAX_TEXT_CHARS} characters \
         of its texts were sent; send goals of fewer poses"
    )
}

/// Longest text of a result that is shortened \[characters\]. Source: ours; a reason of the robot has about 100.
const MAX_TEXT_CHARS: usize = 200;

/// A result with the longest lists for which it fits, and texts of at most [`MAX_TEXT_CHARS`] characters; its numbers do not change. `None`
/// if it does not fit without any element either.
pub(super) fn shortened<R: Serialize + DeserializeOwned>(result: &R, fits: impl Fn(&R) -> bool) -> Option<R> {
    let whole = serde_json::to_value(result).ok()?;
    let of_length = |length| serde_json::from_value(cut(&whole, length)).ok().filter(&fits);
    // An element has a byte at least.
    let lengths: Vec<usize> = (1..=MAX_REPLY_BYTES).collect();
    of_length(lengths.partition_point(|length| of_length(*length).is_some()))
}

/// A value with lists of at most `length` elements, and short texts.
fn cut(value: &Value, length: usize) -> Value {
    match value {
        Value::String(text) if text.chars().count() > MAX_TEXT_CHARS => {
            Value::String(text.chars().take(MAX_TEXT_CHARS - 3).chain("...".chars()).collect())
        }
        Value::Array(list) => list.iter().take(length).map(|element| cut(element, length)).collect(),
        Value::Object(fields) => {
            let fields = fields.iter().map(|(name, field)| (name.clone(), cut(field, length)));
            Value::Object(fields.collect::<Map<_, _>>())
        }
        other => other.clone(),
    }
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
    use crate::generated::nav2_msgs::{FollowWaypointsResult, WaypointStatus};
    use crate::generated::std_srvs::TriggerResponse;

    #[test]
    fn the_size_of_a_reply_counts_its_encapsulation_and_its_text() {
        // A flag, padding to 4, the length of the text, the text and its 0.
        let reply = |length| TriggerResponse { success: true, message: "x".repeat(length) };
        let overhead = ENCAPSULATION_BYTES + 4 + 4 + 1;
        assert!(arrives(&reply(MAX_REPLY_BYTES - overhead)));
        assert_eq!(excess(&reply(MAX_REPLY_BYTES - overhead + 1)), Some(MAX_REPLY_BYTES + 1));
    }

    #[test]
    fn a_result_that_is_too_large_keeps_its_code_and_as_many_elements_as_fit() {
        let missed = |index| WaypointStatus {
            waypoint_index: index,
            error_code: 208,
            error_msg: "no path".to_owned(),
            ..WaypointStatus::default()
        };
        let result = |count, message: &str| FollowWaypointsResult {
            missed_waypoints: (0..count).map(missed).collect(),
            error_code: FollowWaypointsResult::STOP_ON_MISSED_WAYPOINT,
            error_msg: message.to_owned(),
        };
        let cut = shortened(&result(10_000, "no path"), arrives).unwrap();
        let count = cut.missed_waypoints.len() as u32;
        assert!(count >= 8 && arrives(&cut) && !arrives(&result(count + 1, "no path")), "{count}");
        assert_eq!(cut, result(count, "no path"));
        let cut = shortened(&result(0, &"ä".repeat(10_000)), arrives).unwrap();
        assert_eq!((cut.error_code, cut.error_msg.chars().count()), (603, MAX_TEXT_CHARS));
        assert!(cut.error_msg.ends_with("ä..."));
    }
}
