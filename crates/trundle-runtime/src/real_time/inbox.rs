//! The inbox of the control thread: events and answers by urgency.

use super::loop_timer::LoopTimer;
use crate::{
    Histogram,
    workers::job::{Answer, Worker},
};
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// The input of the control thread, in one queue of bounded length. Urgent events overtake images and results. Images and results
/// are only handed out while there is time before the next wheel reading.
#[derive(Debug)]
pub struct Inbox<E> {
    receiver: Receiver<Post<E>>,
    urgent: VecDeque<E>,
    patient: VecDeque<Input<E>>,
    door: InboxSender<E>,
    lengths: Histogram,
}

/// Where others put in what the control thread shall get.
#[derive(Debug)]
pub struct InboxSender<E> {
    sender: SyncSender<Post<E>>,
    refused: Arc<AtomicU64>,
}

/// An item for the inbox.
#[derive(Debug)]
pub enum Post<E> {
    /// An event that control waits for: wheels, gyro, bumper.
    Urgent(E),
    /// An event that has time: an image.
    Patient(E),
    /// The result of a job.
    Answer(Answer),
}

/// Input of the control thread.
#[derive(Debug)]
pub enum Input<E> {
    /// A sensor event.
    Event(E),
    /// The result of a job.
    Answer(Answer),
}

impl<E> Clone for InboxSender<E> {
    fn clone(&self) -> Self {
        Self { sender: self.sender.clone(), refused: Arc::clone(&self.refused) }
    }
}

impl<E> InboxSender<E> {
    /// Puts an item in without waiting. A full queue, which was not emptied for seconds, refuses and counts it: false. False also when the
    /// inbox is dropped.
    pub fn put(&self, post: Post<E>) -> bool {
        match self.sender.try_send(post) {
            Ok(()) => true,
            Err(TrySendError::Full(_)) => {
                let refused = self.refused.fetch_add(1, Ordering::Relaxed) + 1;
                tracing::debug!("the inbox is full: an input is refused, {refused} so far");
                false
            }
            Err(TrySendError::Disconnected(_)) => false,
        }
    }

    /// Puts in an item that must not be lost; waits where the queue is full.
    pub fn hand_in(&self, post: Post<E>) -> bool {
        self.sender.send(post).is_ok()
    }
}

impl<E> Inbox<E> {
    /// An empty one for at most `capacity` things.
    pub fn new(capacity: usize) -> Self {
        let (sender, receiver) = sync_channel(capacity);
        let door = InboxSender { sender, refused: Arc::default() };
        Self {
            receiver,
            urgent: VecDeque::new(),
            patient: VecDeque::new(),
            door,
            lengths: Histogram::default(),
        }
    }

    /// A sender into this inbox.
    pub fn door(&self) -> InboxSender<E> {
        self.door.clone()
    }

