//! Errors of an estimate's relative poses against given relations.

use crate::{ErrorStatistics, EvalError, Side, absolute::of_finite, absolute::require_max_difference};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Stamp};

/// The robot's pose at one time relative to its pose at another, measured by a person or given by a reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relation {
    /// The one time.
    pub from: Stamp,
    /// The other.
    pub to: Stamp,
    /// `body_at_from_from_body_at_to`, m and rad.
    pub relative: Pose3,
}

/// Settings of the comparison of relations with an estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RelationConfig {
    /// Largest difference of stamps between a pose of the estimate and a time, s; 0 or more; 0.01 as for [`crate::AbsoluteConfig`].
    pub max_difference: f64,
}

impl Default for RelationConfig {
    fn default() -> Self {
        Self { max_difference: 0.01 }
    }
}

impl RelationConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When `max_difference` is not finite or below 0.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_max_difference(self.max_difference)?;
        Ok(self)
    }
}

/// Errors of an estimate's relations.
#[derive(Debug, Clone, PartialEq)]
pub struct RelationError {
    /// Lengths of the translations between true and estimated relation, m.
    pub translation: ErrorStatistics,
    /// Angles between true and estimated relation, rad.
    pub rotation: ErrorStatistics,
    /// Relations one of whose times the estimate has no pose for; they are in no number.
    pub missed: usize,
}

/// The relations metric: for each true relation d* and its estimate d the error is d*^-1 d, with translation and rotation evaluated
/// separately. Source: \[Kuemmerle09\], eq. 2 (its mean of squares is the square of `rmse` here). One wrong turn is one error, while in
/// aligned trajectories it affects all later poses.
///
/// # Errors
/// When no relation is given, the estimate is empty or its stamps decrease, a number is not finite, or every relation is missed.
pub fn relation_error(
    relations: &[Relation],
    estimate: &[(Stamp, Pose3)],
    config: &RelationConfig,
) -> Result<RelationError, EvalError> {
    require_max_difference(config.max_difference)?;
    check(relations, estimate)?;
    let at = |stamp| nearest(estimate, stamp, config.max_difference);
    let gaps: Vec<Pose3> = relations
        .iter()
        .filter_map(|r| Some(r.relative.inverse() * (at(r.from)?.inverse() * at(r.to)?)))
        .collect();
    if gaps.is_empty() {
        return Err(EvalError::NoRelation { relations: relations.len() });
    }
    let lengths: Vec<f64> = gaps.iter().map(|gap| gap.translation.norm()).collect();
    let angles: Vec<f64> = gaps.iter().map(Pose3::angle).collect();
    Ok(RelationError {
        translation: of_finite(&lengths),
        rotation: of_finite(&angles),
        missed: relations.len() - gaps.len(),
    })
}

fn check(relations: &[Relation], estimate: &[(Stamp, Pose3)]) -> Result<(), EvalError> {
    if relations.is_empty() {
        return Err(EvalError::NoRelation { relations: 0 });
    }
    if estimate.is_empty() {
        return Err(EvalError::Empty(Side::Estimate));
    }
    let usable = |pose: &Pose3| pose.is_finite() && pose.translation.amax() < 1e100;
    if let Some(index) = relations.iter().position(|r| !usable(&r.relative)) {
        return Err(EvalError::NotFinite { side: Side::Reference, index });
    }
    if let Some(index) = estimate.iter().position(|(_, pose)| !usable(pose)) {
        return Err(EvalError::NotFinite { side: Side::Estimate, index });
    }
    match estimate.windows(2).position(|pair| pair[1].0 < pair[0].0) {
        None => Ok(()),
        Some(i) => Err(EvalError::StampsGoBack {
            side: Side::Estimate,
            index: i + 1,
            stamp: estimate[i + 1].0,
            before: estimate[i].0,
        }),
    }
}

