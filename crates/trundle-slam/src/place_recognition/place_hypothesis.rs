//! Hypotheses of the camera's pose, and the selection among them.

use trundle_core::Pose3;

/// Largest distance between two poses of the same place: 0.3 m. Poses farther apart are competitors. Source: ours.
const SAME_PLACE_M: f64 = 0.3;
/// Largest rotation between two poses of the same place: 0.3 rad. Source: as [`SAME_PLACE_M`].
const SAME_PLACE_RAD: f64 = 0.3;
/// Fraction of the best hypothesis' points above which a second hypothesis elsewhere makes both ambiguous: 0.7. Source: \[Lowe04\], the
/// ratio test of the second-nearest match.
const RIVAL_POINTS_RATIO: f64 = 0.7;

/// A possible pose of the camera, and the number of points that support it.
pub(crate) trait PlaceHypothesis {
    fn pose(&self) -> Pose3;
    fn points(&self) -> usize;
    /// Whether enough of the expected landmarks are found.
    fn is_plausible(&self) -> bool;
    /// Whether the hypothesis is accepted without a competitor.
    fn is_certain(&self) -> bool;
}

/// Index of the certain hypothesis with the largest number of points; the first of equal ones.
pub(crate) fn best_hypothesis<T: PlaceHypothesis>(found: &[T]) -> Option<usize> {
    (0..found.len()).rev().filter(|i| found[*i].is_certain()).max_by_key(|i| found[*i].points())
}

/// The certain hypothesis with the largest number of points. `None` if a plausible one elsewhere has nearly as many, as in look-alike
/// rooms, or an implausible one elsewhere has more.
pub(crate) fn without_rival<T: PlaceHypothesis>(mut found: Vec<T>) -> Option<T> {
    let i = best_hypothesis(&found)?;
    let best = &found[i];
    let share = |other: &T| if other.is_plausible() { RIVAL_POINTS_RATIO } else { 1.0 };
    let has_as_many = |other: &T| other.points() as f64 > share(other) * best.points() as f64;
    let is_rival = |other: &T| has_as_many(other) && !is_same_place(best.pose(), other.pose());
    (!found.iter().any(is_rival)).then(|| found.swap_remove(i))
}

/// Whether two poses are of the same place.
pub(crate) fn is_same_place(a: Pose3, b: Pose3) -> bool {
    let offset = a.inverse() * b;
    offset.translation.norm() < SAME_PLACE_M && offset.angle() < SAME_PLACE_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Certainty::{self, Certain, Implausible, Plausible};

    #[test]
    fn the_hypothesis_with_most_points_wins_unless_a_rival_elsewhere_has_nearly_as_many() {
        assert_eq!(without_rival::<(f64, usize, Certainty)>(vec![]), None);
        let best = |found: &[(f64, usize)]| {
            without_rival(found.iter().map(|(x, points)| (*x, *points, Certain)).collect())
                .map(|(x, n, _)| (x, n))
        };
        assert_eq!(best(&[(0.0, 50), (0.1, 60), (4.0, 40)]), Some((0.1, 60)));
        assert_eq!(best(&[(0.0, 50), (4.0, 60)]), None);
        assert_eq!(best(&[(0.0, 60), (0.2, 59)]), Some((0.0, 60)));
    }

    #[test]
    fn an_uncertain_hypothesis_is_a_rival_and_cannot_win() {
        let certain = (0.0, 50, Certain);
        assert_eq!(without_rival(vec![(4.0, 51, Implausible), certain]), None);
        assert_eq!(without_rival(vec![(4.0, 40, Plausible), certain]), None);
        assert_eq!(
            without_rival(vec![(0.1, 90, Implausible), certain, (4.0, 49, Implausible)]),
            Some(certain)
        );
        assert_eq!(without_rival(vec![(0.0, 90, Plausible)]), None);
    }
}
