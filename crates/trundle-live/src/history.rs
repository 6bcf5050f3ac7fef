//! The last ten minutes of a run: the driven path and the states.

use crate::wire::StateEntry;
use std::collections::VecDeque;
use std::time::Duration;
use trundle_app::operator::RunView;
use trundle_core::Pose2;

/// Period of reading views of the run. Source: ours.
pub const HISTORY_PERIOD: Duration = Duration::from_millis(200);
/// Maximum number of stored points: ten minutes of driving. Source: ours.
const MAX_POINTS: usize = 3000;
/// Maximum number of stored states. Source: ours.
const MAX_STATES: usize = 200;
/// Minimum distance between two stored points \[m\]. Source: ours; less than a pixel of a usual screen.
const POINT_DISTANCE_M: f64 = 0.02;
/// Minimum turn between two stored points \[rad\]. Source: ours.
const POINT_TURN_RAD: f64 = 0.05;

/// The last ten minutes of a run.
#[derive(Debug, Default)]
pub struct History {
    points: VecDeque<(f64, Pose2)>,
    states: VecDeque<StateEntry>,
    /// Number of states so far, including those no longer stored.
    states_so_far: usize,
    /// Number of runs that were shown before this one.
    run: u64,
}

impl History {
    /// Takes a view over, of the run with this number. The path of an earlier run is dropped.
    pub fn add(&mut self, view: &RunView, run: u64) {
        if self.run != run {
            self.points.clear();
            self.run = run;
        }
        let (time, pose) = (view.stamp.as_secs(), view.estimate.pose);
        let is_far = |last: &Pose2| {
            last.distance(&pose) > POINT_DISTANCE_M || (last.inverse() * pose).theta.abs() > POINT_TURN_RAD
        };
        if self.points.back().is_none_or(|(_, last)| is_far(last)) {
            self.points.push_back((time, pose));
        }
        let (name, reason) = (view.state.name(), view.state.reason());
        // A reason that only counts on is the same state.
        if self.states.back().is_none_or(|last| last.name != name) {
            let reason = reason.or_else(|| view.state.transition().map(|transition| transition.to_string()));
            self.states.push_back(StateEntry { time, name: name.to_owned(), reason });
            self.states_so_far += 1;
        } else if let Some(last) = self.states.back_mut() {
            last.reason = reason.or(last.reason.take());
        }
        while self.points.len() > MAX_POINTS {
            self.points.pop_front();
        }
        while self.states.len() > MAX_STATES {
            self.states.pop_front();
        }
    }

    /// The driven path: times \[s\] and poses.
    pub fn points(&self) -> impl Iterator<Item = (f64, Pose2)> + '_ {
        self.points.iter().copied()
    }

    /// The states after the first `known`, and their number so far.
    pub fn states_after(&self, known: usize) -> (Vec<StateEntry>, usize) {
        let missing = self.states_so_far.saturating_sub(known).min(self.states.len());
        (self.states.iter().skip(self.states.len() - missing).cloned().collect(), self.states_so_far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::{Activity, RunState};
    use trundle_core::{Stamp, Twist2};
    use trundle_runtime::{DriveState, Reason, TransitionReason};

    fn view(state: DriveState, transition: TransitionReason) -> RunView {
        let activity = Activity { name: "x", reason: None };
        let state = RunState::Robot(state, Some(transition));
        RunView { state, ..RunView::of_activity(Stamp::default(), Pose2::IDENTITY, Twist2::ZERO, activity) }
    }

    #[test]
    fn a_state_shows_its_own_reason_or_the_reason_for_the_change_to_it() {
        let mut history = History::default();
        history.add(&view(DriveState::Driving, TransitionReason::PlanFound), 1);
        let reason = Reason::MovingObstacle;
        history
            .add(&view(DriveState::Waiting { reason: reason.clone() }, TransitionReason::MovingObstacle), 1);
        let (states, _) = history.states_after(0);
        let shown: Vec<_> = states.iter().map(|state| state.reason.clone().unwrap()).collect();
        assert_eq!(shown, [TransitionReason::PlanFound.to_string(), reason.to_string()]);
    }
}
