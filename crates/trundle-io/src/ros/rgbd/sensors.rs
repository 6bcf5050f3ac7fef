//! Gyro and laser of a robot's bag, beside its odometry.

use super::options::RosSequenceOptions;
use super::survey::Survey;
use crate::ros::robot_sensors::{BasePlace, RosScans, choose_gyro, choose_scans};
use trundle_core::{GyroRate, Pose2, Stamp};

/// Gyro and laser of a robot.
#[derive(Default)]
pub(super) struct Sensors {
    pub(super) imu_topic: String,
    pub(super) gyro: Vec<GyroRate>,
    pub(super) scan_topic: String,
    pub(super) scans: RosScans,
}

impl Sensors {
    /// The sensors beside the odometry; none without odometry.
    pub(super) fn of(
        survey: &mut Survey,
        options: &RosSequenceOptions,
        (base, odometry): (Option<&str>, &[(Stamp, Pose2)]),
    ) -> Result<Self, String> {
        let mut sensors = Self::default();
        let (Some((first, _)), Some((last, _))) = (odometry.first(), odometry.last()) else {
            return Ok(sensors);
        };
        let scans = match options.is_for_robot {
            true => survey.scans.take_out(options.scan_topic.as_deref())?,
            false => Vec::new(),
        };
        let place = BasePlace { contents: &survey.contents, base, times: (*first, *last) };
        let imu_topic = options.imu_topic.as_deref();
        if let Some(gyro) = choose_gyro(&survey.imus, imu_topic, &place, &mut survey.warnings)? {
            (sensors.imu_topic, sensors.gyro) = gyro;
        }
        if let Some(scans) = choose_scans(scans, &place, &mut survey.warnings) {
            (sensors.scan_topic, sensors.scans) = scans;
        }
        Ok(sensors)
    }
}

/// Accepts missing images where a laser replaces them, with a warning if there are images that cannot be used.
pub(super) fn without_images(survey: &mut Survey, problem: String, sensors: &Sensors) -> Result<(), String> {
    if sensors.scan_topic.is_empty() {
        if !survey.scans.is_empty() {
            return Err(format!(
                "{problem}; no odometry beside the scans of a laser, expected nav_msgs/Odometry or transforms from odom to the base"
            ));
        }
        let unused =
            survey.warnings.iter().map(ToString::to_string).find(|text| text.starts_with("laser on"));
        let unused = unused.map_or_else(String::new, |text| format!(" ({text})"));
        return Err(format!("{problem}; no usable scans of a laser{unused}, expected images or scans"));
    }
    if !survey.image_topics().is_empty() {
        survey.warnings.add(&format!("the images are unused: {problem}"), "");
    }
    Ok(())
}
