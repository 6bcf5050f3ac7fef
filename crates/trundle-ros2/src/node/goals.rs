//! The goals of an action server: their states, who waits for their results, and the limits against a flood.

use crate::generated::action_msgs::{
    CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, GoalStatusArray,
};
use crate::generated::unique_identifier_msgs::UUID;
use ros2_client::RmwRequestId;
use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

/// Identity of a goal.
pub type GoalId = [u8; 16];

/// Time for which the result of a goal is stored after its end. Source: ours; a client requests it immediately.
const RESULT_LIFETIME: Duration = Duration::from_secs(60);
/// Largest number of goals accepted within a second. Source: ours; a person clicks less often, a program has no reason to.
pub const MAX_GOALS_PER_SECOND: usize = 20;
/// Maximum number of stored goals. Source: ours; enough for [`RESULT_LIFETIME`] at one goal per second, with a margin.
const MAX_GOALS: usize = 100;
/// Largest number of requests that wait for one result. Source: ours.
const MAX_WAITING: usize = 16;

/// End of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum GoalEnd {
    /// Reached.
    Succeeded,
    /// Cancelled by its client.
    Canceled,
    /// Given up, or replaced by another goal.
    Aborted,
}

impl GoalEnd {
    /// The status of `action_msgs/GoalStatus`.
    fn status(self) -> i8 {
        match self {
            Self::Succeeded => GoalStatus::STATUS_SUCCEEDED,
            Self::Canceled => GoalStatus::STATUS_CANCELED,
            Self::Aborted => GoalStatus::STATUS_ABORTED,
        }
    }
}

#[derive(Debug)]
struct Goal<R> {
    /// Time of acceptance, on the ROS clock \[ns\].
    stamp: i64,
    status: i8,
    result: Option<R>,
    ended: Option<Instant>,
    waiting: Vec<RmwRequestId>,
}

/// The answer to a request for a result.
#[derive(Debug, PartialEq)]
pub enum ResultAnswer<R> {
    /// Status and result, immediately.
    Now(i8, R),
    /// The result follows at the end of the goal.
    Later,
    /// None comes, and the reason: the answer is an empty result with the status unknown.
    Never(String),
}

/// The goals of an action server.
#[derive(Debug)]
pub struct Goals<R> {
    goals: BTreeMap<GoalId, Goal<R>>,
    /// Arrivals of the newest goals.
    arrivals: VecDeque<Instant>,
}

impl<R> Default for Goals<R> {
    fn default() -> Self {
        Self { goals: BTreeMap::new(), arrivals: VecDeque::new() }
    }
}

impl<R: Clone + Default> Goals<R> {
    /// Accepts a goal that came at `now`, `stamp` on the ROS clock \[ns\].
    ///
    /// # Errors
    /// When its id is in use, or goals arrive too fast.
    pub fn accept(&mut self, id: GoalId, stamp: i64, now: Instant) -> Result<(), String> {
        self.forget_old(now);
        if self.goals.contains_key(&id) {
            return Err("a goal id that is in use already; expected a new one for each goal".to_owned());
        }
        while self.arrivals.front().is_some_and(|arrival| now - *arrival >= Duration::from_secs(1)) {
            self.arrivals.pop_front();
        }
        if self.arrivals.len() >= MAX_GOALS_PER_SECOND {
            return Err(format!("more than {MAX_GOALS_PER_SECOND} goals in a second; the rest is refused"));
        }
        if self.goals.len() >= MAX_GOALS && !self.forget_oldest_ended() {
            return Err(format!("{MAX_GOALS} goals without an end; the rest is refused"));
        }
        self.arrivals.push_back(now);
        let goal = Goal {
            stamp,
            status: GoalStatus::STATUS_EXECUTING,
            result: None,
            ended: None,
            waiting: Vec::new(),
        };
        self.goals.insert(id, goal);
        Ok(())
    }

    /// Discards a goal that is refused after all.
    pub fn forget(&mut self, id: &GoalId) {
        self.goals.remove(id);
    }

