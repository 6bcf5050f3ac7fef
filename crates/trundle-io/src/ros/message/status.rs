//! Texts and states.

use super::RosMessage;
use crate::ros::cdr_writer::CdrWriter;
use trundle_core::Stamp;

/// `std_msgs/msg/String`.
#[must_use]
pub fn text(text: &str) -> RosMessage {
    RosMessage::new("std_msgs/msg/String", CdrWriter::new().string(text))
}

/// `diagnostic_msgs/msg/DiagnosticArray` of one status: its name, whether it is a warning, its message, and values by name.
#[must_use]
pub fn diagnostics(
    stamp: Stamp,
    name: &str,
    is_warning: bool,
    message: &str,
    values: &[(&str, String)],
) -> RosMessage {
    let writer = CdrWriter::with_header(stamp, "").count(1).u8(u8::from(is_warning));
    let writer = writer.string(name).string(message).string("trundle").count(values.len());
    let value = |writer: CdrWriter, (key, value): &(&str, String)| writer.string(key).string(value);
    RosMessage::new("diagnostic_msgs/msg/DiagnosticArray", values.iter().fold(writer, value))
}
