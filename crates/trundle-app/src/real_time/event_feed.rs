//! The path of events from drivers into a run.

use super::event_order::{EventOrder, MAX_HOLD_S, Placed};
use super::{BodyTiming, DeviceReport, EventOrderCounts, MemoryUsage, TimedEvent};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::{BodyEvent, BodyEventKind, SensorEvent, Stamp};
use trundle_drivers::clock::HostClock;
use trundle_io::EncodedEvent;
use trundle_runtime::Histogram;
use trundle_runtime::real_time::{InboxItem, InboxSender};

/// Time without any event after which silence is reported: five readings of a base at 50 Hz. Source: ours.
const MIN_SILENCE: Duration = Duration::from_millis(100);

/// Callback for each event of the drivers, in the thread that sends the event; the callback must not wait.
pub type EventObserver = Arc<dyn Fn(&SensorEvent) + Send + Sync>;

/// Sends the events of drivers into a run, from any thread. Images are encoded in the sending thread. Events out of order are put in order
/// where that takes at most 0.1 s.
#[derive(Clone)]
pub struct EventFeed {
    events: InboxSender<TimedEvent>,
    /// The instant of stamp 0.
    origin: Instant,
    /// The time of the run.
    clock: HostClock,
    state: Arc<Mutex<FeedState>>,
}

#[derive(Default)]
struct FeedState {
    /// Arrival of the newest event.
    newest: Option<Instant>,
    images: u64,
    images_refused: u64,
    /// [ms]
    image_ages: Histogram,
    memory: MemoryUsage,
    order: EventOrder,
}

impl EventFeed {
    /// A feed into the inbox of a run. Stamps count from `origin`.
    #[must_use]
    pub fn new(events: InboxSender<TimedEvent>, origin: Instant) -> Self {
        let clock = Arc::new(move || Stamp::default().after(origin.elapsed().as_secs_f64()));
        Self::with_clock(events, origin, clock)
    }

    /// A feed with another clock of the run: a simulator's clock may run slower or stop.
    #[must_use]
    pub fn with_clock(events: InboxSender<TimedEvent>, origin: Instant, clock: HostClock) -> Self {
        Self { events, origin, clock, state: Arc::default() }
    }

    /// The instant of stamp 0: drivers map their clocks to it.
    #[must_use]
    pub fn origin(&self) -> Instant {
        self.origin
    }

    /// Sends an event. An event that cannot be encoded is logged and dropped.
    pub fn send(&self, event: &SensorEvent) {
        match EncodedEvent::encode(event) {
            Ok(encoded) => self.put(encoded),
            Err(error) => tracing::warn!("event of {:.3} s dropped: {error}", event.stamp().as_secs()),
        }
    }

    /// Number of events out of order so far.
    #[must_use]
    pub fn order_counts(&self) -> EventOrderCounts {
        self.state().order.counts()
    }

    /// Hands on the events whose wait for earlier ones is over. Returns whether others wait.
    pub(super) fn hand_on_due(&self) -> bool {
        let mut state = self.state();
        self.hand_on(&mut state);
        !state.order.is_empty()
    }

    /// Reports silence if no event has come for long enough.
    pub(super) fn report_silence(&self) {
        let now = Instant::now();
        let mut state = self.state();
        let since = *state.newest.get_or_insert(now);
        if now - since >= MIN_SILENCE {
            state.newest = Some(now);
            drop(state);
            let event = BodyEvent::new((self.clock)(), BodyEventKind::Silence);
            self.events.put(InboxItem::Urgent(TimedEvent { event: EncodedEvent::Body(event), at: now }));
        }
    }

    /// Timing of the drivers.
    pub(super) fn timing(&self) -> BodyTiming {
        let state = self.state();
        let age = |fraction| state.image_ages.quantile(fraction).unwrap_or_default();
        BodyTiming {
            lateness: None,
            images_not_taken: state.images_refused,
            images: state.images,
            order: state.order.counts(),
            devices: DeviceReport::default(),
            image_age_median_ms: age(0.5),
            image_age_p99_ms: age(0.99),
            memory: state.memory.clone(),
        }
    }

    fn put(&self, event: EncodedEvent) {
        let (at, now) = (Instant::now(), (self.clock)());
        let mut state = self.state();
        state.newest = Some(at);
        state.memory.sample((at - self.origin).as_secs_f64());
        let stamp = event.stamp();
        if matches!(event, EncodedEvent::Rgbd(_)) {
            state.images += 1;
            state.image_ages.note(((now - stamp) * 1e3).max(0.0));
        }
        match state.order.place(TimedEvent { event, at }, now) {
            Placed::Passed(event) => self.deliver(&mut state, event),
            Placed::Held => {}
            Placed::Dropped => log_late(state.order.counts().late, stamp, now),
        }
        self.hand_on(&mut state);
    }

    /// Hands on the events whose wait is over. The lock on `state` keeps them in order.
    fn hand_on(&self, state: &mut FeedState) {
        let now = (self.clock)();
        while let Some(event) = state.order.pop(now) {
            self.deliver(state, event);
        }
    }

    fn deliver(&self, state: &mut FeedState, event: TimedEvent) {
        let is_image = matches!(event.event, EncodedEvent::Rgbd(_));
        let item = if is_image { InboxItem::Deferred(event) } else { InboxItem::Urgent(event) };
        state.images_refused += u64::from(!self.events.put(item) && is_image);
    }

    fn state(&self) -> std::sync::MutexGuard<'_, FeedState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Logs an event that came too late: the first as a warning.
fn log_late(count: u64, stamp: Stamp, now: Stamp) {
    let age_ms = (now - stamp) * 1e3;
    if count == 1 {
        tracing::warn!(
            "an event of {stamp} s came {age_ms:.0} ms after its stamp and behind a newer one, expected at most {:.0} ms: it is dropped; \
             the report counts such events",
            MAX_HOLD_S * 1e3
        );
    } else {
        tracing::debug!(
            "an event of {stamp} s came {age_ms:.0} ms after its stamp and is dropped, {count} so far"
        );
    }
}