/// The pose nearest in time, the earlier of two equally near, at most `limit` s away.
fn nearest(estimate: &[(Stamp, Pose3)], stamp: Stamp, limit: f64) -> Option<Pose3> {
    let after = estimate.partition_point(|(at, _)| *at < stamp);
    let candidates = &estimate[after.saturating_sub(1)..(after + 1).min(estimate.len())];
    let (at, pose) = candidates.iter().min_by_key(|(at, _)| at.nanos.abs_diff(stamp.nanos))?;
    (at.nanos.abs_diff(stamp.nanos) as f64 <= limit * 1e9).then_some(*pose)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Pose2, Vector3};

    fn stamp(seconds: i64) -> Stamp {
        Stamp::from_nanos(seconds * 1_000_000_000)
    }

    fn planar(seconds: i64, x: f64, y: f64, theta: f64) -> (Stamp, Pose3) {
        (stamp(seconds), Pose3::from_pose2(Pose2::new(x, y, theta)))
    }

    fn relation(from: i64, to: i64, x: f64, y: f64, theta: f64) -> Relation {
        Relation { from: stamp(from), to: stamp(to), relative: planar(0, x, y, theta).1 }
    }

    #[test]
    fn two_relations_by_hand() {
        // The relation is 1 m ahead, the estimate 1.3 m ahead and 0.4 m to the left: 0.5 m. Turned by 0.1: no shift, 0.1 rad.
        let estimate = [planar(0, 2.0, 1.0, 0.0), planar(1, 3.3, 1.4, 0.0), planar(2, 3.3, 1.4, 0.4)];
        let relations = [relation(0, 1, 1.0, 0.0, 0.0), relation(1, 2, 0.0, 0.0, 0.3)];
        let error = relation_error(&relations, &estimate, &RelationConfig::default()).unwrap();
        assert!(
            (error.translation.mean - 0.25).abs() < 1e-12 && (error.translation.std - 0.25).abs() < 1e-12
        );
        assert!((error.rotation.mean - 0.05).abs() < 1e-9 && (error.rotation.max - 0.1).abs() < 1e-9);
        assert_eq!((error.translation.count, error.missed), (2, 0));
    }

    #[test]
    fn an_error_counts_once_wherever_it_happened() {
        // A straight line of ten metres with one wrong turn of 90 degrees in the middle.
        let truth: Vec<_> = (0..11).map(|i| planar(i, i as f64, 0.0, 0.0)).collect();
        let bent: Vec<_> = (0..11)
            .map(|i| {
                if i <= 5 {
                    planar(i, i as f64, 0.0, 0.0)
                } else {
                    planar(i, 5.0, i as f64 - 5.0, std::f64::consts::FRAC_PI_2)
                }
            })
            .collect();
        let steps: Vec<_> = (0..10).map(|i| relation(i, i + 1, 1.0, 0.0, 0.0)).collect();
        let error = relation_error(&steps, &bent, &RelationConfig::default()).unwrap();
        assert!((error.rotation.mean - std::f64::consts::FRAC_PI_2 / 10.0).abs() < 1e-9);
        assert!((error.translation.mean - 2_f64.sqrt() / 10.0).abs() < 1e-9, "1 m ahead is 1 m to the left");
        let none = relation_error(&steps, &truth, &RelationConfig::default()).unwrap();
        assert!(none.translation.max < 1e-12 && none.rotation.max < 1e-7);
    }

    #[test]
    fn relations_outside_the_estimate_are_missed_and_reported() {
        let estimate = [planar(0, 0.0, 0.0, 0.0), planar(1, 1.0, 0.0, 0.0)];
        let relations = [relation(0, 1, 1.0, 0.0, 0.0), relation(0, 7, 1.0, 0.0, 0.0)];
        let error = relation_error(&relations, &estimate, &RelationConfig::default()).unwrap();
        assert_eq!((error.translation.count, error.missed), (1, 1));
        let refuse = |relations: &[Relation], estimate: &[(Stamp, Pose3)]| {
            relation_error(relations, estimate, &RelationConfig::default()).unwrap_err().to_string()
        };
        assert_eq!(refuse(&relations[1..], &estimate), "the estimate has poses for none of the 1 relations");
        assert_eq!(refuse(&[], &estimate), "the estimate has poses for none of the 0 relations");
        assert_eq!(refuse(&relations, &[]), "the estimate trajectory has no pose");
        let back = [estimate[1], estimate[0]];
        assert!(refuse(&relations, &back).starts_with("stamp of estimate pose 1 is 0.000000000 s"));
        let nan = [(stamp(0), Pose3::new(Default::default(), Vector3::repeat(f64::NAN)))];
        assert_eq!(refuse(&relations, &nan), "estimate pose 0 is not finite");
    }

    proptest! {
        #[test]
        fn where_the_map_begins_does_not_matter(x in -9.0..9.0, y in -9.0..9.0, theta in -3.0..3.0) {
            let estimate = [planar(0, 2.0, 1.0, 0.1), planar(1, 3.3, 1.4, 0.7)];
            let moved = estimate.map(|(s, p)| (s, planar(0, x, y, theta).1 * p));
            let relations = [relation(0, 1, 1.0, 0.0, 0.5)];
            let of = |e: &[(Stamp, Pose3)]| relation_error(&relations, e, &RelationConfig::default()).unwrap();
            prop_assert!((of(&estimate).translation.mean - of(&moved).translation.mean).abs() < 1e-9);
            prop_assert!((of(&estimate).rotation.mean - of(&moved).rotation.mean).abs() < 1e-7);
        }
    }
}
