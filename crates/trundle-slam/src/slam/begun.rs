use crate::closing::LoopConfig;
use crate::motion::carried;
use crate::report::MapId;
use nalgebra::Matrix6;
use trundle_core::Pose3;

/// A map that began behind a way in the dark: where it lies in the one before, as wheels and gyro know it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Begun {
    pub map: MapId,
    pub before: MapId,
    pub before_from_map: Pose3,
    /// Of that as a right perturbation.
    pub covariance: Matrix6<f64>,
}

impl Begun {
    /// The same of the map that began behind the next way; `None` where that led from another map.
    pub fn then(self, next: Self) -> Option<Self> {
        let covariance = carried(&self.covariance, next.before_from_map) + next.covariance;
        let before_from_map = self.before_from_map * next.before_from_map;
        (self.map == next.before).then_some(Self { before: self.before, before_from_map, covariance, ..next })
    }

    /// Whether `other` may lie so in `active`: no farther off the way than its uncertainty, or a loop that surprises, goes. Of maps
    /// that no way leads between it knows nothing.
    pub fn allows(
        &self,
        (other, active): (MapId, MapId),
        other_from_active: Pose3,
        config: &LoopConfig,
    ) -> bool {
        let told = match (other == self.before, active == self.map, other == self.map, active == self.before)
        {
            (true, true, ..) => other_from_active,
            (.., true, true) => other_from_active.inverse(),
            _ => return true,
        };
        let off = self.before_from_map.inverse() * told;
        let is_small = off.translation.norm() <= config.surprise && off.angle() <= config.surprise_turn;
        let (tangent, information) = (off.log(), self.covariance.try_inverse());
        let is_on_the_way = |information: Matrix6<f64>| {
            tangent.dot(&(information * tangent)) <= config.most_sigmas * config.most_sigmas
        };
        is_small || information.is_some_and(is_on_the_way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::of_sigmas;

    #[test]
    fn a_map_lies_where_the_way_led_or_near_it() {
        let along = |x: f64| Pose3::exp(nalgebra::Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0));
        let (before, map) = (MapId(0), MapId(2));
        let covariance = of_sigmas(0.4, 0.1);
        let begun = Begun { map, before, before_from_map: along(5.0), covariance };
        let config = LoopConfig::default();
        let allows = |pair, pose| begun.allows(pair, pose, &config);
        assert!(allows((before, map), along(6.5)) && allows((map, before), along(-6.5)));
        assert!(!allows((before, map), along(0.5)) && !allows((map, before), along(-0.5)));
        assert!(allows((MapId(1), map), along(0.5)), "nobody knows of it");
        let on = Begun { map: MapId(3), before: map, before_from_map: along(2.0), covariance };
        let both = begun.then(on).expect("one leads on from the other");
        assert!(both.allows((before, MapId(3)), along(9.0), &config) && on.then(begun).is_none());
        let exact = Begun { covariance: Matrix6::zeros(), ..begun };
        assert!(
            exact.allows((before, map), along(5.9), &config)
                && !exact.allows((before, map), along(6.1), &config)
        );
    }
}
