//! Requests on their way to the run: in the order of sending, except a stop.

use super::hands::{HandId, Hands};
use super::operator_error::{MAX_WAITING_REQUESTS, OperatorError};
use super::request::OperatorRequest;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use trundle_core::Twist2;
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
    /// Number of the last request that begins or ends a pause.
    last_pause: u64,
    /// The people who drive by hand.
    hands: Hands,
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

    /// Appends a twist of a person who drives by hand; returns its number.
    pub(super) fn drive(&self, hand: HandId, twist: Twist2) -> Result<u64, OperatorError> {
        if self.note_hand(hand, twist) {
            return Err(OperatorError::Stopped);
        }
        self.send(OperatorCommand::Drive(twist))
    }

    /// Notes a twist of a person, also one that is refused elsewhere; returns whether a stop bars it.
    pub(super) fn note_hand(&self, hand: HandId, twist: Twist2) -> bool {
        lock(&self.waiting).hands.note(hand, twist, Instant::now())
    }

    /// Puts the end of the mission before all waiting requests, after a pause if `is_held` or somebody drives by hand; drops those that
    /// would move the robot after it. Who drives by hand is barred until the release of the control. Returns the number of the first one.
    pub(super) fn stop(&self, is_held: bool) -> Result<u64, OperatorError> {
        let mut waiting = self.open()?;
        let is_driven = waiting.hands.bar(Instant::now());
        waiting.requests.retain(|request| !request.command.decides_motion());
        let pause = (is_held || is_driven).then(|| waiting.numbered(OperatorCommand::Pause));
        let cancel = waiting.numbered(OperatorCommand::cancel());
        let id = pause.as_ref().unwrap_or(&cancel).id;
        waiting.requests.push_front(cancel);
        pause.into_iter().for_each(|pause| waiting.requests.push_front(pause));
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

    /// Number of the last request that begins or ends a pause.
    pub(super) fn last_pause(&self) -> u64 {
        lock(&self.waiting).last_pause
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
        if command.decides_pause() {
            self.last_pause = self.last;
        }
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
        assert!(matches!(sender.stop(true), Err(OperatorError::Over)));
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
            sender.stop(true).unwrap();
        }
        assert_eq!(taken(&requests), [OperatorCommand::Pause, OperatorCommand::cancel(), zones]);
        let last = sender.last();
        assert_eq!(sender.send(begin()).unwrap(), last + 1);
        assert_eq!(taken(&requests), [begin()]);
    }

    #[test]
    fn a_stop_bars_those_who_drive_by_hand_and_nobody_else() {
        let (driver, other) = (HandId::Viewer(1), HandId::Topic);
        let twist = Twist2::new(0.3, 0.0);
        let (sender, requests) = request_queue();
        sender.drive(driver, twist).unwrap();
        sender.stop(true).unwrap();
        assert!(matches!(sender.drive(driver, twist), Err(OperatorError::Stopped)));
        sender.drive(other, twist).expect("this person did not drive");
        sender.drive(driver, Twist2::ZERO).unwrap();
        sender.drive(driver, twist).expect("a zero twist is a release");
        assert_eq!(taken(&requests).last(), Some(&OperatorCommand::Drive(twist)));
    }

    #[test]
    fn the_end_of_a_mission_pauses_only_a_robot_that_somebody_drives() {
        let (sender, requests) = request_queue();
        sender.stop(false).unwrap();
        assert_eq!(taken(&requests), [OperatorCommand::cancel()]);
        sender.drive(HandId::Topic, Twist2::new(0.3, 0.0)).unwrap();
        sender.stop(false).unwrap();
        assert_eq!(taken(&requests), [OperatorCommand::Pause, OperatorCommand::cancel()]);
    }

    #[test]
    fn the_last_request_for_a_pause_is_known() {
        let (sender, _requests) = request_queue();
        let pause = sender.send(OperatorCommand::Pause).unwrap();
        sender.send(begin()).unwrap();
        assert_eq!(sender.last_pause(), pause);
        let stop = sender.stop(true).unwrap();
        assert!(sender.last_pause() == stop && stop > pause);
        let go_on = sender.send(OperatorCommand::Continue).unwrap();
        assert_eq!(sender.last_pause(), go_on);
    }
}
