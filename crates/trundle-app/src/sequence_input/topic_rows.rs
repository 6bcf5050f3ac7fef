//! The list of a bag's topics, with what each is used as.

use super::SequenceOptions;
use crate::AppError;
use trundle_io::{FileKind, RosSequence, RosTopics};

/// A row a topic of a bag or a recording: name, type, number of messages, encoding of its first image, and the sensor that `trundle replay`
/// uses it as. The last is empty for unused topics, and for all topics of a recording and of a bag that cannot be replayed.
///
/// # Errors
/// As [`RosTopics::read`].
pub fn topic_rows(options: &SequenceOptions<'_>) -> Result<Vec<Vec<String>>, AppError> {
    let topics = RosTopics::read(options.path)?;
    let is_recording = FileKind::of(options.path)? == FileKind::TrundleRecording;
    let options = options.clone().for_robot();
    let open = |needs_camera| RosSequence::open(options.path, &options.topics, needs_camera).ok();
    let bag = (!is_recording).then(|| open(true).or_else(|| open(false))).flatten();
    let used_as = |name: &str| {
        let mut uses = bag.iter().flat_map(|bag| bag.topics().uses());
        uses.find_map(|(sensor, topic)| (topic == name).then(|| sensor.to_owned())).unwrap_or_default()
    };
    let row = |row: [String; 4]| {
        let used = used_as(&row[0]);
        row.into_iter().chain([used]).collect()
    };
    Ok(topics.rows().map(row).collect())
}
