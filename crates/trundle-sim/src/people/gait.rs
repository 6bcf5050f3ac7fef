//! The gait of a walking person: positions of both feet.

use trundle_core::Pose2;

/// Step length over cadence, m s: the walk ratio, 0.0064 m/(step/min), is constant for all speeds. Source: \[Sekiya98\].
const WALK_RATIO: f64 = 0.384;

/// Half the distance between the feet, m. Source: ours.
const HALF_TRACK: f64 = 0.1;

/// Fraction of the shin's motion followed by knee and thigh. Source: ours.
pub(super) const KNEE_SHARE: f64 = 0.65;
pub(super) const THIGH_SHARE: f64 = 0.3;

/// Seconds in which a walk begins and ends. Source: ours.
const EASE_DURATION_S: f64 = 0.35;

/// Motion of the legs: the foot on the floor is fixed, the other one overtakes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gait {
    /// Length of a step, m.
    step: f64,
    /// Place in the cycle of two steps, 0 to 1.
    phase: f64,
    /// 0 standing, 1 walking.
    swing: f64,
}

impl Gait {
    /// Gait of a person who walks at `speed` m/s.
    pub(super) fn new(speed: f64) -> Self {
        Self { step: (WALK_RATIO * speed).sqrt(), phase: 0.0, swing: 0.0 }
    }

    /// Fraction of the full speed, 0 to 1.
    pub(super) fn swing(&self) -> f64 {
        self.swing
    }

    /// The gait after `elapsed` s and a walked distance of `distance` m; `is_walking`: whether the person continues.
    pub(super) fn after(self, elapsed: f64, distance: f64, is_walking: bool) -> Self {
        let change = if is_walking { elapsed / EASE_DURATION_S } else { -elapsed / EASE_DURATION_S };
        Self {
            phase: (self.phase + distance / (2.0 * self.step)).fract(),
            swing: (self.swing + change).clamp(0.0, 1.0),
            ..self
        }
    }

    /// Poses of the leg pieces that follow their shin by `share`, 1 for the shins: `body_from_piece`, left and right.
    pub(super) fn legs(&self, share: f64) -> [Pose2; 2] {
        [(HALF_TRACK, 0.0), (-HALF_TRACK, 0.5)]
            .map(|(side, shift)| Pose2::new(share * self.swing * self.reach(shift), side, 0.0))
    }

    /// Distance of a foot ahead of the body, m. During stance it moves backward at the body's speed; during swing it moves forward along a
    /// cubic with a smooth start and end.
    fn reach(&self, shift: f64) -> f64 {
        let phase = 2.0 * (self.phase + shift).fract();
        let u = phase.fract();
        let part = if phase < 1.0 { 0.5 - u } else { -0.5 - u + u * u * (6.0 - 4.0 * u) };
        part * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standing_foot_stays_and_the_other_overtakes_it() {
        let mut gait = Gait { swing: 1.0, ..Gait::new(1.2) };
        assert!((gait.step - 0.679).abs() < 1e-3);
        let (mut distance, mut longest) = (0.0, 0.0_f64);
        for _ in 0..4000 {
            let before = gait.legs(1.0).map(|shin| distance + shin.x);
            gait = gait.after(1e-3, 1.2e-3, true);
            distance += 1.2e-3;
            let after = gait.legs(1.0).map(|shin| distance + shin.x);
            let moved = [0, 1].map(|k| after[k] - before[k]);
            assert!(moved[0].abs().min(moved[1].abs()) < 3e-5, "{moved:?} at {}", gait.phase);
            assert!(moved.iter().all(|m| *m > -1e-9 && *m < 3.7e-3), "{moved:?}");
            longest = longest.max((after[0] - after[1]).abs());
        }
        assert!((longest - gait.step).abs() < 5e-3, "{longest}");
    }

    #[test]
    fn a_standing_person_has_feet_side_by_side() {
        let [left, right] = Gait::new(1.0).legs(1.0);
        assert_eq!((left.x, right.x, left.y, right.y), (0.0, 0.0, 0.1, -0.1));
    }
}
