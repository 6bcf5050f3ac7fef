//! Whether the robot makes progress.

use trundle_core::{Pose2, Stamp, difference_of_angles};

/// Notes when the robot last got on.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ProgressChecker {
    last: Option<(Stamp, Pose2)>,
    /// Turns that counted at this place.
    turns: u32,
}

/// Distance from the last position of progress that counts as progress \[m\]. Source: ours.
const PROGRESS_DISTANCE_M: f64 = 0.15;
/// Turn towards the goal's heading that counts as progress \[rad\]. A turn in search of a path does not count. Source: ours.
const PROGRESS_TURN_RAD: f64 = 0.2;
/// Number of turns of [`PROGRESS_TURN_RAD`] that count as progress at one place: one full turn. Further turns are not progress. Source:
/// ours.
const MAX_TURNS_AT_ONE_PLACE: u32 = 32;

impl ProgressChecker {
    /// Restarts the check.
    pub(crate) fn restart(&mut self) {
        *self = Self::default();
    }

    /// Time without progress, s; `turns_count`: whether a turn leads to the goal.
    pub(crate) fn standing_for(&mut self, now: Stamp, pose: Pose2, turns_count: bool) -> f64 {
        let (since, at) = *self.last.get_or_insert((now, pose));
        let has_turned = difference_of_angles(at.theta, pose.theta).abs() > PROGRESS_TURN_RAD;
        if at.distance(&pose) > PROGRESS_DISTANCE_M {
            (self.last, self.turns) = (Some((now, pose)), 0);
            0.0
        } else if turns_count && has_turned && self.turns < MAX_TURNS_AT_ONE_PLACE {
            // A turn at one place keeps the place.
            (self.last, self.turns) = (Some((now, Pose2 { theta: pose.theta, ..at })), self.turns + 1);
            0.0
        } else {
            now - since
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_on_the_spot_count_as_progress_only_where_they_lead_to_the_goal() {
        let mut watch = ProgressChecker::default();
        let at = |i: i32| (Stamp::default().after(f64::from(i)), Pose2::new(0.0, 0.0, f64::from(i)));
        let stood: Vec<f64> = (0..5).map(|i| watch.standing_for(at(i).0, at(i).1, false)).collect();
        assert_eq!(stood, [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(watch.standing_for(at(5).0, at(5).1, true), 0.0);
        assert_eq!(watch.standing_for(at(6).0, Pose2::new(0.2, 0.0, 5.0), false), 0.0);
    }

    #[test]
    fn to_turn_to_and_fro_on_the_spot_is_not_progress() {
        let mut watch = ProgressChecker::default();
        let turned = |i: i32| Pose2::new(1e-3 * f64::from(i), 0.0, f64::from(i % 2));
        let stood = |watch: &mut ProgressChecker, i: i32| {
            watch.standing_for(Stamp::default().after(f64::from(i)), turned(i), true)
        };
        (0..=32).for_each(|i| assert_eq!(stood(&mut watch, i), 0.0, "{i}"));
        (33..90).for_each(|i| assert!((stood(&mut watch, i) - f64::from(i - 32)).abs() < 1e-6, "{i}"));
        // At another place turns count again.
        watch.standing_for(Stamp::default().after(90.0), Pose2::new(0.5, 0.0, 0.0), true);
        assert_eq!(watch.standing_for(Stamp::default().after(91.0), Pose2::new(0.5, 0.0, 1.0), true), 0.0);
        // Turns count again for another goal as well.
        (91..200).for_each(|i| _ = stood(&mut watch, i));
        watch.restart();
        (200..=232).for_each(|i| assert_eq!(stood(&mut watch, i), 0.0, "{i}"));
    }

    #[test]
    fn to_creep_while_turning_is_to_get_on() {
        let mut watch = ProgressChecker::default();
        for i in 0..200 {
            let pose = Pose2::new(6e-3 * f64::from(i), 0.0, f64::from(i % 2));
            assert_eq!(watch.standing_for(Stamp::default().after(f64::from(i)), pose, true), 0.0, "{i}");
        }
    }

    #[test]
    fn a_robot_that_drives_makes_progress_at_any_speed_above_step_over_patience() {
        for speed in [0.01, 0.05, 0.5] {
            let mut checker = ProgressChecker::default();
            let stood = (0..3000).map(|i| {
                let time = 0.1 * f64::from(i);
                checker.standing_for(Stamp::default().after(time), Pose2::new(speed * time, 0.0, 0.0), false)
            });
            let longest = stood.fold(0.0, f64::max);
            assert!(longest <= PROGRESS_DISTANCE_M / speed + 0.2, "{speed} m/s: {longest} s");
        }
    }
}
