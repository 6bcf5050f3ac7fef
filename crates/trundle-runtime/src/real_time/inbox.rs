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

/// The input of the control thread in one bounded queue. Urgent events overtake images and results. Images and results are delivered only
/// if time is left before the next wheel reading.
#[derive(Debug)]
pub struct Inbox<E> {
    receiver: Receiver<InboxItem<E>>,
    urgent: VecDeque<E>,
    deferred: VecDeque<Input<E>>,
    sender: InboxSender<E>,
    lengths: Histogram,
}

/// The sending end of an inbox, for drivers and workers.
#[derive(Debug)]
pub struct InboxSender<E> {
    sender: SyncSender<InboxItem<E>>,
    refused: Arc<AtomicU64>,
}

/// An item for the inbox.
#[derive(Debug)]
pub enum InboxItem<E> {
    /// An urgent event: wheels, gyro, bumper.
    Urgent(E),
    /// An event without urgency: an image.
    Deferred(E),
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
    /// Adds an item without waiting. Returns false if the queue is full, after seconds without a reader, and counts the refusal. Returns
    /// false also after the inbox was dropped.
    pub fn put(&self, item: InboxItem<E>) -> bool {
        match self.sender.try_send(item) {
            Ok(()) => true,
            Err(TrySendError::Full(_)) => {
                let refused = self.refused.fetch_add(1, Ordering::Relaxed) + 1;
                tracing::debug!("the inbox is full: an input is refused, {refused} so far");
                false
            }
            Err(TrySendError::Disconnected(_)) => false,
        }
    }

    /// Adds an item that must not be lost; waits while the queue is full.
    pub fn send_waiting(&self, item: InboxItem<E>) -> bool {
        self.sender.send(item).is_ok()
    }
}

impl<E> Inbox<E> {
    /// An empty inbox for at most `capacity` items.
    pub fn new(capacity: usize) -> Self {
        let (sender, receiver) = sync_channel(capacity);
        let sender = InboxSender { sender, refused: Arc::default() };
        Self {
            receiver,
            urgent: VecDeque::new(),
            deferred: VecDeque::new(),
            sender,
            lengths: Histogram::default(),
        }
    }

    /// A sender into this inbox.
    pub fn sender(&self) -> InboxSender<E> {
        self.sender.clone()
    }

    /// The next item; `None` if none arrives within `patience`. Items of one kind keep the order of their arrival.
    pub fn next(&mut self, loop_timer: &LoopTimer, patience: Duration) -> Option<Input<E>> {
        let start = Instant::now();
        loop {
            self.empty();
            if let Some(event) = self.urgent.pop_front() {
                return Some(Input::Event(event));
            }
            let wait = match (self.deferred.is_empty(), loop_timer.time_for_others()) {
                (false, None) => return self.deferred.pop_front(),
                (false, Some(hold)) => hold,
                (true, _) => patience.saturating_sub(start.elapsed()),
            };
            match self.receiver.recv_timeout(wait) {
                Ok(item) => self.sort(item),
                Err(RecvTimeoutError::Timeout) if !self.deferred.is_empty() => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return None,
            }
        }
    }

    /// The next result of a worker, before all other items; urgent events are dropped. `None` if no result arrives within `patience`.
    pub fn next_answer(&mut self, worker: Worker, patience: Duration) -> Option<Answer> {
        let start = Instant::now();
        loop {
            self.urgent.clear();
            let is_wanted =
                |input: &Input<E>| matches!(input, Input::Answer(answer) if answer.worker() == worker);
            if let Some(at) = self.deferred.iter().position(is_wanted)
                && let Some(Input::Answer(answer)) = self.deferred.remove(at)
            {
                return Some(answer);
            }
            let item = self.receiver.recv_timeout(patience.saturating_sub(start.elapsed())).ok()?;
            self.sort(item);
        }
    }

    /// Number of items refused because the queue was full.
    pub fn refused(&self) -> u64 {
        self.sender.refused.load(Ordering::Relaxed)
    }

    /// Length of the queue at the delivery of each item.
    pub fn lengths(&self) -> &Histogram {
        &self.lengths
    }

    fn empty(&mut self) {
        while let Ok(item) = self.receiver.try_recv() {
            self.sort(item);
        }
        self.lengths.note((self.urgent.len() + self.deferred.len()) as f64);
    }

    fn sort(&mut self, item: InboxItem<E>) {
        match item {
            InboxItem::Urgent(event) => self.urgent.push_back(event),
            InboxItem::Deferred(event) => self.deferred.push_back(Input::Event(event)),
            InboxItem::Answer(answer) => self.deferred.push_back(Input::Answer(answer)),
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
    fn urgent_items_overtake_and_each_kind_keeps_its_order() {
        let mut inbox = Inbox::new(8);
        let sender = inbox.sender();
        for item in
            [InboxItem::Deferred(1), InboxItem::Urgent(2), InboxItem::Deferred(3), InboxItem::Urgent(4)]
        {
            assert!(sender.put(item));
        }
        assert_eq!(events(&mut inbox, &LoopTimer::new(LoopTimerConfig::default())), [2, 4, 1, 3]);
    }

    #[test]
    fn a_full_queue_refuses_and_counts() {
        let mut inbox = Inbox::new(2);
        let sender = inbox.sender();
        let put: Vec<bool> = (0..4).map(|i| sender.put(InboxItem::Urgent(i))).collect();
        assert_eq!(put, [true, true, false, false]);
        assert_eq!(inbox.refused(), 2);
        assert_eq!(events(&mut inbox, &LoopTimer::new(LoopTimerConfig::default())), [0, 1]);
    }

    #[test]
    fn in_any_mix_nothing_is_lost_and_each_kind_keeps_its_order() {
        // A linear congruential generator gives a new mix in each round.
        let mut state = 7_u32;
        for _ in 0..50 {
            let mut inbox = Inbox::new(64);
            let sender = inbox.sender();
            let urgent: Vec<bool> = (0..40)
                .map(|i| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let is_urgent = state >> 31 == 1;
                    assert!(sender.put(if is_urgent {
                        InboxItem::Urgent(i)
                    } else {
                        InboxItem::Deferred(i)
                    }));
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
        inbox.sender().put(InboxItem::Deferred(1));
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
    fn inputs_after_the_end_of_the_control_thread_are_dropped() {
        let inbox: Inbox<u32> = Inbox::new(4);
        let sender = inbox.sender();
        drop(inbox);
        assert!(!sender.put(InboxItem::Urgent(1)) && !sender.send_waiting(InboxItem::Deferred(2)));
    }
}
