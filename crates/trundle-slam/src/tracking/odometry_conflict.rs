//! Successive tracked poses that contradict the wheels.

use trundle_core::Stamp;

/// Number of agreeing points that outweigh the wheels at once: 100. Fewer points must persist for [`MIN_CONFLICT_S`]. Source: ours.
const MIN_CONVINCING_POINTS: usize = 100;
/// Time for which fewer points must contradict the wheels before they outweigh them: 0.3 s. Source: ours.
const MIN_CONFLICT_S: f64 = 0.3;

/// Start of the contradiction between tracked poses and wheels.
///
/// A few points in one corner of a bare wall can agree by chance, but only for a short time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct OdometryConflict {
    since: Option<Stamp>,
}

impl OdometryConflict {
    /// Whether to accept the tracked pose of a frame at `now`; `points_against_odometry` is the number of points that contradict the wheels,
    /// `None` if they agree.
    pub fn accepts(&mut self, now: Stamp, points_against_odometry: Option<usize>) -> bool {
        let Some(points) = points_against_odometry else {
            self.since = None;
            return true;
        };
        self.since.get_or_insert(now);
        points >= MIN_CONVINCING_POINTS || self.persists(now)
    }

    /// Whether tracked poses have contradicted the wheels for so long that the wheels are wrong.
    pub fn persists(&self, now: Stamp) -> bool {
        self.since.is_some_and(|since| now - since >= MIN_CONFLICT_S)
    }

    /// Whether the newest tracked pose contradicts the wheels.
    pub fn is_active(&self) -> bool {
        self.since.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_are_believed_against_the_wheels_when_they_persist() {
        let at = |seconds: f64| Stamp::default().after(seconds);
        let mut conflict = OdometryConflict::default();
        assert!(conflict.accepts(at(0.0), None) && !conflict.is_active());
        assert!(!conflict.accepts(at(1.0), Some(99)) && conflict.is_active());
        assert!(conflict.accepts(at(1.1), Some(100)), "many are accepted at once");
        assert!(!conflict.persists(at(1.2)) && conflict.persists(at(1.3)));
        assert!(!conflict.accepts(at(1.2), Some(30)));
        assert!(conflict.accepts(at(1.3), Some(30)), "after 0.3 s");
        assert!(conflict.accepts(at(1.4), None), "points and wheels agree again");
        assert!(!conflict.accepts(at(9.0), Some(30)), "a new conflict");
        assert!(conflict.accepts(at(9.1), None) && !conflict.persists(at(9.9)));
    }
}
