//! Ends an attempt whose potential does not fall.

use super::followed_path::FollowedPath;
use trundle_core::{OccupancyGrid, Stamp, Trajectory, Vector2};

/// The one guard against a lack of progress.
///
/// The potential of a goal is a length in metres that falls as the robot gets nearer: what is left to drive and to turn on the present map, less
/// [`OBSERVATION_LENGTH_M`] for each observation that showed unseen floor. A fall below the lowest value so far, by [`MIN_FALL_M`], is
/// progress. The guard sums up the time without progress.
///
/// A detour is longer than the lowest value. Two kinds of time therefore do not count:
/// - the drive along a path that was found at rest, while its rest falls;
/// - the time until an obstacle on the path made the path longer, once between two falls below the lowest value. Observations on the detour
///   are no progress.
///
/// At the end of the patience in a search over unseen floor the robot observes once more the reachable point nearest to the goal: what blocked
/// the path there may have left.
///
/// Every goal ends: the lowest value falls a finite number of times, and each drive that leads nowhere ends with a stop, which counts.
#[derive(Debug, Clone, Default)]
pub(crate) struct ProgressGuard {
    clock: Option<Clock>,
    path: Option<FollowedPath>,
}

/// What remains until the goal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Remaining {
    /// What is left to drive and to turn \[m\]. Infinite: no path is known.
    pub(crate) rest: f64,
    /// Number of observations that showed unseen floor, since the goal was given.
    pub(crate) results: usize,
    /// Whether the robot drives along a path to the goal, or settles at its end.
    pub(crate) is_driving: bool,
}

/// Falls of the potential, and the time since.
#[derive(Debug, Clone, Copy)]
struct Clock {
    /// Lowest potential so far, m.
    lowest: f64,
    /// Lowest rest of the present drive, m.
    lowest_of_drive: f64,
    /// Time without progress before `since`, s.
    waited: f64,
    /// Stamp of the last fall of either length, or of the end of a pause.
    since: Stamp,
    is_paused: bool,
    /// Number of observations before an obstacle made the path longer; `None` if none did since the last fall of the lowest potential.
    results_at_detour: Option<usize>,
    /// The final observation; `None` before it.
    final_observation: Option<FinalObservation>,
}

/// The final observation before a goal is given up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FinalObservation {
    /// The reachable seen point nearest to the goal, map frame \[m\].
    pub(crate) nearest: Vector2,
    /// Whether the robot was at its viewpoint.
    pub(crate) is_there: bool,
    /// End of the search at the viewpoint.
    until: Stamp,
    /// End of the drive to the viewpoint.
    limit: Stamp,
}

/// Fall of the potential that counts as progress \[m\]. Source: ours.
const MIN_FALL_M: f64 = 0.15;
/// Length that an observation with a result takes off the potential \[m\]: the width of the floor that it shows. Source: ours, the diameter
/// of a virtual obstacle.
const OBSERVATION_LENGTH_M: f64 = 0.6;
/// Smallest duration of the final observation, with the drive to its viewpoint \[s\]. Source: ours.
pub(crate) const MIN_FINAL_OBSERVATION_S: f64 = 25.0;
/// Smallest duration of the search at the viewpoint of the final observation \[s\]. Source: ours, a turn on the spot.
const SEARCH_AT_FINAL_VIEWPOINT_S: f64 = 10.0;
/// Largest duration of the drive to the viewpoint of the final observation \[s\]. Source: ours, 15 m at half the speed.
const MAX_FINAL_DRIVE_S: f64 = 60.0;

impl ProgressGuard {
    /// Starts anew for another goal.
    pub(crate) fn restart(&mut self) {
        *self = Self::default();
    }

    /// Time without progress, s. Of a drive: the time since its rest last fell.
    pub(crate) fn time_without_progress(&mut self, now: Stamp, remaining: &Remaining) -> f64 {
        let &Remaining { rest, results, is_driving } = remaining;
        let clock = self.clock(now);
        clock.is_paused = false;
        let potential = clock.potential(rest, results);
        if potential < clock.lowest - MIN_FALL_M {
            *clock = Clock { lowest: potential, ..Clock::new(now) };
        }
        if is_driving && rest < clock.lowest_of_drive - MIN_FALL_M {
            (clock.lowest_of_drive, clock.since) = (rest, now);
        }
        (now - clock.since) + if is_driving { 0.0 } else { clock.waited }
    }

