//! Nav2's error codes for the reasons of a failed task.

use crate::generated::nav2_msgs::{
    ComputePathToPoseResult, DockRobotResult, FollowPathResult, NavigateToPoseResult,
};
use trundle_runtime::{NoPath, Reason, ReasonKind};

/// Returns the error code of `NavigateToPose` for a reason. As in Nav2's navigator, it is the code of the failed planner or controller.
#[must_use]
pub fn of_reason(reason: &Reason) -> u16 {
    if let Reason::NoPath { cause, .. } = reason {
        return of_no_path(cause);
    }
    let Some(code) = reason.kinds().iter().find_map(|kind| of_kind(*kind)) else {
        return NavigateToPoseResult::UNKNOWN;
    };
    code
}

/// The error code of `ComputePathToPose`.
#[must_use]
pub fn of_no_path(cause: &NoPath) -> u16 {
    match cause {
        NoPath::Blocked { .. } => ComputePathToPoseResult::NO_VALID_PATH,
        NoPath::StartInObstacle { .. } => ComputePathToPoseResult::START_OCCUPIED,
        NoPath::GoalInObstacle { .. } | NoPath::GoalInZone { .. } => ComputePathToPoseResult::GOAL_OCCUPIED,
        NoPath::StartOutside => ComputePathToPoseResult::START_OUTSIDE_MAP,
        NoPath::GoalOutside => ComputePathToPoseResult::GOAL_OUTSIDE_MAP,
        _ => ComputePathToPoseResult::UNKNOWN,
    }
}

fn of_kind(kind: ReasonKind) -> Option<u16> {
    Some(match kind {
        ReasonKind::PathBlocked => ComputePathToPoseResult::NO_VALID_PATH,
        ReasonKind::TooLittleRoom | ReasonKind::NoGoZone => ComputePathToPoseResult::GOAL_OCCUPIED,
        ReasonKind::OffTheMap => ComputePathToPoseResult::GOAL_OUTSIDE_MAP,
        ReasonKind::PoseUnknown | ReasonKind::PoseUncertain | ReasonKind::ArrivalUncertain => {
            FollowPathResult::TF_ERROR
        }
        ReasonKind::Obstacle | ReasonKind::Contact | ReasonKind::Cliff | ReasonKind::MovingObstacle => {
            FollowPathResult::NO_VALID_CONTROL
        }
        ReasonKind::NoProgress | ReasonKind::FinalApproach | ReasonKind::RepeatedContact => {
            FollowPathResult::FAILED_TO_MAKE_PROGRESS
        }
        ReasonKind::ImageMissing | ReasonKind::WheelsMissing | ReasonKind::DeviceLost => {
            FollowPathResult::PATIENCE_EXCEEDED
        }
        _ => return None,
    })
}

/// The error code of `DockRobot`.
#[must_use]
pub fn of_docking(reason: &Reason) -> u16 {
    let code = |kind: &ReasonKind| match kind {
        ReasonKind::NoStationLight | ReasonKind::StationLightLost | ReasonKind::StationUncertain => {
            Some(DockRobotResult::FAILED_TO_DETECT_DOCK)
        }
        ReasonKind::NoCharging => Some(DockRobotResult::FAILED_TO_CHARGE),
        ReasonKind::StationBlocked | ReasonKind::Obstacle | ReasonKind::Contact => {
            Some(DockRobotResult::FAILED_TO_CONTROL)
        }
        _ => None,
    };
    reason.kinds().iter().find_map(code).unwrap_or(DockRobotResult::UNKNOWN)
}

/// Codes of a motion relative to the robot's pose: `Spin`, `BackUp`, `DriveOnHeading`.
#[derive(Debug, Clone, Copy)]
pub struct MotionCodes {
    /// Something is in the way.
    pub collision_ahead: u16,
    /// The pose is unknown.
    pub tf_error: u16,
    /// Any other reason.
    pub unknown: u16,
}

impl MotionCodes {
    /// The code for a reason.
    #[must_use]
    pub fn of_reason(self, reason: &Reason) -> u16 {
        let code = |kind: &ReasonKind| match kind {
            ReasonKind::Obstacle
            | ReasonKind::MovingObstacle
            | ReasonKind::Contact
            | ReasonKind::RepeatedContact
            | ReasonKind::Cliff => Some(self.collision_ahead),
            ReasonKind::PoseUnknown | ReasonKind::PoseUncertain => Some(self.tf_error),
            _ => None,
        };
        reason.kinds().iter().find_map(code).unwrap_or(self.unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_collides_only_with_what_is_in_its_way() {
        let codes = MotionCodes { collision_ahead: 703, tf_error: 702, unknown: 799 };
        let of = |kind| Reason::Restored { text: String::new(), kinds: vec![ReasonKind::NoProgress, kind] };
        for (reason, code) in [
            (of(ReasonKind::Obstacle), 703),
            (of(ReasonKind::Contact), 703),
            (of(ReasonKind::Cliff), 703),
            (Reason::MovingObstacle, 703),
            (Reason::PoseUnknown, 702),
            (of(ReasonKind::ImageMissing), 799),
            (of(ReasonKind::Paused), 799),
            (Reason::Interrupted, 799),
        ] {
            assert_eq!(codes.of_reason(&reason), code, "{reason:?}");
        }
    }

    #[test]
    fn unreachable_goals_have_the_planners_codes() {
        let code = |cause| of_reason(&Reason::NoPath { cause, unseen: None });
        assert_eq!(code(NoPath::GoalOutside), 204);
        assert_eq!(code(NoPath::GoalInObstacle { missing: 0.1 }), 206);
        assert_eq!(of_reason(&Reason::PoseUnknown), 102);
        let stuck = Reason::NoProgress { time: 30.0, state: "waiting", cause: None };
        assert_eq!(of_reason(&stuck), 105);
        assert_eq!(of_reason(&Reason::Interrupted), 9000);
    }
}
