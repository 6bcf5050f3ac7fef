//! Goal poses of messages in the map frame.

use crate::convert::pose;
use crate::generated::geometry_msgs::PoseStamped;
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_core::{Invalid, Pose2};

/// Reason why a goal pose is refused.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum GoalPoseError {
    /// A number is invalid: the goal is refused.
    Invalid(Invalid),
    /// The frame of the pose is unknown: the goal fails.
    Frame(String),
}

/// A goal pose in the map frame. Poses in the frames of odometry and base are moved by the estimate of `view`.
///
/// # Errors
/// When a number is not finite, the rotation was never set, or the frame is not that of map, odometry or base.
pub fn in_map(
    goal: &PoseStamped,
    frames: &RunFrames,
    view: Option<&RunView>,
) -> Result<Pose2, GoalPoseError> {
    let pose = pose::pose2(&goal.pose).map_err(GoalPoseError::Invalid)?;
    let frame = goal.header.frame_id.trim_start_matches('/');
    let (map, odom, base) = (&frames.names.map, frames.odom(), &frames.names.base);
    if frame == map {
        return Ok(pose);
    }
    if frame != odom && frame != base {
        let message = format!("frame of the goal is '{frame}', expected {map}, {odom} or {base}");
        return Err(GoalPoseError::Frame(message));
    }
    let unplaced = || {
        let message = format!(
            "frame of the goal is '{frame}', which has no pose in {map} yet: expected {map}, or wait"
        );
        GoalPoseError::Frame(message)
    };
    let view = view.ok_or_else(unplaced)?;
    if frame == base {
        return Ok(view.estimate.pose * pose);
    }
    let odom_from_base = frames.odom_from_base(view).ok_or_else(unplaced)?;
    Ok(view.estimate.pose * odom_from_base.inverse() * pose)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::OdometryReader;
    use crate::convert::transform;
    use crate::outputs::FrameNames;
    use trundle_app::operator::Activity;
    use trundle_core::{Odometry, Stamp, Twist2};

    /// A view of a robot at `pose` of its map, whose own odometry began at (0, 0, 0) there.
    fn view(pose: Pose2) -> RunView {
        let activity = Activity { name: "waiting", reason: None };
        let mut view = RunView::of_activity(Stamp::from_nanos(5), pose, Twist2::ZERO, activity);
        view.odometry = Some(odometry(pose));
        view
    }

    fn odometry(pose: Pose2) -> Odometry {
        let (stamp, twist) = (Stamp::from_nanos(5), Twist2::ZERO);
        Odometry { stamp, pose, twist, covariance: Default::default() }
    }

    fn goal(pose: Pose2, frame: &str) -> PoseStamped {
        pose::stamped(&pose, Stamp::default(), frame)
    }

    #[test]
    fn a_goal_in_odom_refers_to_the_odometry_that_the_body_publishes() {
        // The base's odometry began at (3, 2) with the heading 90 deg, and the robot drove 1 m ahead.
        let began = Pose2::new(3.0, 2.0, std::f64::consts::FRAC_PI_2);
        let view = view(Pose2::new(1.0, 0.0, 0.0));
        let reader = OdometryReader::of_one("wheel_odom", odometry(began * view.estimate.pose));
        let frames = RunFrames { names: FrameNames::default(), body_odometry: Some(reader) };
        let ahead = began * Pose2::new(2.0, 0.5, 0.0);
        let found = in_map(&goal(ahead, "wheel_odom"), &frames, Some(&view)).unwrap();
        assert!(found.distance(&Pose2::new(2.0, 0.5, 0.0)) < 1e-9 && found.theta.abs() < 1e-9, "{found:?}");
        // As a look-up of map -> odom on /tf has it.
        let map_from_odom = view.estimate.pose * frames.odom_from_base(&view).unwrap().inverse();
        let sent = transform::planar_to_ros(&map_from_odom, Stamp::default(), "map", "wheel_odom");
        let looked_up = transform::from_ros(&sent.transform).unwrap().to_pose2() * ahead;
        assert!(found.distance(&looked_up) < 1e-9, "{looked_up:?}");
        let Err(GoalPoseError::Frame(why)) = in_map(&goal(ahead, "odom"), &frames, Some(&view)) else {
            panic!("the body's frame is wheel_odom")
        };
        assert_eq!(why, "frame of the goal is 'odom', expected map, wheel_odom or base_link");
    }

    #[test]
    fn goals_in_map_and_base_need_no_odometry_and_in_odom_they_wait_for_it() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let (ahead, mut view) = (Pose2::new(1.0, 0.0, 0.0), view(Pose2::new(2.0, 0.0, 0.0)));
        assert_eq!(in_map(&goal(ahead, "map"), &frames, None), Ok(ahead));
        assert_eq!(in_map(&goal(ahead, "/base_link"), &frames, Some(&view)).unwrap().x, 3.0);
        assert_eq!(in_map(&goal(ahead, "odom"), &frames, Some(&view)).unwrap().x, 1.0);
        view.odometry = None;
        let refused = in_map(&goal(ahead, "odom"), &frames, Some(&view)).unwrap_err();
        assert!(
            matches!(&refused, GoalPoseError::Frame(why) if why.contains("no pose in map yet")),
            "{refused:?}"
        );
        assert!(in_map(&goal(ahead, "base_link"), &frames, None).is_err());
    }
}
