//! The thread of a node: it waits for messages and requests, and hands each to its handler.

use super::middleware_death;
use crate::Ros2Error;
use ros2_client::dds::rustdds::mio1::{Events, Poll, Registry, Token};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Longest wait for a message: periodic work is done at least this often. Source: ours.
const TICK_PERIOD: Duration = Duration::from_millis(20);
/// Maximum number of readiness events per step. Source: ours.
const EVENT_CAPACITY: usize = 256;

/// An endpoint of a topic or service, with its handler.
pub(super) trait Endpoint: Send {
    /// Registers the endpoint for readiness.
    fn register(&mut self, registry: &Registry, token: Token) -> io::Result<()>;

    /// Handles all queued messages.
    fn take_all(&mut self);
}

/// Work that is done at each tick.
pub(super) type Ticker = Box<dyn FnMut(Instant) + Send>;

/// A running node. A drop ends its thread.
pub struct NodeThread {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl NodeThread {
    /// Starts the thread. `guard` lives as long as the thread: the node itself.
    pub(super) fn start(
        mut endpoints: Vec<Box<dyn Endpoint>>,
        mut tickers: Vec<Ticker>,
        guard: impl Send + 'static,
    ) -> Result<Self, Ros2Error> {
        let poll = Poll::new()?;
        for (i, endpoint) in endpoints.iter_mut().enumerate() {
            endpoint.register(poll.registry(), Token(i))?;
        }
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let run = move || {
            let _guard = guard;
            // Messages before the registration cause no event.
            endpoints.iter_mut().for_each(|endpoint| endpoint.take_all());
            run_loop(poll, &mut endpoints, &mut tickers, &over);
        };
        let thread = std::thread::Builder::new().name("ros2".to_owned()).spawn(run)?;
        Ok(Self { is_over, thread: Some(thread) })
    }

    /// The thread of the node or the middleware that has ended: by a panic, as long as the node is not dropped. `None` while all run.
    #[must_use]
    pub fn death(&self) -> Option<String> {
        let own = self.thread.as_ref().is_none_or(JoinHandle::is_finished);
        let name = if own { Some("ros2".to_owned()) } else { middleware_death::dead_thread() };
        name.map(|name| format!("the thread '{name}' of ROS 2 has died: start the program anew"))
    }

    /// Whether a thread of the node or of the middleware has ended.
    #[must_use]
    pub fn is_dead(&self) -> bool {
        self.death().is_some()
    }
}

impl Drop for NodeThread {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread of the ROS 2 node panicked");
        }
    }
}

fn run_loop(mut poll: Poll, endpoints: &mut [Box<dyn Endpoint>], tickers: &mut [Ticker], over: &AtomicBool) {
    let mut events = Events::with_capacity(EVENT_CAPACITY);
    let mut due = Instant::now();
    while !over.load(Ordering::Relaxed) {
        let wait = due.saturating_duration_since(Instant::now());
        match poll.poll(&mut events, Some(wait)) {
            Err(error) if error.kind() != io::ErrorKind::Interrupted => {
                tracing::error!("the ROS 2 node cannot wait for messages: {error}");
                return;
            }
            _ => {}
        }
        for event in &events {
            if let Some(endpoint) = endpoints.get_mut(event.token().0) {
                endpoint.take_all();
            }
        }
        let now = Instant::now();
        if now >= due {
            due = now + TICK_PERIOD;
            tickers.iter_mut().for_each(|tick| tick(now));
        }
    }
}
