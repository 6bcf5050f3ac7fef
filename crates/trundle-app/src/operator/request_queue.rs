//! Requests on their way to the run: in the order of sending, except a stop.

use super::operator_error::{MAX_WAITING_REQUESTS, OperatorError};
use super::request::OperatorRequest;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use trundle_runtime::OperatorCommand;

/// The senders' end. Clones share the end.
#[derive(Debug, Clone)]
pub(super) struct RequestSender {
    waiting: Arc<Mutex<Waiting>>,
}

/// The run's end. After its drop each request is refused.
#[derive(Debug)]
pub(super) struct RequestReceiver {
    waiting: Arc<Mutex<Waiting>>,
}

#[derive(Debug, Default)]
struct Waiting {
    requests: VecDeque<OperatorRequest>,
    /// Number of the last request.
    last: u64,
    is_over: bool,
}

/// Both ends of an empty queue.
pub(super) fn request_queue() -> (RequestSender, RequestReceiver) {
    let waiting = Arc::new(Mutex::new(Waiting::default()));
    (RequestSender { waiting: Arc::clone(&waiting) }, RequestReceiver { waiting })
}

impl RequestSender {
    /// Appends a valid command; returns its number.
    pub(super) fn send(&self, command: OperatorCommand) -> Result<u64, OperatorError> {
        let mut waiting = self.open()?;
        if waiting.requests.len() >= MAX_WAITING_REQUESTS {
            return Err(OperatorError::Busy);
        }
        let request = waiting.numbered(command);
        let id = request.id;
        waiting.requests.push_back(request);
        Ok(id)
    }

    /// Puts a pause and the end of the mission before all waiting requests, and drops those that would move the robot after it.
    pub(super) fn stop(&self) -> Result<u64, OperatorError> {
        let mut waiting = self.open()?;
        waiting.requests.retain(|request| !request.command.decides_motion());
        let (pause, cancel) =
            (waiting.numbered(OperatorCommand::Pause), waiting.numbered(OperatorCommand::cancel()));
        let id = cancel.id;
        waiting.requests.push_front(cancel);
        waiting.requests.push_front(pause);
        Ok(id)
    }

    /// Puts a valid command before all waiting requests, also in a full queue. Only the run does so, once per request.
    pub(super) fn send_first(&self, command: OperatorCommand) {
        let mut waiting = lock(&self.waiting);
        let request = waiting.numbered(command);
        waiting.requests.push_front(request);
    }

    /// Number of the last request that was sent.
    pub(super) fn last(&self) -> u64 {
        lock(&self.waiting).last
    }

    fn open(&self) -> Result<MutexGuard<'_, Waiting>, OperatorError> {
        let waiting = lock(&self.waiting);
        if waiting.is_over { Err(OperatorError::Over) } else { Ok(waiting) }
    }
}

impl RequestReceiver {
    /// The next request, if one waits.
    pub(super) fn next(&self) -> Option<OperatorRequest> {
        lock(&self.waiting).requests.pop_front()
    }
}

impl Drop for RequestReceiver {
    fn drop(&mut self) {
        lock(&self.waiting).is_over = true;
    }
}

impl Waiting {
    fn numbered(&mut self, command: OperatorCommand) -> OperatorRequest {
        self.last += 1;
        OperatorRequest { id: self.last, command }
    }
}

fn lock(waiting: &Mutex<Waiting>) -> MutexGuard<'_, Waiting> {
    waiting.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{MapAnnotations, Twist2};
    use trundle_runtime::{Mission, Task};

    fn begin() -> OperatorCommand {
        OperatorCommand::Begin(Mission::new(vec![Task::Return]).unwrap())
    }

    fn taken(requests: &RequestReceiver) -> Vec<OperatorCommand> {
        std::iter::from_fn(|| requests.next()).map(|request| request.command).collect()
    }

    #[test]
    fn requests_are_numbered_in_the_order_in_which_they_are_taken() {
        let (sender, requests) = request_queue();
        assert_eq!(sender.send(begin()).unwrap(), 1);
        assert_eq!(sender.clone().send(OperatorCommand::Pause).unwrap(), 2);
        assert_eq!(requests.next().unwrap(), OperatorRequest { id: 1, command: begin() });
        assert_eq!(requests.next().unwrap().id, 2);
        assert_eq!(requests.next(), None);
    }

    #[test]
    fn a_flood_and_a_run_that_is_over_are_refused_and_use_no_numbers() {
        let (sender, requests) = request_queue();
        let ids: Vec<_> = (0..10_000).map_while(|_| sender.send(OperatorCommand::Pause).ok()).collect();
        assert_eq!(ids.len(), MAX_WAITING_REQUESTS);
        assert!(matches!(sender.send(begin()), Err(OperatorError::Busy)));
        requests.next();
        assert_eq!(sender.send(begin()).unwrap(), MAX_WAITING_REQUESTS as u64 + 1);
        drop(requests);
        assert!(matches!(sender.send(begin()), Err(OperatorError::Over)));
        assert!(matches!(sender.stop(), Err(OperatorError::Over)));
    }

    #[test]
    fn a_stop_is_first_in_a_full_queue_and_nothing_moves_the_robot_after_it() {
        let (sender, requests) = request_queue();
        let drive = OperatorCommand::Drive(Twist2::new(0.3, 0.0));
        let zones = OperatorCommand::Annotate(MapAnnotations::default());
        sender.send(zones.clone()).unwrap();
        for command in [begin(), OperatorCommand::Continue, drive].into_iter().cycle() {
            if sender.send(command).is_err() {
                break;
            }
        }
        for _ in 0..3 {
            sender.stop().unwrap();
        }
        assert_eq!(taken(&requests), [OperatorCommand::Pause, OperatorCommand::cancel(), zones]);
        let last = sender.last();
        assert_eq!(sender.send(begin()).unwrap(), last + 1);
        assert_eq!(taken(&requests), [begin()]);
    }
}
