//! Part of a view of the run that home and master need.

use trundle_app::operator::{MissionView, RunView};
use trundle_core::{Battery, Pose2, PoseEstimate, Stamp, Twist2};
use trundle_runtime::{DriveState, MotionHold};

/// Part of a view of the run that home and master need.
#[derive(Debug, Clone)]
pub struct RobotStatus {
    /// `map_from_base` and twist.
    pub estimate: PoseEstimate,
    /// State of the robot.
    pub state: DriveState,
    /// The mission.
    pub mission: MissionView,
    /// The battery; `None` if the body has not reported it.
    pub battery: Option<Battery>,
    /// The condition under which no wheel may turn.
    pub hold: Option<MotionHold>,
    /// `map_from_station` of the charging station.
    pub station: Option<Pose2>,
}

impl RobotStatus {
    /// A robot at rest with a known pose and without a mission.
    #[must_use]
    pub fn at_rest(pose: Pose2) -> Self {
        let (stamp, twist) = (Stamp::from_nanos(0), Twist2::new(0.0, 0.0));
        Self {
            estimate: PoseEstimate { stamp, pose, twist, covariance: Default::default() },
            state: DriveState::Idle,
            mission: MissionView::default(),
            battery: None,
            hold: None,
            station: None,
        }
    }
}

impl From<&RunView> for RobotStatus {
    fn from(view: &RunView) -> Self {
        Self {
            estimate: view.estimate,
            state: view.state.drive().cloned().unwrap_or_default(),
            mission: view.mission.clone(),
            battery: view.battery,
            hold: view.hold,
            station: view.perception.station,
        }
    }
}
