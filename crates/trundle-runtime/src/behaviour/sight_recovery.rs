//! Recovery of lost sight by a turn on the spot.

use crate::behaviour::spin::{SPIN_TURNS, Spin};
use trundle_core::{Pose2, Twist2, Vector2};

/// Turns on the spot of a robot without a usable scan, and whether they restore the view.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SightRecovery {
    spin: Spin,
    /// The wanted turn rate at the loss of sight, rad/s.
    wanted: f64,
    /// Place at which a turn last restored sight, map frame, and the number of times at this place.
    found: Option<(Vector2, u32)>,
}

/// Minimum fraction of a turn after which a restored view counts as an effect of the turn. Source: ours.
const MIN_RECOVERY_TURN: f64 = 0.02;
/// Number of times that a turn may restore sight at one place. Beyond it the path is considered unobservable, and the goal is abandoned.
/// Source: ours.
const MAX_RECOVERIES_AT_ONE_PLACE: u32 = 2;
/// Distance within which two recoveries count as one place \[m\]. Source: ours.
const ONE_PLACE_M: f64 = 0.5;

impl SightRecovery {
    /// Records the twist that the robot would make, before the view may be lost.
    pub(crate) fn held(&mut self, wanted: Twist2) {
        self.wanted = wanted.omega;
    }

    /// The command after a pause without a usable scan: one turn in the direction of the last wanted turn, then rest.
    pub(crate) fn turn(&mut self, pose: Pose2) -> Twist2 {
        if self.spin.has_turned(SPIN_TURNS) {
            Twist2::ZERO
        } else {
            self.spin.twist_towards(self.wanted, pose)
        }
    }

    /// Records a usable scan at a place (map frame, m). Returns whether a turn restored the view there for the second time. After a full
    /// turn without result the camera was broken, and the turn did not restore the view.
    pub(crate) fn sees(&mut self, at: Vector2) -> bool {
        let spin = std::mem::take(&mut self.spin);
        if !spin.has_turned(MIN_RECOVERY_TURN) || spin.has_turned(SPIN_TURNS) {
            return false;
        }
        let before = self.found.filter(|(place, _)| (at - place).norm() <= ONE_PLACE_M);
        let (place, times) = before.map_or((at, 1), |(place, times)| (place, times + 1));
        self.found = Some((place, times));
        times >= MAX_RECOVERIES_AT_ONE_PLACE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.02;

    /// Turns without a usable scan for `seconds`, then gets one; the result of the check, and the turned angle.
    fn blind_for(watch: &mut SightRecovery, seconds: f64, at: Vector2) -> (bool, f64) {
        let mut pose = Pose2::new(at.x, at.y, 0.0);
        let mut turned = 0.0;
        for _ in 0..(seconds / STEP) as usize {
            let twist = watch.turn(pose);
            pose = pose.advance(twist, STEP);
            turned += twist.omega * STEP;
        }
        (watch.sees(at), turned)
    }

    #[test]
    fn sight_that_a_turn_brings_back_twice_at_one_place_does_not_stay() {
        let (mut watch, here) = (SightRecovery::default(), Vector2::new(1.0, 2.0));
        assert!(!blind_for(&mut watch, 2.0, here).0);
        assert!(!watch.sees(here), "it was the same turn");
        assert!(blind_for(&mut watch, 2.0, here + Vector2::new(0.2, 0.0)).0);
        let elsewhere = here + Vector2::new(1.5, 0.0);
        assert!(!blind_for(&mut watch, 2.0, elsewhere).0, "a wall there has nothing to do with one here");
    }

    #[test]
    fn sight_that_comes_back_by_itself_was_not_brought_back() {
        let (mut watch, here) = (SightRecovery::default(), Vector2::new(1.0, 2.0));
        for _ in 0..3 {
            assert!(!blind_for(&mut watch, 0.1, here).0, "it had hardly begun to turn");
            let (stays, turned) = blind_for(&mut watch, 30.0, here);
            assert!(!stays && (6.4..6.5).contains(&turned), "once around in vain, and no more: {turned}");
        }
    }

    #[test]
    fn it_turns_on_to_where_it_wanted() {
        for (wanted, sign) in [(-0.4, -1.0), (0.3, 1.0), (0.0, 1.0)] {
            let mut watch = SightRecovery::default();
            watch.held(Twist2::new(0.1, wanted));
            let (_, turned) = blind_for(&mut watch, 2.0, Vector2::zeros());
            assert!((sign * turned - 1.2).abs() < 0.02, "{wanted}: {turned}");
        }
    }
}
