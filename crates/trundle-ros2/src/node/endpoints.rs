//! Subscriptions and service servers with their handlers.

use super::event_loop::Endpoint;
use super::{Diagnostics, TopicMonitor, reply};
use ros2_client::dds::rustdds::mio1::event::Source;
use ros2_client::dds::rustdds::mio1::{Interest, Registry, Token};
use ros2_client::{Gid, Message, RmwRequestId, Server, Subscription};
use std::io;
use std::sync::Arc;

/// Maximum number of messages handled in one step, during which other topics wait. Source: ours.
const MAX_TAKEN_AT_ONCE: usize = 1000;

/// A subscription and its handler.
pub(super) struct Subscribed<M: Message + Send + 'static, F> {
    pub subscription: Subscription<M>,
    pub handler: F,
    pub name: String,
    pub monitor: Arc<TopicMonitor>,
    pub diagnostics: Diagnostics,
    /// The node, if its own messages are left out.
    pub left_out: Option<Gid>,
}

/// Length of the part of an identifier that all publishers of a node share. Source: DDSI-RTPS, 8.2.4.1.
const PREFIX_BYTES: usize = 12;

/// Whether a publisher belongs to `node`.
fn is_of_node(publisher: Gid, node: Gid) -> bool {
    publisher.as_bytes()[..PREFIX_BYTES] == node.as_bytes()[..PREFIX_BYTES]
}

impl<M: Message + Send + 'static, F: FnMut(M) + Send> Endpoint for Subscribed<M, F> {
    fn register(&mut self, registry: &Registry, token: Token) -> io::Result<()> {
        Source::register(&mut self.subscription, registry, token, Interest::READABLE)
    }

    fn take_all(&mut self) {
        for _ in 0..MAX_TAKEN_AT_ONCE {
            match self.subscription.take() {
                Ok(Some((_, info)))
                    if self.left_out.is_some_and(|node| is_of_node(info.publisher_gid(), node)) => {}
                Ok(Some((message, _))) => {
                    self.monitor.on_message();
                    (self.handler)(message);
                }
                Ok(None) => return,
                Err(error) => {
                    let message = format!(
                        "a message cannot be read ({error:?}): its sender uses another definition of the type"
                    );
                    self.diagnostics.warn(&self.name, message);
                }
            }
        }
    }
}

/// A service server and its handler. The handler answers through the server, immediately or later.
pub(super) struct Served<Req: Message, Resp: Message, F> {
    pub server: Arc<ServerHandle<Req, Resp>>,
    pub handler: F,
    pub name: String,
    pub diagnostics: Diagnostics,
}

/// A server that is shared between the node's thread and those who answer later.
pub struct ServerHandle<Req: Message, Resp: Message> {
    server: std::sync::Mutex<Server<Req, Resp>>,
    name: String,
    diagnostics: Diagnostics,
}

impl<Req: Message + Clone + 'static, Resp: Message + Default + 'static> ServerHandle<Req, Resp> {
    pub(super) fn new(server: Server<Req, Resp>, name: String, diagnostics: Diagnostics) -> Arc<Self> {
        Arc::new(Self { server: std::sync::Mutex::new(server), name, diagnostics })
    }

    /// Answers a request; a response too large for delivery is replaced by an empty one.
    pub fn answer(&self, request: RmwRequestId, response: Resp) {
        let excess = reply::excess(&response);
        excess.into_iter().for_each(|bytes| self.diagnostics.warn(&self.name, reply::message(bytes)));
        let response = if excess.is_some() { Resp::default() } else { response };
        if let Err(error) = self.lock().send_response(request, response) {
            tracing::debug!("a response of {} was not sent: {error:?}", self.name);
        }
    }

    pub(super) fn lock(&self) -> std::sync::MutexGuard<'_, Server<Req, Resp>> {
        self.server.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

impl<Req, Resp, F> Endpoint for Served<Req, Resp, F>
where
    Req: Message + Clone + Send + 'static,
    Resp: Message + Default + Send + 'static,
    F: FnMut(RmwRequestId, Req) + Send,
{
    fn register(&mut self, registry: &Registry, token: Token) -> io::Result<()> {
        Source::register(&mut *self.server.lock(), registry, token, Interest::READABLE)
    }

    fn take_all(&mut self) {
        for _ in 0..MAX_TAKEN_AT_ONCE {
            let taken = self.server.lock().receive_request();
            match taken {
                Ok(Some((id, request))) => (self.handler)(id, request),
                Ok(None) => return,
                Err(error) => {
                    let message = format!(
                        "a request cannot be read ({error:?}): its sender uses another definition of the service"
                    );
                    self.diagnostics.warn(&self.name, message);
                }
            }
        }
    }
}
