//! Messages to a viewer.

use crate::topic::RunTopic;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use trundle_core::Stamp;

/// Code of a message with data. Source: the protocol, Message Data.
const DATA_OPCODE: u8 = 1;
/// Bytes before the content of a message with data: code, number of the subscription, stamp.
const HEADER_BYTES: usize = 13;
/// First byte of the stamp in a message with data.
const STAMP_INDEX: usize = 5;

/// Severity of a status message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatusLevel {
    /// The request was strange, and had no effect.
    Warning = 1,
    /// The request was refused.
    Error = 2,
}

/// The first message: the name of the run, and no capability.
pub fn server_info(name: &str, session: &str) -> String {
    json!({"op": "serverInfo", "name": name, "capabilities": [], "metadata": {}, "sessionId": session})
        .to_string()
}

/// All topics as channels.
pub fn advertise() -> String {
    let channels: Vec<Value> = RunTopic::ALL.into_iter().filter_map(channel).collect();
    json!({"op": "advertise", "channels": channels}).to_string()
}

/// A channel; the schema of a binary encoding is base64.
fn channel(topic: RunTopic) -> Option<Value> {
    let (encoding, schema) = topic.encoding()?;
    let text = match schema.encoding.as_str() {
        "protobuf" => STANDARD.encode(&schema.data),
        _ => String::from_utf8_lossy(&schema.data).into_owned(),
    };
    Some(json!({
        "id": topic.channel(),
        "topic": topic.name(),
        "encoding": encoding,
        "schemaName": schema.name,
        "schema": text,
        "schemaEncoding": schema.encoding,
    }))
}

/// A notice that the viewer displays.
pub fn status(level: StatusLevel, message: &str) -> String {
    json!({"op": "status", "level": level as u8, "message": message}).to_string()
}

/// Beginning of a message with data; its stamp is 0.
pub fn data_header(subscription: u32) -> Vec<u8> {
    let mut bytes = vec![DATA_OPCODE];
    bytes.extend(subscription.to_le_bytes());
    bytes.resize(HEADER_BYTES, 0);
    bytes
}

/// Sets the stamp of a message with data. A stamp before the epoch is sent as the epoch.
pub fn set_data_stamp(bytes: &mut [u8], stamp: Stamp) {
    let nanos = u64::try_from(stamp.nanos).unwrap_or(0);
    bytes[STAMP_INDEX..HEADER_BYTES].copy_from_slice(&nanos.to_le_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_begins_with_code_subscription_and_stamp() {
        let mut bytes = data_header(0x0102);
        set_data_stamp(&mut bytes, Stamp::from_nanos(3));
        assert_eq!(bytes, [1, 2, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0]);
        set_data_stamp(&mut bytes, Stamp::from_nanos(-3));
        assert_eq!(bytes[STAMP_INDEX..], [0; 8]);
    }

    #[test]
    fn no_capability_is_offered_and_each_topic_has_a_schema() {
        let info: Value = serde_json::from_str(&server_info("demo: house", "1")).unwrap();
        assert_eq!(info["capabilities"], json!([]));
        let all: Value = serde_json::from_str(&advertise()).unwrap();
        let channels = all["channels"].as_array().unwrap();
        assert_eq!(channels.len(), RunTopic::ALL.len());
        for channel in channels {
            assert!(channel["schema"].as_str().is_some_and(|schema| schema.len() > 20), "{channel}");
        }
    }
}
