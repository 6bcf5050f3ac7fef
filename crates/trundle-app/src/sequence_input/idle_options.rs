//! Refusal of options that have no effect on the kind of the images.

use super::SequenceOptions;
use crate::AppError;
use trundle_io::FileKind;

impl SequenceOptions<'_> {
    /// Refuses topics for images without topics, and reading up to a cut for images that are no recording. A bag is always read up to its
    /// cut.
    ///
    /// # Errors
    /// Names the option and the kind of the images.
    pub(super) fn refuse_idle(&self, kind: FileKind) -> Result<(), AppError> {
        if !matches!(kind, FileKind::SequenceFolder | FileKind::TrundleRecording) {
            return Ok(());
        }
        let refused = |option: &str, expected: &str| {
            let name = self.path.display();
            Err(AppError::Input(format!(
                "{option} has no effect on {name}, expected {expected} or no {option}"
            )))
        };
        if let Some((option, topic)) = self.first_topic() {
            return refused(&format!("{option} {topic}"), "a ROS 2 bag");
        }
        match self.recover && kind != FileKind::TrundleRecording {
            true => refused("--recover", "a recording of trundle"),
            false => Ok(()),
        }
    }

    /// Refuses a topic of scans for images alone.
    ///
    /// # Errors
    /// Names the topic.
    pub(crate) fn refuse_unused_scans(&self) -> Result<(), AppError> {
        let Some(topic) = self.topics.scan_topic.as_ref().filter(|_| !self.topics.is_for_robot) else {
            return Ok(());
        };
        Err(AppError::Input(format!(
            "--scan-topic {topic} has no effect on the images of {}, expected no --scan-topic: `trundle replay` uses images and scans",
            self.path.display()
        )))
    }

    /// Name and value of the first topic that is given.
    pub(crate) fn first_topic(&self) -> Option<(&'static str, &str)> {
        let topics = &self.topics;
        let given = [
            ("--color-topic", &topics.color_topic),
            ("--depth-topic", &topics.depth_topic),
            ("--info-topic", &topics.info_topic),
            ("--odom-topic", &topics.odometry_topic),
            ("--imu-topic", &topics.imu_topic),
            ("--scan-topic", &topics.scan_topic),
        ];
        given.into_iter().find_map(|(option, topic)| Some((option, topic.as_deref()?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn topics_and_cuts_are_refused_where_they_have_no_effect() {
        let plain = SequenceOptions::new(Path::new("in"));
        let mut named = plain.clone();
        named.topics.depth_topic = Some("/depth".to_owned());
        let cut = SequenceOptions { recover: true, ..plain.clone() };
        let message =
            |options: &SequenceOptions<'_>, kind| options.refuse_idle(kind).err().map(|e| e.to_string());
        let folder = FileKind::SequenceFolder;
        let topic = message(&named, folder).unwrap();
        assert!(topic.contains("--depth-topic /depth has no effect on in, expected a ROS 2 bag"), "{topic}");
        assert!(message(&named, FileKind::TrundleRecording).is_some());
        let recover = message(&cut, folder).unwrap();
        assert!(recover.contains("--recover has no effect on in, expected a recording"), "{recover}");
        assert_eq!(message(&cut, FileKind::TrundleRecording), None);
        assert_eq!(message(&plain, folder), None);
    }
}
