//! The topics that a sequence is read from.

use super::chosen_images::ChosenImages;
use super::survey::Survey;
use std::fmt;

/// The topics of a sequence: images, odometry, gyro, scans.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RosImageTopics {
    /// Topic of the colour images.
    pub color: String,
    /// Topic of the depth images.
    pub depth: String,
    /// Topic of the camera's intrinsics; empty if a camera was given.
    pub info: String,
    /// Topic of the odometry; empty without odometry.
    pub odometry: String,
    /// Topic of the IMU whose gyro gives the heading; empty without one.
    pub imu: String,
    /// Topic of the laser's scans; empty without one.
    pub scans: String,
    /// Unused topics of images, with the number of their messages.
    pub left: Vec<(String, usize)>,
}

impl RosImageTopics {
    /// The topics of these images, if there are some.
    pub(super) fn of(images: Option<&ChosenImages>, survey: &Survey) -> Self {
        let name =
            |of: fn(&ChosenImages) -> &String| images.map_or_else(String::new, |images| of(images).clone());
        let (color, depth) = (name(|images| &images.color.name), name(|images| &images.depth.name));
        let left = survey.image_topics().into_iter().filter(|topic| ![&color, &depth].contains(&&topic.name));
        let left = left.map(|topic| (topic.name, topic.count)).collect();
        Self { color, depth, info: name(|images| &images.info), left, ..Self::default() }
    }

    /// Each used topic with the sensor that it is used as.
    pub fn uses(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let uses = [
            ("colour", &self.color),
            ("depth", &self.depth),
            ("camera_info", &self.info),
            ("odometry", &self.odometry),
            ("gyro", &self.imu),
            ("laser", &self.scans),
        ];
        uses.into_iter()
            .filter(|(_, topic)| !topic.is_empty())
            .map(|(sensor, topic)| (sensor, topic.as_str()))
    }
}

impl fmt::Display for RosImageTopics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let uses: Vec<String> = self.uses().map(|(sensor, topic)| format!("{sensor} on {topic}")).collect();
        f.write_str(&uses.join(", "))
    }
}
