//! Unseen floor, and its observations on the path to one goal.

use trundle_core::{Cell, OccupancyGrid, Stamp, Vector2};

/// Unseen floor on the path to the present goal, and its observations.
#[derive(Debug, Clone, Default)]
pub(crate) struct VisibilityConstraint {
    /// Position at which the robot started, map frame.
    pub(crate) home: Option<Vector2>,
    /// Places at which the candidate paths entered unseen floor.
    pub(crate) virtual_obstacles: Vec<Vector2>,
    /// Observations of the last 20 s.
    observations: Vec<FloorObservation>,
    /// Number of observations with a result since the goal was given.
    results: usize,
    /// Keep-out zones: floor that observations did not show, and when each zone began.
    keep_out: Vec<(Vector2, Stamp)>,
}

/// An observation: the floor, the viewpoint, and the time of its start or, after the arrival, of the arrival.
#[derive(Debug, Clone, Copy)]
struct FloorObservation {
    at: Vector2,
    from: Vector2,
    since: Stamp,
    is_in_vain: bool,
}

/// Radius of a virtual obstacle around a point that the path must not reach before it is observed \[m\]. Source: ours.
pub(crate) const VIRTUAL_OBSTACLE_RADIUS_M: f64 = 0.3;
/// Number of virtual obstacles of one search. Source: ours.
pub(crate) const MAX_VIRTUAL_OBSTACLES: usize = 3;
/// Number of views of one place. Source: ours.
const MAX_VIEWS_PER_PLACE: usize = 2;
/// Smallest distance between two viewpoints of one place \[m\]. Source: ours.
const MIN_VIEWPOINT_SPACING_M: f64 = 0.4;
/// Time after which an observation without result may be repeated \[s\]: a person in front of the place may have left. Source: ours.
const VAIN_VIEW_RETRY_S: f64 = 20.0;

impl VisibilityConstraint {
    /// For the next goal.
    pub(crate) fn restart(&mut self) {
        *self = Self { home: self.home, ..Self::default() };
    }

    /// Records an observation of `at` from `from`.
    pub(crate) fn record_observation(&mut self, at: Vector2, from: Vector2, now: Stamp) {
        self.observations.push(FloorObservation { at, from, since: now, is_in_vain: true });
    }

    /// Records the arrival at the last viewpoint.
    pub(crate) fn note_arrival(&mut self, now: Stamp) {
        self.observations.last_mut().into_iter().for_each(|observation| observation.since = now);
    }

    /// Marks the observations whose floor the newest map shows: they had a result.
    pub(crate) fn note_seen(&mut self, floor: &OccupancyGrid) {
        for observation in &mut self.observations {
            let is_seen = observation.is_in_vain && floor.at(observation.at) != Cell::Unknown;
            observation.is_in_vain &= !is_seen;
            self.results += usize::from(is_seen);
        }
    }

    /// Drops old observations: floor that was hidden then may be in view.
    pub(crate) fn forget(&mut self, now: Stamp) {
        self.observations.retain(|observation| now - observation.since < VAIN_VIEW_RETRY_S);
        self.keep_out.retain(|(_, since)| now - *since < VAIN_VIEW_RETRY_S);
    }

    /// Positions of the observations of this floor.
    fn observations_of(&self, at: Vector2) -> impl Iterator<Item = Vector2> + '_ {
        self.observations
            .iter()
            .filter(move |observation| (observation.at - at).norm() < VIRTUAL_OBSTACLE_RADIUS_M)
            .map(|observation| observation.from)
    }

    /// Whether this floor was observed. Floor that is unknown after an observation remains unknown during the drive.
    pub(crate) fn was_observed(&self, at: Vector2) -> bool {
        self.observations_of(at).next().is_some()
    }

    /// Whether another observation of `at` may have a result.
    pub(crate) fn is_worth_observing(&self, at: Vector2) -> bool {
        self.observations_of(at).count() < MAX_VIEWS_PER_PLACE
    }

    /// Number of observations with a result since the goal was given.
    pub(crate) fn results(&self) -> usize {
        self.results
    }

    /// Whether `from` is far enough from the earlier observations of `at`.
    pub(crate) fn is_elsewhere(&self, at: Vector2, from: Vector2) -> bool {
        self.observations_of(at).all(|old| (old - from).norm() > MIN_VIEWPOINT_SPACING_M)
    }

    /// Adds a keep-out zone. Returns whether the zone is new.
    pub(crate) fn bar(&mut self, at: Vector2, now: Stamp) -> bool {
        let is_new = self.keep_out.iter().all(|(old, _)| (old - at).norm() > VIRTUAL_OBSTACLE_RADIUS_M / 2.0);
        if is_new {
            self.keep_out.push((at, now));
        }
        is_new
    }

    /// Centres of the keep-out zones.
    pub(crate) fn bars(&self) -> Vec<Vector2> {
        self.keep_out.iter().map(|(at, _)| *at).collect()
    }

    /// Centre of the newest keep-out zone.
    pub(crate) fn keep_out(&self) -> Option<Vector2> {
        self.keep_out.last().map(|(at, _)| *at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::floor;

    #[test]
    fn floor_observed_in_vain_is_observed_again_after_a_while() {
        let (mut unseen, at) = (VisibilityConstraint::default(), Vector2::new(1.0, 2.0));
        let time = |s: f64| Stamp::default().after(s);
        unseen.record_observation(at, Vector2::zeros(), time(-15.0));
        // The path was long.
        unseen.note_arrival(time(5.5));
        assert!(unseen.bar(at, time(7.0)) && !unseen.bar(at, time(8.0)));
        unseen.forget(time(24.0));
        assert!(
            unseen.was_observed(at)
                && unseen.keep_out().is_some()
                && !unseen.is_elsewhere(at, Vector2::zeros())
        );
        unseen.forget(time(28.0));
        assert!(!unseen.was_observed(at) && unseen.keep_out().is_none() && unseen.is_worth_observing(at));
    }

    #[test]
    fn each_observation_counts_once_and_only_if_it_shows_its_floor() {
        let (mut unseen, time) = (VisibilityConstraint::default(), |s: f64| Stamp::default().after(s));
        let known = floor(|at| at.x > 3.0);
        for i in 0..20 {
            unseen.record_observation(Vector2::new(0.1 * (1 + i) as f64, 2.0), Vector2::zeros(), time(0.0));
            unseen.record_observation(Vector2::new(4.0, 2.0), Vector2::zeros(), time(0.0));
            (0..2).for_each(|_| unseen.note_seen(&known));
            assert_eq!(unseen.results(), i + 1);
        }
        unseen.restart();
        assert_eq!(unseen.results(), 0);
    }
}
