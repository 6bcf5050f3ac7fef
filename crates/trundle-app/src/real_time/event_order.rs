//! The order of the events of drivers: those of each kind by their stamps, within a bound.

use super::{EventOrderCounts, TimedEvent};
use trundle_core::Stamp;
use trundle_drivers::clock::{ReorderBuffer, ReorderCounts};
use trundle_io::EncodedEvent;

/// Longest time for which an event waits for an earlier one \[s\]. Source: ours; twice a jitter of 50 ms, half of the base's time-out.
pub(super) const MAX_HOLD_S: f64 = 0.1;
/// Maximum number of events of a kind that wait: 0.1 s of a gyro at 400 Hz and a base at 50 Hz. Source: ours.
const MAX_EVENTS: usize = 64;
/// Maximum number of images that wait: their memory is bounded. Source: ours.
const MAX_IMAGES: usize = 8;

/// Puts motion (wheels, gyro, odometry), images and scans in order, each kind by itself: an image is older than the newest odometry by
/// nature. What stops the robot never waits.
pub(super) struct EventOrder {
    motion: ReorderBuffer<TimedEvent>,
    images: ReorderBuffer<TimedEvent>,
    scans: ReorderBuffer<TimedEvent>,
}

impl Default for EventOrder {
    fn default() -> Self {
        Self {
            motion: ReorderBuffer::new(MAX_HOLD_S, MAX_EVENTS),
            images: ReorderBuffer::new(MAX_HOLD_S, MAX_IMAGES),
            scans: ReorderBuffer::new(MAX_HOLD_S, MAX_IMAGES),
        }
    }
}

/// What becomes of an event.
pub(super) enum Placed {
    /// It goes on at once.
    Passed(TimedEvent),
    /// It waits for its place.
    Held,
    /// It came too late and is dropped.
    Dropped,
}

impl EventOrder {
    /// Places an event that arrives at `now`.
    pub(super) fn place(&mut self, event: TimedEvent, now: Stamp) -> Placed {
        let buffer = match event.event {
            EncodedEvent::Wheels(_) | EncodedEvent::Gyro(_) | EncodedEvent::Odometry(_) => &mut self.motion,
            EncodedEvent::Rgbd(_) => &mut self.images,
            EncodedEvent::Scan(_) => &mut self.scans,
            _ => return Placed::Passed(event),
        };
        if buffer.push(event.event.stamp(), now, event) { Placed::Held } else { Placed::Dropped }
    }

    /// The next event whose wait is over at `now`, motion first.
    pub(super) fn pop(&mut self, now: Stamp) -> Option<TimedEvent> {
        self.motion.pop(now).or_else(|| self.images.pop(now)).or_else(|| self.scans.pop(now))
    }

    /// Whether no event waits.
    pub(super) fn is_empty(&self) -> bool {
        self.motion.is_empty() && self.images.is_empty() && self.scans.is_empty()
    }

    /// Counts of all kinds.
    pub(super) fn counts(&self) -> EventOrderCounts {
        let all = [self.motion.counts(), self.images.counts(), self.scans.counts()];
        let sum = |of: fn(&ReorderCounts) -> u64| all.iter().map(of).sum();
        EventOrderCounts { reordered: sum(|counts| counts.reordered), late: sum(|counts| counts.late) }
    }
}
