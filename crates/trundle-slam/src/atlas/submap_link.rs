//! Pose of a map in the map before it, by wheels and gyro.

use crate::ids::MapId;
use crate::loop_closing::config::LoopConfig;
use crate::motion::uncertain_pose::UncertainPose;
use nalgebra::Matrix6;
use trundle_core::Pose3;

/// The odometry between two maps: from the last pose in one map to the start of the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SubmapLink {
    pub map: MapId,
    pub before: MapId,
    pub before_from_map: UncertainPose,
}

impl SubmapLink {
    /// This link followed by `next`; `None` if `next` does not begin in the map where this link ends.
    pub fn then(self, next: Self) -> Option<Self> {
        let before_from_map = self.before_from_map.then(&next.before_from_map);
        (self.map == next.before).then_some(Self { before: self.before, before_from_map, ..next })
    }

    /// Whether a merge may put `other` at this pose in `active`: within the uncertainty of the link, or within the largest correction of an
    /// unexpected loop. A pair of maps without a link may always merge.
    pub fn allows(
        &self,
        (other, active): (MapId, MapId),
        other_from_active: Pose3,
        config: &LoopConfig,
    ) -> bool {
        let measured =
            match (other == self.before, active == self.map, other == self.map, active == self.before) {
                (true, true, ..) => other_from_active,
                (.., true, true) => other_from_active.inverse(),
                _ => return true,
            };
        let error = self.before_from_map.pose.inverse() * measured;
        let is_small =
            error.translation.norm() <= config.max_correction && error.angle() <= config.max_correction_turn;
        let (tangent, information) = (error.log(), self.before_from_map.covariance.try_inverse());
        let is_likely = |information: Matrix6<f64>| {
            tangent.dot(&(information * tangent)) <= config.max_sigmas * config.max_sigmas
        };
        is_small || information.is_some_and(is_likely)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::uncertain_pose::of_sigmas;

    #[test]
    fn a_merge_must_agree_with_the_odometry_between_the_maps() {
        let along = |x: f64| Pose3::exp(nalgebra::Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0));
        let (before, map) = (MapId(0), MapId(2));
        let uncertain = |pose| UncertainPose { pose, covariance: of_sigmas(0.4, 0.1) };
        let link = SubmapLink { map, before, before_from_map: uncertain(along(5.0)) };
        let config = LoopConfig::default();
        let allows = |pair, pose| link.allows(pair, pose, &config);
        assert!(allows((before, map), along(6.5)) && allows((map, before), along(-6.5)));
        assert!(!allows((before, map), along(0.5)) && !allows((map, before), along(-0.5)));
        assert!(allows((MapId(1), map), along(0.5)), "no link");
        let on = SubmapLink { map: MapId(3), before: map, before_from_map: uncertain(along(2.0)) };
        let both = link.then(on).expect("one leads on from the other");
        assert!(both.allows((before, MapId(3)), along(9.0), &config) && on.then(link).is_none());
        let exact = SubmapLink {
            before_from_map: UncertainPose { covariance: Matrix6::zeros(), ..link.before_from_map },
            ..link
        };
        assert!(
            exact.allows((before, map), along(5.9), &config)
                && !exact.allows((before, map), along(6.1), &config)
        );
    }
}