    /// Excludes the time from the first of successive calls until the last one: nothing is asked of the robot, or the wait is wanted.
    pub(crate) fn pause(&mut self, now: Stamp) {
        let clock = self.clock(now);
        if !clock.is_paused {
            (clock.waited, clock.is_paused) = (clock.waited + (now - clock.since), true);
        }
        clock.since = now;
    }

    /// The robot may have been carried: its path is void, and the return to it is a detour.
    pub(crate) fn carried(&mut self, now: Stamp, results: usize) {
        self.path = None;
        self.allow_detour(now, results);
    }

    /// A drive begins from rest: its own falls stop the clock.
    pub(crate) fn start_drive(&mut self, now: Stamp) {
        let clock = self.clock(now);
        clock.waited += now - clock.since;
        (clock.since, clock.lowest_of_drive) = (now, f64::INFINITY);
    }

    /// An obstacle made the path longer, after this number of observations with a result. The time until `now` does not count, once between
    /// two falls of the lowest potential.
    pub(crate) fn allow_detour(&mut self, now: Stamp, results: usize) {
        let clock = self.clock(now);
        if clock.results_at_detour.is_none() {
            *clock = Clock { lowest: clock.lowest, results_at_detour: Some(results), ..Clock::new(now) };
        }
    }

    /// Begins the final observation: `nearest` is the reachable seen point nearest to the goal, map frame, m.
    pub(crate) fn begin_final_observation(&mut self, now: Stamp, nearest: Vector2) {
        let (until, limit) = (now.after(MIN_FINAL_OBSERVATION_S), now.after(MAX_FINAL_DRIVE_S));
        self.clock(now).final_observation = Some(FinalObservation { nearest, until, limit, is_there: false });
    }

    /// The robot is at the viewpoint of the final observation, or no viewpoint is left.
    pub(crate) fn arrived_at_final_viewpoint(&mut self, now: Stamp) {
        if let Some(observation) = &mut self.clock(now).final_observation {
            observation.is_there = true;
            observation.until = observation.until.max(now.after(SEARCH_AT_FINAL_VIEWPOINT_S));
        }
    }

    /// The final observation since the last fall of the lowest potential, also after its end.
    pub(crate) fn final_observation(&self) -> Option<FinalObservation> {
        self.clock?.final_observation
    }

    /// Whether the potential of a path of a length \[m\] is above the lowest one: the path has become longer.
    pub(crate) fn is_longer(&self, length: f64, results: usize) -> bool {
        self.clock.is_some_and(|clock| clock.potential(length, results) > clock.lowest)
    }

    /// The last path to the goal. It remains after an obstacle has blocked it.
    pub(crate) fn path(&self) -> Option<&FollowedPath> {
        self.path.as_ref()
    }

    /// Takes a new path to the goal.
    pub(crate) fn follow(&mut self, path: Trajectory) {
        self.path = Some(FollowedPath::new(path));
    }

    /// Records the robot's time on the path, s, and the floor that is seen free.
    pub(crate) fn note(&mut self, time: f64, floor: &OccupancyGrid) {
        self.path.iter_mut().for_each(|path| path.note(time, floor));
    }

    fn clock(&mut self, now: Stamp) -> &mut Clock {
        self.clock.get_or_insert_with(|| Clock::new(now))
    }
}

impl FinalObservation {
    /// Whether the final observation continues: the drive to its viewpoint, and the search there.
    pub(crate) fn continues(&self, now: Stamp) -> bool {
        now < self.until || !self.is_there && now < self.limit
    }
}

impl Clock {
    /// A clock that starts, before any path.
    fn new(now: Stamp) -> Self {
        let lowest = f64::INFINITY;
        Self {
            lowest,
            lowest_of_drive: lowest,
            waited: 0.0,
            is_paused: false,
            since: now,
            results_at_detour: None,
            final_observation: None,
        }
    }

    /// The potential \[m\].
    fn potential(&self, rest: f64, results: usize) -> f64 {
        let counted = self.results_at_detour.map_or(results, |before| before.min(results));
        rest - OBSERVATION_LENGTH_M * counted as f64
    }
}

#[cfg(test)]
mod tests;
