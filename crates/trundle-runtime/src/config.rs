//! The configuration of the robot.

use crate::{
    camera_mount::CameraMount, goal_approach::GoalApproachConfig,
    mission::executor_config::MissionExecutorConfig, range_source::RangeSource, schedule::Schedule,
};
use serde::{Deserialize, Deserializer, Serialize};
use trundle_control::{FollowerConfig, SafetyConfig};
use trundle_core::{
    DifferentialDrive, DriveLimits, Footprint, Invalid, PinholeCamera, Vector2, footprint_corners,
    number_list, require_in,
};
use trundle_estimation::{LocalizerConfig, OdometryConfig, StationLightConfig};
use trundle_mapping::{DepthScanConfig, MapperConfig, ScanMatchConfig};
use trundle_planning::{ObstacleTrackerConfig, PlannerConfig};
use trundle_slam::SlamConfig;

/// All settings of the robot: one `robot.toml`. Unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RobotConfig {
    /// Radius of the smallest disc around the base's origin that contains the robot, m, above 0. A larger disc keeps the robot farther from
    /// obstacles and out of narrow passages. Default 0.1755: the Kobuki.
    pub footprint_radius: f64,
    /// Corners `[x, y]` of a convex outline in place of the disc, base frame, m. Default none: the disc.
    #[serde(deserialize_with = "corners")]
    pub footprint: Option<Vec<[f64; 2]>>,
    /// Sensor for mapping and for safety stops. Default depth_camera: the sensor of \[Li18\].
    pub sight: RangeSource,
    /// Whether the beams of a laser scan are corrected by the odometry for the motion during the sweep. The laser must report the times of
    /// its beams. Default false: the effect on the robot was not measured.
    pub deskew: bool,
    /// Geometry of the base. Default: the Kobuki.
    pub drive: DifferentialDrive,
    /// Limits of commands for the base. Default: the Kobuki.
    pub limits: DriveLimits,
    /// The camera's image. Default: Kinect V2.
    pub camera: PinholeCamera,
    /// Pose of the camera on the base.
    pub mount: CameraMount,
    /// Delay of the image stamps: stamp minus time of exposure, s, -1 to 1. A run subtracts it from the stamps, besides the delay reported
    /// by the camera's driver. `trundle calibrate delay` measures it. Default 0: the stamp is the time of exposure.
    pub image_delay: f64,
    /// Rates of the stages.
    pub schedule: Schedule,
    /// Wheels and gyro.
    pub odometry: OdometryConfig,
    /// Visual tracking and mapping.
    pub slam: SlamConfig,
    /// Depth image to scan.
    pub scan: DepthScanConfig,
    /// Scan matching against the map.
    pub scan_match: ScanMatchConfig,
    /// Fusion.
    pub localization: LocalizerConfig,
    /// Occupancy grid.
    pub mapping: MapperConfig,
    /// Detection of moving obstacles in the scans.
    pub movers: ObstacleTrackerConfig,
    /// Planning.
    pub planning: PlannerConfig,
    /// Trajectory following and final approach.
    pub control: FollowerConfig,
    /// Turns and straight moves onto the goal in narrow spaces.
    pub docking: GoalApproachConfig,
    /// Safety.
    pub safety: SafetyConfig,
    /// Missions, exploration, patience.
    pub mission_executor: MissionExecutorConfig,
    /// Light of the charging station.
    pub station: StationLightConfig,
}

/// Corners as a list, or as the text form of Nav2's costmaps.
fn corners<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<[f64; 2]>>, D::Error> {
    #[derive(Deserialize)]
    struct Corner(#[serde(deserialize_with = "number_list")] Option<[f64; 2]>);
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Corners {
        List(Vec<Corner>),
        Text(String),
    }
    match Option::<Corners>::deserialize(deserializer)? {
        None => Ok(None),
        Some(Corners::List(corners)) => {
            Ok(Some(corners.into_iter().filter_map(|Corner(corner)| corner).collect()))
        }
        Some(Corners::Text(text)) => {
            let corners = footprint_corners(&text).map_err(serde::de::Error::custom)?;
            Ok(Some(corners.iter().map(|corner| [corner.x, corner.y]).collect()))
        }
    }
}

impl Default for RobotConfig {
    fn default() -> Self {
        Self {
            footprint_radius: Footprint::KOBUKI.circumscribed_radius(),
            footprint: None,
            sight: RangeSource::DepthCamera,
            deskew: false,
            drive: DifferentialDrive::KOBUKI,
            limits: DriveLimits::KOBUKI,
            camera: PinholeCamera::kinect_v2(),
            mount: CameraMount::default(),
            image_delay: 0.0,
            schedule: Schedule::default(),
            odometry: OdometryConfig::default(),
            slam: SlamConfig::default(),
            scan: DepthScanConfig::default(),
            scan_match: ScanMatchConfig::default(),
            localization: LocalizerConfig::default(),
            mapping: MapperConfig::default(),
            movers: ObstacleTrackerConfig::default(),
            planning: PlannerConfig::default(),
            control: FollowerConfig::default(),
            docking: GoalApproachConfig::default(),
            safety: SafetyConfig::default(),
            mission_executor: MissionExecutorConfig::default(),
            station: StationLightConfig::default(),
        }
    }
}

impl RobotConfig {
    /// Refuses a base with a top speed above the odometry's limit: at full speed all readings would be rejected.
    pub(crate) fn require_plausible_speeds(&self) -> Result<(), Invalid> {
        let min = self.limits.wheel_speed;
        if self.odometry.max_speed < min {
            let expected = format!("limits.wheel_speed or more, {min} m/s");
            return Err(Invalid::new("odometry.max_speed", self.odometry.max_speed, "m/s", expected));
        }
        Ok(())
    }

    /// Refuses an image delay outside -1 to 1 s, probably a mistyped number.
    pub(crate) fn require_image_delay(&self) -> Result<(), Invalid> {
        require_in("image_delay", self.image_delay, "s", -1.0, 1.0).map(drop)
    }

    /// The same robot with all seeds of its random samples derived from `seed`.
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.slam.seed = seed;
        self
    }

    /// The robot's outline: the polygon if there is one, else the disc.
    ///
    /// # Errors
    /// When the radius is not positive, or the polygon is not convex.
    pub fn footprint(&self) -> Result<Footprint, Invalid> {
        match &self.footprint {
            Some(corners) => Footprint::polygon(corners.iter().map(|c| Vector2::new(c[0], c[1])).collect()),
            None => Footprint::disc(self.footprint_radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistyped_image_delay_is_refused_by_name() {
        for image_delay in [34.0, -1.5, f64::NAN] {
            let robot = RobotConfig { image_delay, ..RobotConfig::default() };
            assert_eq!(robot.validated().unwrap_err().field, "image_delay");
        }
    }
}
