//! An action server with its goals.

use super::event_loop::Endpoint;
use super::goals::{GoalEnd, GoalId, Goals, ResultAnswer, unknown};
use super::{Diagnostics, RosNode, reply};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::generated::action_msgs::{CancelGoalRequest, CancelGoalResponse, GoalStatus};
use crate::interface::ActionType;
use ros2_client::action::{
    ActionServer, GetResultResponse, GoalId as Uuid, GoalStatusEnum, SendGoalRequest, SendGoalResponse,
};
use ros2_client::dds::rustdds::mio1::event::Source;
use ros2_client::dds::rustdds::mio1::{Interest, Registry, Token};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Maximum number of requests handled in one step. Source: ours.
const MAX_TAKEN_AT_ONCE: usize = 1000;

type Server<A> =
    ActionServer<<A as ActionType>::Goal, <A as ActionType>::Result, <A as ActionType>::Feedback>;

/// Decides about the goals of an action. Called in the node's thread.
pub trait GoalHandler<A: ActionType>: Send {
    /// Accepts a goal, or returns the reason for its refusal.
    ///
    /// # Errors
    /// Reason why the goal is refused.
    fn on_goal(&mut self, id: GoalId, goal: A::Goal) -> Result<(), String>;

    /// The client of a goal requests its cancellation.
    fn on_cancel(&mut self, id: GoalId);
}

/// A running action server: ends goals and sends feedback, from any thread.
pub struct ActionHandle<A: ActionType>(Arc<Mutex<Inner<A>>>);

impl<A: ActionType> Clone for ActionHandle<A> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

struct Inner<A: ActionType> {
    server: Server<A>,
    goals: Goals<A::Result>,
    /// The client library's form of each goal's id.
    ids: BTreeMap<GoalId, Uuid>,
    clock: RosClock,
    name: String,
    diagnostics: Diagnostics,
}

