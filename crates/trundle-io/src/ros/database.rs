//! Reader of rosbag2 files in the SQLite storage format.

use super::sqlite::{Sqlite, TableRows, Value};
use crate::IoError;
use crate::recording::RawMessage;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// The messages of a rosbag2 `.db3` file in the order of writing.
///
/// Tables of the file: `topics` (id, name, type, serialization_format, ...) and `messages` (id, topic_id, timestamp, data).
pub(super) struct BagDatabase {
    path: PathBuf,
    sqlite: Sqlite,
    /// Name and type of each topic, by id.
    topics: BTreeMap<i64, (String, String)>,
    messages: TableRows,
}

impl BagDatabase {
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        let mut sqlite = Sqlite::open(path)?;
        let missing =
            |name: &str| IoError::malformed(path, format!("no table '{name}', expected a ROS 2 bag"));
        let topics_root = sqlite.table("topics")?.ok_or_else(|| missing("topics"))?;
        let messages_root = sqlite.table("messages")?.ok_or_else(|| missing("messages"))?;
        let mut topics = BTreeMap::new();
        let mut rows = TableRows::new(topics_root);
        while let Some((id, values)) = sqlite.next_row(&mut rows)? {
            if let [_, Value::Text(name), Value::Text(kind), Value::Text(format), ..] = &values[..]
                && format == "cdr"
            {
                topics.insert(id, (name.clone(), kind.clone()));
            }
        }
        Ok(Self { path: path.to_owned(), sqlite, topics, messages: TableRows::new(messages_root) })
    }

    pub(super) fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        while let Some((id, mut values)) = self.sqlite.next_row(&mut self.messages)? {
            let data = values.pop();
            let (Some(Value::Integer(topic)), Some(Value::Integer(nanos))) = (values.get(1), values.get(2))
            else {
                let problem = format!("message {id}: expected topic_id and timestamp");
                return Err(IoError::malformed(&self.path, problem));
            };
            // A row without bytes is a message of length 0, which its reader refuses alone.
            let data = if let Some(Value::Blob(data)) = data { data } else { Vec::new() };
            if let Some((topic, schema)) = self.topics.get(topic) {
                let (topic, schema) = (topic.clone(), schema.clone());
                return Ok(Some(RawMessage {
                    topic,
                    schema,
                    stamp: Stamp::from_nanos(*nanos),
                    is_json: false,
                    data,
                }));
            }
        }
        Ok(None)
    }
}