    /// The next thing; none when nothing has come for `patience`. Things of a kind come in the order in which they were put in.
    pub fn next(&mut self, loop_timer: &LoopTimer, patience: Duration) -> Option<Input<E>> {
        let start = Instant::now();
        loop {
            self.empty();
            if let Some(event) = self.urgent.pop_front() {
                return Some(Input::Event(event));
            }
            let wait = match (self.patient.is_empty(), loop_timer.time_for_others()) {
                (false, None) => return self.patient.pop_front(),
                (false, Some(hold)) => hold,
                (true, _) => patience.saturating_sub(start.elapsed()),
            };
            match self.receiver.recv_timeout(wait) {
                Ok(post) => self.sort(post),
                Err(RecvTimeoutError::Timeout) if !self.patient.is_empty() => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    /// The next result of a worker, ahead of all other items; urgent events are dropped. None when it does not come within `patience`.
    pub fn next_answer(&mut self, helper: Worker, patience: Duration) -> Option<Answer> {
        let start = Instant::now();
        loop {
            self.urgent.clear();
            let is_it =
                |input: &Input<E>| matches!(input, Input::Answer(answer) if answer.worker() == helper);
            if let Some(at) = self.patient.iter().position(is_it)
                && let Some(Input::Answer(answer)) = self.patient.remove(at)
            {
                return Some(answer);
            }
            let post = self.receiver.recv_timeout(patience.saturating_sub(start.elapsed())).ok()?;
            self.sort(post);
        }
    }

    /// Things refused because the queue was full.
    pub fn refused(&self) -> u64 {
        self.door.refused.load(Ordering::Relaxed)
    }

    /// Length of the queue at each item taken.
    pub fn lengths(&self) -> &Histogram {
        &self.lengths
    }

    fn empty(&mut self) {
        while let Ok(post) = self.receiver.try_recv() {
            self.sort(post);
        }
        self.lengths.note((self.urgent.len() + self.patient.len()) as f64);
    }

    fn sort(&mut self, post: Post<E>) {
        match post {
            Post::Urgent(event) => self.urgent.push_back(event),
            Post::Patient(event) => self.patient.push_back(Input::Event(event)),
            Post::Answer(answer) => self.patient.push_back(Input::Answer(answer)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::LoopTimerConfig;
    use super::*;

    fn events(inbox: &mut Inbox<u32>, loop_timer: &LoopTimer) -> Vec<u32> {
        let mut events = Vec::new();
        while let Some(Input::Event(event)) = inbox.next(loop_timer, Duration::ZERO) {
            events.push(event);
        }
        events
    }

    #[test]
    fn urgent_things_overtake_and_each_kind_keeps_its_order() {
        let mut inbox = Inbox::new(8);
        let door = inbox.door();
        for post in [Post::Patient(1), Post::Urgent(2), Post::Patient(3), Post::Urgent(4)] {
            assert!(door.put(post));
        }
        assert_eq!(events(&mut inbox, &LoopTimer::new(LoopTimerConfig::default())), [2, 4, 1, 3]);
    }

    #[test]
    fn a_full_queue_refuses_and_counts() {
        let mut inbox = Inbox::new(2);
        let door = inbox.door();
        let put: Vec<bool> = (0..4).map(|i| door.put(Post::Urgent(i))).collect();
        assert_eq!(put, [true, true, false, false]);
        assert_eq!(inbox.refused(), 2);
        assert_eq!(events(&mut inbox, &LoopTimer::new(LoopTimerConfig::default())), [0, 1]);
    }

    #[test]
    fn in_any_mix_nothing_is_lost_and_each_kind_keeps_its_order() {
        // A linear congruential generator: another mix in each round.
        let mut state = 7_u32;
        for _ in 0..50 {
            let mut inbox = Inbox::new(64);
            let door = inbox.door();
            let urgent: Vec<bool> = (0..40)
                .map(|i| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let is_urgent = state >> 31 == 1;
                    assert!(door.put(if is_urgent { Post::Urgent(i) } else { Post::Patient(i) }));
                    is_urgent
                })
                .collect();
            let of = |kind: bool| (0..40).filter(|i| urgent[*i as usize] == kind).collect::<Vec<u32>>();
            let taken = events(&mut inbox, &LoopTimer::new(LoopTimerConfig::default()));
            assert_eq!(taken, [of(true), of(false)].concat());
            assert_eq!((inbox.refused(), inbox.lengths().count() > 0), (0, true));
        }
    }

    #[test]
    fn images_wait_while_the_next_reading_is_about_to_come() {
        let config = LoopTimerConfig { period: 0.04, reserve: 0.04, deadline: 0.1 };
        let (mut inbox, mut timer) = (Inbox::new(4), LoopTimer::new(config));
        inbox.door().put(Post::Patient(1));
        timer.begin();
        std::thread::sleep(Duration::from_millis(1));
        let start = Instant::now();
        let Some(Input::Event(1)) = inbox.next(&timer, Duration::ZERO) else {
            panic!("it is handed out in the end")
        };
        assert!(start.elapsed() >= Duration::from_millis(50), "{:?}", start.elapsed());
    }

    #[test]
    fn without_any_input_the_wait_ends_after_its_patience() {
        let mut inbox: Inbox<u32> = Inbox::new(4);
        let start = Instant::now();
        assert!(inbox.next(&LoopTimer::new(LoopTimerConfig::default()), Duration::from_millis(20)).is_none());
        assert!(start.elapsed() >= Duration::from_millis(20));
        assert!(inbox.next_answer(Worker::Decision, Duration::ZERO).is_none());
    }

    #[test]
    fn nobody_takes_what_is_put_in_after_the_control_thread_has_gone() {
        let inbox: Inbox<u32> = Inbox::new(4);
        let door = inbox.door();
        drop(inbox);
        assert!(!door.put(Post::Urgent(1)) && !door.hand_in(Post::Patient(2)));
    }
}
