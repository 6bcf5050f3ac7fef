//! Schemas and channels of an MCAP file, and the messages that they name.

use super::topics;
use crate::IoError;
use mcap::records::{Channel, Record};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use trundle_core::Stamp;

/// A message with the bytes of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RawMessage {
    pub topic: String,
    pub schema: String,
    pub stamp: Stamp,
    /// Whether the data is JSON, not CDR.
    pub is_json: bool,
    pub data: Vec<u8>,
}

/// Encoding of the messages that a reader accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Trundle's own: JSON, or CDR of ROS 2; any other message is an error.
    Own,
    /// Messages of ROS 2; others are skipped.
    Cdr,
}

/// The schemas and channels read so far.
pub(super) struct Channels {
    encoding: Encoding,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, ChannelName>,
    passed_over: BTreeSet<u16>,
    /// Whether the definitions of channels may be lost: their messages are skipped.
    pub(super) are_incomplete: bool,
}

/// Topic and schema of a channel.
struct ChannelName {
    topic: String,
    schema: u16,
    is_json: bool,
    /// Schema of the JSON in the channel's texts.
    json_schema: Option<String>,
}

impl Channels {
    pub(super) fn new(encoding: Encoding) -> Self {
        let (schemas, channels) = Default::default();
        Self { encoding, schemas, channels, passed_over: BTreeSet::new(), are_incomplete: false }
    }

    pub(super) fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Stores schemas and channels, and assigns their names to messages; `path` is the file in errors.
    pub(super) fn take(
        &mut self,
        record: Record<'static>,
        path: &Path,
    ) -> Result<Option<RawMessage>, IoError> {
        match record {
            Record::Schema { header, .. } => drop(self.schemas.insert(header.id, header.name)),
            Record::Channel(channel) => self.add(channel, path)?,
            Record::Message { header, .. } if self.passed_over.contains(&header.channel_id) => {}
            Record::Message { header, data } => {
                let Some(ChannelName { topic, schema, is_json, json_schema }) =
                    self.channels.get(&header.channel_id)
                else {
                    return self.nameless(header.channel_id, path);
                };
                let nanos = i64::try_from(header.log_time).map_err(|_| {
                    IoError::malformed(path, format!("log time {} ns is out of range", header.log_time))
                })?;
                return Ok(Some(RawMessage {
                    topic: topic.clone(),
                    schema: json_schema.as_ref().or(self.schemas.get(schema)).cloned().unwrap_or_default(),
                    stamp: Stamp::from_nanos(nanos),
                    is_json: *is_json,
                    data: data.into_owned(),
                }));
            }
            _ => {}
        }
        Ok(None)
    }

    fn add(&mut self, channel: Channel, path: &Path) -> Result<(), IoError> {
        let is_cdr = channel.message_encoding == "cdr";
        if self.encoding == Encoding::Cdr && !is_cdr {
            self.passed_over.insert(channel.id);
            return Ok(());
        }
        if !is_cdr && channel.message_encoding != "json" {
            let problem = format!(
                "messages on {} are in '{}', expected json or cdr",
                channel.topic, channel.message_encoding
            );
            return Err(IoError::malformed(path, problem));
        }
        let json_schema = channel.metadata.get(topics::SCHEMA_KEY).cloned();
        let name =
            ChannelName { topic: channel.topic, schema: channel.schema_id, is_json: !is_cdr, json_schema };
        self.channels.insert(channel.id, name);
        Ok(())
    }

    fn nameless(&self, id: u16, path: &Path) -> Result<Option<RawMessage>, IoError> {
        if self.are_incomplete {
            return Ok(None);
        }
        Err(IoError::malformed(path, format!("a message on the unknown channel {id}")))
    }
}
