//! The connection to a broker.

mod back_off;
mod event;
mod reader;
mod session;

use back_off::BackOff;
use session::Session;
use std::time::{Duration, Instant};

pub use event::{BrokerEvent, Publication};
pub(crate) use reader::LINK_NICENESS;
pub use session::SessionOptions;

/// A connection that is restored after its end.
pub struct Broker {
    options: SessionOptions,
    session: Option<Session>,
    back_off: BackOff,
    due: Instant,
}

impl Broker {
    /// A connection that starts at the first call of [`Broker::events`].
    #[must_use]
    pub fn new(options: SessionOptions) -> Self {
        Self { options, session: None, back_off: BackOff::default(), due: Instant::now() }
    }

    /// Waits up to `wait` for events; returns at most `max`, so a flood cannot block the caller.
    pub fn events(&mut self, wait: Duration, max: usize) -> Vec<BrokerEvent> {
        let until = Instant::now() + wait;
        if self.session.is_none() && Instant::now() >= self.due {
            match Session::begin(&self.options) {
                Ok(session) => self.session = Some(session),
                Err(error) => return vec![self.lose(error.to_string())],
            }
        }
        let Some(session) = &self.session else {
            std::thread::sleep(wait);
            return Vec::new();
        };
        let events = session.events(until, max);
        if events.contains(&BrokerEvent::Joined) {
            self.back_off = BackOff::default();
        }
        if events.iter().any(|event| matches!(event, BrokerEvent::Lost(_))) {
            self.lose(String::new());
        }
        events
    }

    /// Ends the session; the next one begins after a pause.
    fn lose(&mut self, reason: String) -> BrokerEvent {
        self.session = None;
        self.due = Instant::now() + self.back_off.next_wait();
        BrokerEvent::Lost(reason)
    }

    /// Sends a message. Returns whether the queue had space. The call does not wait.
    pub fn publish(&self, publication: Publication) -> bool {
        self.session.as_ref().is_some_and(|session| session.publish(publication))
    }

    /// Sends a last message and disconnects, with a short wait for its delivery.
    pub fn leave(mut self, last: Publication) {
        if let Some(session) = self.session.take() {
            session.leave(last);
        }
    }
}
