//! Visual poses away from the estimate, decided by scans.

use crate::pose_monitor::recent_scans::RecentScans;
use trundle_core::{OccupancyGrid, Pose2};

/// The estimate, for the verdict on a jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseBelief {
    /// `map_from_base`.
    pub pose: Pose2,
    /// Standard deviation of the position, m.
    pub position_sigma: f64,
    /// Standard deviation of the heading, rad.
    pub heading_sigma: f64,
}

/// Possible drift of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drift {
    /// The estimate.
    pub(crate) belief: PoseBelief,
    /// Whether wheels or gyro were wrong recently: the drift may exceed the standard deviations.
    pub(crate) is_odometry_wrong: bool,
    /// Whether there is certain evidence that the robot was carried away: any distance is possible.
    pub(crate) is_displaced: bool,
    /// Whether the visual map was corrected at this image: its frame may have moved by any distance.
    pub(crate) is_corrected: bool,
}

/// Verdict on a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VisualJump {
    /// The pose is near the estimate, or the scans do not contradict it. The localizer decides by its covariance.
    Allowed,
    /// The scans contradict the pose, or do not confirm a far one.
    Refused,
}

/// Distance of a visual pose from the estimate within which the localizer alone decides \[m\]. Source: ours.
const NEAR_M: f64 = 0.25;
/// Angle of a visual pose from the estimate within which the localizer alone decides \[rad\]: 6 deg. Source: ours.
const NEAR_RAD: f64 = 0.1;
/// Possible drift of the position beyond the standard deviations \[m\]. Within it, scans must not contradict the pose. Source: ours.
const DRIFT_M: f64 = 1.0;
/// Possible drift of the heading beyond the standard deviations \[rad\]: 20 deg. Source: ours.
const DRIFT_RAD: f64 = 0.35;
/// Number of standard deviations of a likely drift \[1\]. Within it, only a decisive contradiction by scans refuses the pose. Source: ours.
const DRIFT_SIGMAS: f64 = 3.0;
/// Log-likelihood ratio of the scans above which they decide between two poses \[nats\]. Source: ours, 400 to 1.
const DECISIVE_NATS: f64 = 6.0;

