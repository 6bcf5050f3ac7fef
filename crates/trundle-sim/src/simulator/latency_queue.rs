//! Sensor events that a fault delays.

use crate::kobuki::STEPS_PER_SECOND;
use std::collections::VecDeque;
use trundle_core::SensorEvent;

/// Events with an additional delay.
#[derive(Debug, Default)]
pub(super) struct LatencyQueue {
    /// The step at which each arrives, in the order of sending.
    waiting: Vec<(u64, SensorEvent)>,
}

impl LatencyQueue {
    /// Queues an event, or delays it by `delay` s.
    pub(super) fn send(
        &mut self,
        event: SensorEvent,
        now: u64,
        delay: f64,
        queue: &mut VecDeque<SensorEvent>,
    ) {
        let steps = (delay * STEPS_PER_SECOND).round() as u64;
        if steps == 0 {
            queue.push_back(event);
        } else {
            self.waiting.push((now + steps, event));
        }
    }

    /// Queues the delayed events that are due, after the events already queued.
    pub(super) fn arrive(&mut self, now: u64, queue: &mut VecDeque<SensorEvent>) {
        if self.waiting.is_empty() {
            return;
        }
        let (arrived, waiting) =
            std::mem::take(&mut self.waiting).into_iter().partition(|(at, _)| *at <= now);
        self.waiting = waiting;
        let arrived: Vec<(u64, SensorEvent)> = arrived;
        queue.extend(arrived.into_iter().map(|(_, event)| event));
    }
}
