//! The two ends of the link between a run and its operator.

use super::request::OperatorRequest;
use super::run_view::RunView;
use super::view_feed::ViewFeed;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use thiserror::Error;
use trundle_core::{Invalid, Stamp};
use trundle_runtime::{OperatorCommand, Robot, StepReport};

/// Largest number of requests that wait for the run. A run takes one at each step. Source: ours.
const MAX_WAITING_REQUESTS: usize = 64;
/// Steps without a question for a view after which nobody watches the run: more than a second of events. Source: ours.
const UNWATCHED_STEPS: u32 = 200;

/// A front end's end of the link. Clones share it.
#[derive(Debug, Clone)]
pub struct Operator {
    shared: Arc<Shared>,
}

/// A run's end of the link.
#[derive(Debug)]
pub struct OperatorLink {
    requests: Receiver<OperatorRequest>,
    shared: Arc<Shared>,
    feed: ViewFeed,
    /// Steps since a front end last asked for a view.
    unwatched_steps: u32,
}

#[derive(Debug)]
struct Shared {
    /// The sender, and the number of the last request.
    requests: Mutex<(SyncSender<OperatorRequest>, u64)>,
    view: Mutex<Option<Arc<RunView>>>,
    /// Whether a front end has asked for a view since the last step.
    is_asked: AtomicBool,
}

/// Why a request does not reach the run.
#[derive(Debug, Error)]
pub enum OperatorError {
    /// A number of the command is not finite or outside its range.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// Requests come faster than the run takes them.
    #[error("{MAX_WAITING_REQUESTS} requests wait for the robot: send fewer")]
    Busy,
    /// The run is over.
    #[error("the run is over")]
    Over,
}

/// A link: the front end's end and the run's end.
#[must_use]
pub fn operator_link() -> (Operator, OperatorLink) {
    let (sender, requests) = sync_channel(MAX_WAITING_REQUESTS);
    let (requests_in, view) = (Mutex::new((sender, 0)), Mutex::default());
    let shared = Arc::new(Shared { requests: requests_in, view, is_asked: AtomicBool::new(false) });
    let link =
        OperatorLink { requests, shared: Arc::clone(&shared), feed: ViewFeed::default(), unwatched_steps: 0 };
    (Operator { shared }, link)
}

impl Operator {
    /// Sends a command; its number, by which [`RunView::mission`] names the mission that it begins.
    ///
    /// # Errors
    /// When the command cannot be obeyed, too many wait, or the run is over.
    pub fn send(&self, command: OperatorCommand) -> Result<u64, OperatorError> {
        let command = command.validated()?;
        let mut requests = self.shared.requests.lock().unwrap_or_else(PoisonError::into_inner);
        let (sender, last) = &mut *requests;
        let id = *last + 1;
        match sender.try_send(OperatorRequest { id, command }) {
            Ok(()) => {
                *last = id;
                Ok(id)
            }
            Err(TrySendError::Full(_)) => Err(OperatorError::Busy),
            Err(TrySendError::Disconnected(_)) => Err(OperatorError::Over),
        }
    }

    /// The newest view without a wish for its large parts: scan, image and map may be old.
    #[must_use]
    pub fn glance(&self) -> Option<Arc<RunView>> {
        self.shared.view.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The newest view; `None` before the first step. Scan, image and map are kept up to date while somebody asks at least once a second.
    #[must_use]
    pub fn view(&self) -> Option<Arc<RunView>> {
        self.shared.is_asked.store(true, Ordering::Relaxed);
        self.glance()
    }
}

impl OperatorLink {
    /// Another front end's end of this link.
    #[must_use]
    pub fn operator(&self) -> Operator {
        Operator { shared: Arc::clone(&self.shared) }
    }

    /// Takes an image of the camera over into later views, where somebody watches.
    pub(crate) fn note_image(&mut self, stamp: Stamp, jpeg: &[u8]) {
        if self.is_watched() {
            self.feed.note_image(stamp, jpeg);
        }
    }

    fn is_watched(&self) -> bool {
        self.unwatched_steps < UNWATCHED_STEPS
    }

    /// The next request, where one waits.
    pub(crate) fn next_request(&self) -> Option<OperatorRequest> {
        self.requests.try_recv().ok()
    }

    /// Notes which request began the present mission.
    pub(crate) fn note_request(&mut self, request: &OperatorRequest) {
        self.feed.note_request(request);
    }

    /// Publishes the state of the robot after a step.
    pub(crate) fn publish(&mut self, stamp: Stamp, robot: &Robot, report: &StepReport) {
        let is_asked = self.shared.is_asked.swap(false, Ordering::Relaxed);
        self.unwatched_steps = if is_asked { 0 } else { self.unwatched_steps.saturating_add(1) };
        if let Some(view) = self.feed.view(stamp, robot, report, self.is_watched()) {
            *self.shared.view.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(view));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Pose2;
    use trundle_runtime::{Mission, PoseGuess, Task};

    fn begin() -> OperatorCommand {
        OperatorCommand::Begin(Mission::new(vec![Task::Return]).unwrap())
    }

    #[test]
    fn requests_are_numbered_in_the_order_in_which_they_are_taken() {
        let (operator, link) = operator_link();
        assert_eq!(operator.send(begin()).unwrap(), 1);
        assert_eq!(operator.clone().send(OperatorCommand::Pause).unwrap(), 2);
        assert_eq!(link.next_request().unwrap(), OperatorRequest { id: 1, command: begin() });
        assert_eq!(link.next_request().unwrap().id, 2);
        assert_eq!(link.next_request(), None);
    }

    #[test]
    fn a_flood_and_a_run_that_is_over_are_refused_and_use_no_numbers() {
        let (operator, link) = operator_link();
        let ids: Vec<_> = (0..10_000).map_while(|_| operator.send(OperatorCommand::Pause).ok()).collect();
        assert_eq!(ids.len(), MAX_WAITING_REQUESTS);
        assert!(matches!(operator.send(begin()), Err(OperatorError::Busy)));
        link.next_request();
        assert_eq!(operator.send(begin()).unwrap(), MAX_WAITING_REQUESTS as u64 + 1);
        drop(link);
        assert!(matches!(operator.send(begin()), Err(OperatorError::Over)));
    }

    #[test]
    fn a_command_that_is_no_number_does_not_reach_the_run() {
        let (operator, link) = operator_link();
        let pose = Pose2::new(f64::NAN, 0.0, 0.0);
        let guess = PoseGuess { pose, position_sigma: 0.1, heading_sigma: 0.1 };
        assert!(matches!(operator.send(OperatorCommand::SetPose(guess)), Err(OperatorError::Invalid(_))));
        assert_eq!(link.next_request(), None);
    }
}