impl VisualJump {
    /// The verdict on the visual pose `found`, at `odom_from_base`, of a robot that was not carried away.
    pub(crate) fn judge(
        drift: &Drift,
        found: Pose2,
        odom_from_base: Pose2,
        scans: (&RecentScans, &OccupancyGrid),
    ) -> Self {
        let Drift { belief, is_odometry_wrong, is_displaced, is_corrected } = drift;
        let off = belief.pose.inverse() * found;
        let is_within =
            |distance: f64, turn: f64| off.position().norm() <= distance && off.theta.abs() <= turn;
        let is_near = is_within(NEAR_M, NEAR_RAD);
        let (drift_m, drift_rad) =
            (DRIFT_SIGMAS * belief.position_sigma, DRIFT_SIGMAS * belief.heading_sigma);
        let is_likely = is_within(drift_m, drift_rad);
        let is_drift = is_within(drift_m.max(DRIFT_M), drift_rad.max(DRIFT_RAD));
        if is_near && (is_likely || !is_corrected) {
            return Self::Allowed;
        }
        let (recent, grid) = scans;
        let nats_at = |pose: Pose2| recent.log_likelihood(grid, pose, odom_from_base);
        let nats = nats_at(found) - nats_at(belief.pose);
        let is_possible = is_likely || *is_displaced || is_drift && *is_odometry_wrong;
        let needed = match (is_possible, is_drift) {
            (true, _) => -DECISIVE_NATS,
            (false, true) => 0.0,
            (false, false) => DECISIVE_NATS,
        };
        if nats >= needed { Self::Allowed } else { Self::Refused }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;
    use std::f64::consts::PI;
    use trundle_core::Vector2;

    const BELIEF: PoseBelief =
        PoseBelief { pose: Pose2 { x: -0.6, y: 0.2, theta: 0.3 }, position_sigma: 0.02, heading_sigma: 0.01 };

    /// The verdict after scans of a room during a turn by 40 deg.
    fn verdict(belief: &PoseBelief, map: &Room, (room, truth): (&Room, Pose2), found: Pose2) -> VisualJump {
        let mut recent = RecentScans::default();
        for i in 0..5 {
            let odom_from_base = Pose2::new(0.0, 0.0, 0.175 * (f64::from(i) - 4.0));
            recent.add(odom_from_base, &room.scan(truth * odom_from_base, f64::from(i)));
        }
        let drift =
            Drift { belief: *belief, is_odometry_wrong: false, is_displaced: false, is_corrected: false };
        VisualJump::judge(&drift, found, Pose2::IDENTITY, (&recent, &map.map()))
    }

    /// The verdict after one scan of a room from a pose.
    fn verdict_by_scan(drift: &Drift, found: Pose2, (room, at): (&Room, Pose2)) -> VisualJump {
        let mut recent = RecentScans::default();
        recent.add(Pose2::IDENTITY, &room.scan(at, 0.0));
        VisualJump::judge(drift, found, Pose2::IDENTITY, (&recent, &room.map()))
    }

    #[test]
    fn the_look_alike_pose_half_a_turn_on_is_refused() {
        let room = Room::default();
        let found = Pose2::new(0.0, 0.0, PI) * BELIEF.pose;
        assert_eq!(verdict(&BELIEF, &room, (&room, BELIEF.pose), found), VisualJump::Refused);
        let crowded = room.clone().with_person(Vector2::new(0.6, 0.3));
        assert_eq!(verdict(&BELIEF, &room, (&crowded, BELIEF.pose), found), VisualJump::Refused);
    }

    #[test]
    fn a_pose_that_the_scan_fits_far_better_is_allowed_at_any_distance() {
        let room = Room::with_corner_box();
        for off in [Pose2::new(0.6, 0.0, 0.2), Pose2::new(1.3, 0.3, 2.0)] {
            let truth = BELIEF.pose * off;
            assert_eq!(verdict(&BELIEF, &room, (&room, truth), truth), VisualJump::Allowed, "{off:?}");
        }
    }

    #[test]
    fn a_pose_by_images_of_a_person_is_refused_where_the_scan_fits_the_estimate() {
        let room = Room::with_corner_box();
        let found = BELIEF.pose * Pose2::new(0.4, 0.2, 0.0);
        assert_eq!(verdict(&BELIEF, &room, (&room, BELIEF.pose), found), VisualJump::Refused);
        let near = BELIEF.pose * Pose2::new(0.1, 0.0, 0.05);
        assert_eq!(verdict(&BELIEF, &room, (&room, BELIEF.pose), near), VisualJump::Allowed);
    }

    #[test]
    fn a_robot_that_knows_nothing_of_its_pose_is_located_anywhere_and_a_lost_one_nearby() {
        let room = Room::default();
        let far = BELIEF.pose * Pose2::new(1.5, 0.4, 0.5);
        let lost = |sigma| PoseBelief { position_sigma: sigma, heading_sigma: sigma, ..BELIEF };
        assert_eq!(verdict(&lost(100.0), &room, (&room, far), far), VisualJump::Allowed);
        let look_alike = Pose2::new(0.0, 0.0, PI) * BELIEF.pose;
        assert_eq!(verdict(&lost(0.4), &room, (&room, BELIEF.pose), look_alike), VisualJump::Refused);
    }

    #[test]
    fn a_step_beyond_the_standard_deviations_needs_scans_that_do_not_object_unless_the_odometry_was_wrong() {
        let room = Room::with_corner_box();
        let step = BELIEF.pose * Pose2::new(0.0, 0.0, 0.12);
        let judge = |is_odometry_wrong, scan_of: Pose2| {
            let drift = Drift { belief: BELIEF, is_odometry_wrong, is_displaced: false, is_corrected: false };
            verdict_by_scan(&drift, step, (&room, scan_of))
        };
        // A scan between both poses, slightly nearer to the estimate: worse at the visual pose, but not decisively.
        let between = BELIEF.pose * Pose2::new(0.0, 0.0, 0.05);
        assert_eq!(judge(false, between), VisualJump::Refused);
        assert_eq!(judge(true, between), VisualJump::Allowed);
        assert_eq!(judge(false, step), VisualJump::Allowed, "the scan is that of the step");
    }

    #[test]
    fn a_recognised_place_far_from_a_displaced_robot_is_refused_only_where_the_scans_fit_the_odometry_far_better()
     {
        let room = Room::with_corner_box();
        let far = BELIEF.pose * Pose2::new(1.3, 0.3, 2.0);
        for (sigma, scan_of, expected) in [
            (0.02, BELIEF.pose, VisualJump::Refused),
            (100.0, BELIEF.pose, VisualJump::Refused),
            (0.02, far, VisualJump::Allowed),
            (100.0, far, VisualJump::Allowed),
        ] {
            let belief = PoseBelief { position_sigma: sigma, heading_sigma: sigma, ..BELIEF };
            let drift = Drift { belief, is_odometry_wrong: false, is_displaced: true, is_corrected: true };
            assert_eq!(verdict_by_scan(&drift, far, (&room, scan_of)), expected, "{sigma} {scan_of:?}");
        }
    }

    #[test]
    fn a_near_pose_after_a_correction_of_the_visual_map_is_refused_where_the_scans_fit_the_estimate() {
        let room = Room::with_corner_box();
        let judge = |is_corrected, off: Pose2, scan_of: Pose2| {
            let drift = Drift { belief: BELIEF, is_odometry_wrong: false, is_displaced: false, is_corrected };
            verdict_by_scan(&drift, BELIEF.pose * off, (&room, scan_of))
        };
        let pulled = Pose2::new(0.08, 0.08, 0.05);
        assert_eq!(judge(false, pulled, BELIEF.pose), VisualJump::Allowed);
        assert_eq!(judge(true, pulled, BELIEF.pose), VisualJump::Refused);
        assert_eq!(
            judge(true, pulled, BELIEF.pose * pulled),
            VisualJump::Allowed,
            "the scan is that of the step"
        );
        let within = Pose2::new(0.03, 0.03, 0.02);
        assert_eq!(judge(true, within, BELIEF.pose), VisualJump::Allowed, "within three sigma");
    }
}
