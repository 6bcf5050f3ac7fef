//! Refusal of options that do not go with the kind of the log.

use super::request::LaserMapRequest;
use crate::AppError;
use crate::sequence_input::SequenceInput;
use trundle_io::FileKind;

impl LaserMapRequest {
    /// Refuses options of a laser for RGB-D images, options of a camera for a laser log, and topics for a log without topics.
    /// `laser_option`: the name of the given option of the laser.
    ///
    /// # Errors
    /// Names the option and the kind of the log.
    pub fn refuse_wrong_options(&self, laser_option: Option<&str>) -> Result<(), AppError> {
        self.refuse_topic_of_odometry()?;
        self.refuse_idle_cut()?;
        let log = self.log.display();
        let is_sequence = SequenceInput::is_sequence(&self.log, &self.topics);
        let laser_option = laser_option.or(self.laser.scan_topic.as_ref().map(|_| "--scan-topic"));
        if let (false, Some(topic)) = (is_sequence, &self.topics.imu_topic) {
            return Err(AppError::Input(format!(
                "--imu-topic {topic} has no effect on the scans of {log}, expected RGB-D images or no --imu-topic"
            )));
        }
        match (is_sequence, &self.poses, laser_option) {
            (false, Some(_), _) => Err(AppError::Input(format!(
                "--poses is about the camera of RGB-D images, and {log} holds none"
            ))),
            (true, _, Some(option)) => Err(AppError::Input(format!(
                "{option} is about a laser, but {log} holds RGB-D images: their camera is that of camera.toml, the bag or the recording, \
                 and it sits as on the default robot, or where groundtruth.txt, the bag or the recording says"
            ))),
            _ => Ok(()),
        }
    }

    /// Refuses `recover` for a file that is neither a recording nor a bag.
    fn refuse_idle_cut(&self) -> Result<(), AppError> {
        use FileKind::{CarmenLog, Gzip, SequenceFolder, Text};
        if !self.recover || !matches!(FileKind::of(&self.log)?, CarmenLog | Gzip | SequenceFolder | Text) {
            return Ok(());
        }
        let log = self.log.display();
        Err(AppError::Input(format!(
            "--recover has no effect on {log}, expected a recording of trundle or no --recover"
        )))
    }

    /// Refuses the topic of the odometry of a log that has no topics.
    fn refuse_topic_of_odometry(&self) -> Result<(), AppError> {
        let Some(topic) = &self.topics.odometry_topic else { return Ok(()) };
        let log = self.log.display();
        match FileKind::of(&self.log)? {
            kind if kind.is_bag() => Ok(()),
            FileKind::CarmenLog | FileKind::Text | FileKind::Gzip => Err(AppError::Input(format!(
                "--odom-topic is {topic}, but {log} is a CARMEN log, whose odometry is in its own lines, expected a bag with it"
            ))),
            FileKind::SequenceFolder | FileKind::TrundleRecording => Err(AppError::Input(format!(
                "--odom-topic is {topic}, but {log} has no topics, expected a bag with it"
            ))),
            _ => Ok(()),
        }
    }
}