    /// Marks the goals of a cancellation request; returns the answer, and their ids.
    pub fn cancel(&mut self, request: &CancelGoalRequest) -> (CancelGoalResponse, Vec<GoalId>) {
        let GoalInfo { goal_id, stamp } = &request.goal_info;
        let (id, before) = (goal_id.uuid, i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec));
        let is_all = id == GoalId::default() && before == 0;
        let is_asked =
            |own: &GoalId, goal: &Goal<R>| is_all || *own == id || (before != 0 && goal.stamp <= before);
        let is_running = |goal: &Goal<R>| goal.ended.is_none();
        let asked: Vec<GoalId> = self
            .goals
            .iter()
            .filter(|(own, goal)| is_asked(own, goal) && is_running(goal))
            .map(|(own, _)| *own)
            .collect();
        let is_known = self.goals.contains_key(&id);
        let mut response = CancelGoalResponse::default();
        for id in &asked {
            if let Some(goal) = self.goals.get_mut(id) {
                goal.status = GoalStatus::STATUS_CANCELING;
                response.goals_canceling.push(info(id, goal.stamp));
            }
        }
        response.return_code = match (asked.is_empty(), is_known) {
            (false, _) => CancelGoalResponse::ERROR_NONE,
            (true, true) => CancelGoalResponse::ERROR_GOAL_TERMINATED,
            (true, false) if id != GoalId::default() => CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID,
            (true, false) => CancelGoalResponse::ERROR_REJECTED,
        };
        (response, asked)
    }

    /// Ends a goal; returns the requests waiting for its result, and its status. `None` if the goal is unknown or has ended.
    pub fn end(
        &mut self,
        id: &GoalId,
        end: GoalEnd,
        result: R,
        now: Instant,
    ) -> Option<(Vec<RmwRequestId>, i8)> {
        let goal = self.goals.get_mut(id).filter(|goal| goal.ended.is_none())?;
        goal.status = end.status();
        goal.result = Some(result);
        goal.ended = Some(now);
        Some((std::mem::take(&mut goal.waiting), goal.status))
    }

    /// Whether a cancellation of the goal was requested and the goal has not ended.
    #[must_use]
    pub fn is_canceling(&self, id: &GoalId) -> bool {
        self.goals.get(id).is_some_and(|goal| goal.status == GoalStatus::STATUS_CANCELING)
    }

    /// The answer to a request for the result of a goal.
    pub fn result(&mut self, id: &GoalId, request: RmwRequestId) -> ResultAnswer<R> {
        match self.goals.get_mut(id) {
            Some(Goal { result: Some(result), status, .. }) => ResultAnswer::Now(*status, result.clone()),
            Some(goal) if goal.waiting.len() < MAX_WAITING => {
                goal.waiting.push(request);
                ResultAnswer::Later
            }
            Some(_) => {
                ResultAnswer::Never(format!("more than {MAX_WAITING} requests wait for the result of a goal"))
            }
            None => ResultAnswer::Never(unknown(id)),
        }
    }

    /// The states of all goals.
    #[must_use]
    pub fn statuses(&self) -> GoalStatusArray {
        let status = |(id, goal): (&GoalId, &Goal<R>)| GoalStatus {
            goal_info: info(id, goal.stamp),
            status: goal.status,
        };
        GoalStatusArray { status_list: self.goals.iter().map(status).collect() }
    }

    fn forget_old(&mut self, now: Instant) {
        self.goals.retain(|_, goal| goal.ended.is_none_or(|ended| now - ended < RESULT_LIFETIME));
    }

    /// Discards the goal with the earliest end. Returns whether one existed.
    fn forget_oldest_ended(&mut self) -> bool {
        let ended = self.goals.iter().filter_map(|(id, goal)| Some((goal.ended?, *id)));
        let Some((_, id)) = ended.min() else { return false };
        self.goals.remove(&id).is_some()
    }
}

/// The sentence about an id that no goal has.
pub(super) fn unknown(id: &GoalId) -> String {
    let id: String = id.iter().map(|byte| format!("{byte:02x}")).collect();
    format!(
        "no goal has the id {id}, expected that of an accepted goal, at most {} s after its end",
        RESULT_LIFETIME.as_secs()
    )
}

fn info(id: &GoalId, stamp: i64) -> GoalInfo {
    let stamp = crate::convert::stamp::to_ros(trundle_core::Stamp::from_nanos(stamp));
    GoalInfo { goal_id: UUID { uuid: *id }, stamp }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cancel(id: GoalId) -> CancelGoalRequest {
        CancelGoalRequest { goal_info: info(&id, 0) }
    }

    #[test]
    fn a_goal_goes_from_acceptance_to_its_result() {
        let (mut goals, now, id) = (Goals::<u8>::default(), Instant::now(), [7; 16]);
        goals.accept(id, 5, now).unwrap();
        assert!(goals.accept(id, 5, now).unwrap_err().contains("in use"));
        assert_eq!(goals.result(&id, RmwRequestId::default()), ResultAnswer::Later);
        let (waiting, status) = goals.end(&id, GoalEnd::Succeeded, 9, now).unwrap();
        assert_eq!((waiting.len(), status), (1, GoalStatus::STATUS_SUCCEEDED));
        assert_eq!(goals.result(&id, RmwRequestId::default()), ResultAnswer::Now(status, 9));
        assert_eq!(goals.end(&id, GoalEnd::Aborted, 1, now), None);
        assert_eq!(goals.cancel(&cancel(id)).0.return_code, CancelGoalResponse::ERROR_GOAL_TERMINATED);
        let later = now + RESULT_LIFETIME;
        goals.accept([8; 16], 6, later).unwrap();
        let ResultAnswer::Never(why) = goals.result(&id, RmwRequestId::default()) else {
            panic!("it is forgotten")
        };
        assert!(why.starts_with("no goal has the id 0707"), "{why}");
    }

    #[test]
    fn cancelling_finds_one_goal_or_all_and_garbage_ids_none() {
        let (mut goals, now) = (Goals::<u8>::default(), Instant::now());
        goals.accept([1; 16], 5, now).unwrap();
        goals.accept([2; 16], 6, now).unwrap();
        assert_eq!(goals.cancel(&cancel([9; 16])).0.return_code, CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID);
        assert_eq!(goals.cancel(&cancel([1; 16])).1, [[1; 16]]);
        assert!(goals.is_canceling(&[1; 16]) && !goals.is_canceling(&[2; 16]));
        let (response, ids) = goals.cancel(&cancel([0; 16]));
        assert_eq!((ids.len(), response.goals_canceling.len()), (2, 2));
    }

    #[test]
    fn a_flood_of_goals_is_refused() {
        let (mut goals, now) = (Goals::<u8>::default(), Instant::now());
        let id = |i: u32| [i.to_le_bytes(); 4].concat().try_into().unwrap();
        let accepted = (0..10_000).filter(|i| goals.accept(id(*i), 0, now).is_ok()).count();
        assert_eq!(accepted, MAX_GOALS_PER_SECOND);
        for second in 1..20 {
            let now = now + Duration::from_secs(second);
            for i in 0..10_000_u32 {
                let _ = goals.accept(id(i + 10_000 * second as u32), 0, now);
            }
        }
        assert!(goals.statuses().status_list.len() <= MAX_GOALS);
    }
}
