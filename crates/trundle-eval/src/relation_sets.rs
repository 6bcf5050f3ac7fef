//! Selection of the pose relations of a reference trajectory that an estimate is compared with.

use crate::Relation;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Stamp, require_in};

/// Selection of the pairs of reference poses that become relations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RelationSetsConfig {
    /// Distance travelled between the poses of a near relation, m, 0.01 to 1000. Default 1.
    pub near: f64,
    /// Distance travelled between the poses of a far relation, m, 0.01 to 10000. Default 10.
    pub far: f64,
    /// Path length between two visits of one place, m, 0.1 to 100000. Default 40.
    pub loop_way: f64,
    /// Distance between the poses of two visits of one place, m, 0.01 to 100. Default 2.
    pub loop_distance: f64,
}

impl Default for RelationSetsConfig {
    fn default() -> Self {
        Self { near: 1.0, far: 10.0, loop_way: 40.0, loop_distance: 2.0 }
    }
}

impl RelationSetsConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range of its field.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("near", self.near, "m", 0.01, 1000.0)?;
        require_in("far", self.far, "m", 0.01, 10_000.0)?;
        require_in("loop_way", self.loop_way, "m", 0.1, 100_000.0)?;
        require_in("loop_distance", self.loop_distance, "m", 0.01, 100.0)?;
        Ok(self)
    }
}

/// Relations by their purpose.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RelationSets {
    /// Local accuracy of the trajectory: poses one metre apart.
    pub near: Vec<Relation>,
    /// Ten metres apart: the straightness of corridors.
    pub far: Vec<Relation>,
    /// Whether loops are closed: one place at different times.
    pub loops: Vec<Relation>,
}

impl RelationSets {
    /// The relations of a reference trajectory (`world_from_body`). From each pose they lead to the first pose after the distance `near`,
    /// the first after `far`, and the nearest pose of each later visit. Cost: poses squared.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn of(reference: &[(Stamp, Pose3)], config: &RelationSetsConfig) -> Result<Self, Invalid> {
        let config = config.clone().validated()?;
        let lengths = lengths(reference);
        let mut sets = Self::default();
        let relation = |i: usize, j: usize| {
            let ((from, a), (to, b)) = (reference[i], reference[j]);
            Relation { from, to, relative: a.inverse() * b }
        };
        for i in 0..reference.len() {
            let after = |length: f64| {
                Some(lengths.partition_point(|w| *w < lengths[i] + length)).filter(|j| *j < lengths.len())
            };
            sets.near.extend(after(config.near).map(|j| relation(i, j)));
            sets.far.extend(after(config.far).map(|j| relation(i, j)));
            let from = after(config.loop_way).unwrap_or(lengths.len());
            sets.loops.extend(visits(reference, i, from, config.loop_distance).map(|j| relation(i, j)));
        }
        Ok(sets)
    }

    /// All relations.
    pub fn all(&self) -> Vec<Relation> {
        [&self.near, &self.far, &self.loops].into_iter().flatten().copied().collect()
    }
}

/// Distance travelled at each pose, m.
fn lengths(reference: &[(Stamp, Pose3)]) -> Vec<f64> {
    let steps = reference.windows(2).map(|pair| (pair[1].1.translation - pair[0].1.translation).norm());
    let mut length = 0.0;
    let rest = steps.map(|step| {
        length += step;
        length
    });
    std::iter::once(0.0).take(reference.len()).chain(rest).collect()
}

/// For each visit to the place of pose `i`, from pose `from` on, the nearest pose.
fn visits(
    reference: &[(Stamp, Pose3)],
    i: usize,
    from: usize,
    reach: f64,
) -> impl Iterator<Item = usize> + '_ {
    let distance = move |j: usize| (reference[j].1.translation - reference[i].1.translation).norm();
    let mut j = from;
    std::iter::from_fn(move || {
        while j < reference.len() && distance(j) >= reach {
            j += 1;
        }
        let mut nearest = None;
        while j < reference.len() && distance(j) < reach {
            if nearest.is_none_or(|k| distance(j) < distance(k)) {
                nearest = Some(j);
            }
            j += 1;
        }
        nearest
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Pose2;

    /// Twice along the sides of a square of 20 m, half a metre a pose: back at the start after 80 m.
    fn square() -> Vec<(Stamp, Pose3)> {
        let pose = |k: usize| {
            let (side, along) = (k / 40 % 4, (k % 40) as f64 * 0.5);
            let theta = side as f64 * std::f64::consts::FRAC_PI_2;
            let corner = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)][side];
            Pose2::new(corner.0 + along * theta.cos(), corner.1 + along * theta.sin(), theta)
        };
        let at = |k: usize| (Stamp::from_nanos(k as i64 * 1_000_000_000), Pose3::from_pose2(pose(k)));
        (0..321).map(at).collect()
    }

    #[test]
    fn the_relations_of_two_laps_of_a_square() {
        let sets = RelationSets::of(&square(), &RelationSetsConfig::default()).unwrap();
        assert_eq!((sets.near.len(), sets.far.len()), (321 - 2, 321 - 20));
        assert!((sets.near[0].relative.translation.x - 1.0).abs() < 1e-9);
        assert!((sets.far[0].relative.translation.x - 10.0).abs() < 1e-9);
        // The poses of the first lap return once, the start twice: after one lap and after two.
        let from_start: Vec<_> = sets.loops.iter().filter(|r| r.from.nanos == 0).collect();
        assert_eq!(from_start.iter().map(|r| r.to.nanos / 1_000_000_000).collect::<Vec<_>>(), [160, 320]);
        assert!(from_start.iter().all(|r| r.relative.translation.norm() < 1e-9));
        assert_eq!(sets.loops.iter().filter(|r| r.from.nanos / 1_000_000_000 == 20).count(), 1);
        assert_eq!(sets.all().len(), sets.near.len() + sets.far.len() + sets.loops.len());
    }

    #[test]
    fn short_and_empty_references_have_none() {
        assert_eq!(RelationSets::of(&[], &RelationSetsConfig::default()).unwrap(), RelationSets::default());
        assert!(RelationSets::of(&square()[..1], &RelationSetsConfig::default()).unwrap().all().is_empty());
        let config = RelationSetsConfig { near: f64::NAN, ..Default::default() };
        assert_eq!(RelationSets::of(&[], &config).unwrap_err().field, "near");
    }
}