impl<A: ActionType + 'static> ActionHandle<A>
where
    A::Result: Default,
{
    /// Offers the action `name`; `handler` decides about its goals.
    ///
    /// # Errors
    /// When the action cannot be created.
    pub fn offer(
        node: &mut RosNode,
        name: &str,
        clock: RosClock,
        handler: impl FnOnce(Self) -> Box<dyn GoalHandler<A>>,
    ) -> Result<Self, Ros2Error> {
        let server = node.raw_action_server::<A>(name)?;
        let (name, diagnostics) = (node.names().resolve(name), node.diagnostics());
        let inner = Inner { server, goals: Goals::default(), ids: BTreeMap::new(), clock, name, diagnostics };
        let handle = Self(Arc::new(Mutex::new(inner)));
        let handler = handler(handle.clone());
        node.add_endpoint(Box::new(ActionEndpoint { handle: handle.clone(), handler }));
        Ok(handle)
    }

    /// Ends a goal with its result. A goal that has ended does not change.
    pub fn end(&self, id: &GoalId, end: GoalEnd, result: A::Result) {
        let mut inner = self.lock();
        let Some((waiting, status)) = inner.goals.end(id, end, result.clone(), Instant::now()) else {
            return;
        };
        for request in waiting {
            inner.send_result(request, status, result.clone());
        }
        inner.publish_statuses();
    }

    /// Sends feedback of a goal.
    pub fn feedback(&self, id: &GoalId, feedback: A::Feedback) {
        let inner = self.lock();
        if let Some(uuid) = inner.ids.get(id)
            && inner.server.send_feedback(*uuid, feedback).is_err()
        {
            tracing::debug!("feedback of {} was not sent", inner.name);
        }
    }

    /// Whether the client of a goal requested its cancellation.
    #[must_use]
    pub fn is_canceling(&self, id: &GoalId) -> bool {
        self.lock().goals.is_canceling(id)
    }

    fn lock(&self) -> MutexGuard<'_, Inner<A>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<A: ActionType> Inner<A>
where
    A::Result: Default,
{
    fn send_result(&self, request: ros2_client::RmwRequestId, status: i8, result: A::Result) {
        let mut response = GetResultResponse { status: status_of(status), result };
        if let Some(bytes) = reply::excess(&response) {
            self.diagnostics.warn(&self.name, reply::shortening(bytes));
            let fits = |result: &A::Result| {
                let status = status_of(status);
                reply::arrives(&GetResultResponse { status, result: result.clone() })
            };
            response.result = reply::shortened(&response.result, fits).unwrap_or_default();
        }
        if self.server.send_result(request, response).is_err() {
            tracing::debug!("a result of {} was not sent", self.name);
        }
    }

    fn publish_statuses(&mut self) {
        let statuses = self.goals.statuses();
        self.ids
            .retain(|id, _| statuses.status_list.iter().any(|status| status.goal_info.goal_id.uuid == *id));
        let sent = in_form_of(&statuses).map(|statuses| self.server.send_goal_statuses(statuses));
        if !matches!(sent, Some(Ok(()))) {
            tracing::debug!("the states of the goals of {} were not sent", self.name);
        }
    }
}

struct ActionEndpoint<A: ActionType> {
    handle: ActionHandle<A>,
    handler: Box<dyn GoalHandler<A>>,
}

impl<A: ActionType + 'static> Endpoint for ActionEndpoint<A>
where
    A::Result: Default,
{
    fn register(&mut self, registry: &Registry, token: Token) -> io::Result<()> {
        let server = &mut self.handle.lock().server;
        Source::register(server.goal_server(), registry, token, Interest::READABLE)?;
        Source::register(server.cancel_server(), registry, token, Interest::READABLE)?;
        Source::register(server.result_server(), registry, token, Interest::READABLE)
    }

    fn take_all(&mut self) {
        for _ in 0..MAX_TAKEN_AT_ONCE {
            if !(self.take_goal() | self.take_cancel() | self.take_result_request()) {
                return;
            }
        }
    }
}

impl<A: ActionType + 'static> ActionEndpoint<A>
where
    A::Result: Default,
{
    /// Handles one goal request; returns whether one was queued.
    fn take_goal(&mut self) -> bool {
        let taken = self.handle.lock().server.receive_goal();
        let (request, SendGoalRequest { goal_id, goal }) = match taken {
            Ok(Some(taken)) => taken,
            Ok(None) => return false,
            Err(error) => return self.on_unreadable("goal", &error),
        };
        let id: GoalId = *goal_id.uuid.as_bytes();
        let mut inner = self.handle.lock();
        let stamp = inner.clock.ros_now();
        let accepted = inner.goals.accept(id, stamp.nanos, Instant::now());
        drop(inner);
        let accepted = accepted.and_then(|()| {
            self.handler.on_goal(id, goal).inspect_err(|_| self.handle.lock().goals.forget(&id))
        });
        let mut inner = self.handle.lock();
        if let Err(why) = &accepted {
            inner.diagnostics.warn(&inner.name, format!("a goal was refused: {why}"));
        } else {
            inner.ids.insert(id, goal_id);
        }
        let time = ros2_client::builtin_interfaces::Time::from_nanos(stamp.nanos);
        let response = SendGoalResponse { accepted: accepted.is_ok(), stamp: time };
        if inner.server.send_goal_response(request, response).is_err() {
            tracing::debug!("a response of {} was not sent", inner.name);
        }
        inner.publish_statuses();
        true
    }

    /// Handles one cancellation request; returns whether one was queued.
    fn take_cancel(&mut self) -> bool {
        let mut inner = self.handle.lock();
        let (request, asked) = match inner.server.receive_cancel_request() {
            Ok(Some(taken)) => taken,
            Ok(None) => return false,
            Err(error) => {
                drop(inner);
                return self.on_unreadable("request to cancel", &error);
            }
        };
        let asked: CancelGoalRequest = in_form_of(&asked).unwrap_or_default();
        let (response, ids) = inner.goals.cancel(&asked);
        if response.return_code == CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID {
            let why = unknown(&asked.goal_info.goal_id.uuid);
            inner.diagnostics.warn(&inner.name, format!("a request to cancel is refused: {why}"));
        }
        if let Some(response) = in_form_of::<CancelGoalResponse, _>(&response)
            && inner.server.send_cancel_response(request, response).is_err()
        {
            tracing::debug!("a response of {} was not sent", inner.name);
        }
        inner.publish_statuses();
        drop(inner);
        ids.into_iter().for_each(|id| self.handler.on_cancel(id));
        true
    }

    /// Handles one result request; returns whether one was queued.
    fn take_result_request(&mut self) -> bool {
        let mut inner = self.handle.lock();
        let (request, asked) = match inner.server.receive_result_request() {
            Ok(Some(taken)) => taken,
            Ok(None) => return false,
            Err(error) => {
                drop(inner);
                return self.on_unreadable("request for a result", &error);
            }
        };
        match inner.goals.result(asked.goal_id.uuid.as_bytes(), request) {
            ResultAnswer::Now(status, result) => inner.send_result(request, status, result),
            ResultAnswer::Later => {}
            ResultAnswer::Never(why) => {
                inner.diagnostics.warn(&inner.name, format!("a request for a result is refused: {why}"));
                inner.send_result(request, GoalStatus::STATUS_UNKNOWN, A::Result::default());
            }
        }
        true
    }

    fn on_unreadable(&self, what: &str, error: &dyn std::fmt::Debug) -> bool {
        let inner = self.handle.lock();
        let message =
            format!("a {what} cannot be read ({error:?}): its sender uses another definition of the action");
        inner.diagnostics.warn(&inner.name, message);
        true
    }
}

/// A value in the client library's form of the same interface, whose fields are private.
fn in_form_of<T: Serialize, U: DeserializeOwned>(value: &T) -> Option<U> {
    serde_json::from_value(serde_json::to_value(value).ok()?).ok()
}

fn status_of(status: i8) -> GoalStatusEnum {
    match status {
        1 => GoalStatusEnum::Accepted,
        2 => GoalStatusEnum::Executing,
        3 => GoalStatusEnum::Canceling,
        4 => GoalStatusEnum::Succeeded,
        5 => GoalStatusEnum::Canceled,
        6 => GoalStatusEnum::Aborted,
        _ => GoalStatusEnum::Unknown,
    }
}
