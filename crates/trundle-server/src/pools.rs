//! The connections of a server that no list of viewers counts.

use crate::fair_queue::{Connection, ConnectionId, FairQueue};
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;

/// Maximum number of silent connections. A further one closes the oldest of the peer that has the most. Source: ours; eight browsers open at
/// most 6 connections each.
pub const MAX_SILENT: usize = 48;
/// Maximum number of heard connections. A further one closes the oldest of the peer that has the most. Source: ours, as many as silent ones.
pub const MAX_HEARD: usize = 48;

/// Silent and heard connections.
#[derive(Debug, Default)]
struct Queues {
    silent: FairQueue,
    heard: FairQueue,
    last_id: ConnectionId,
}

/// Silent and heard connections, shared by their tickets.
#[derive(Debug, Default, Clone)]
pub struct Pools(Arc<Mutex<Queues>>);

impl Pools {
    /// Adds a silent connection of a peer; its number, and the notice that it has to close.
    pub fn add(&self, peer: IpAddr) -> (ConnectionId, watch::Receiver<bool>) {
        let (close, closed) = watch::channel(false);
        let mut queues = self.queues();
        queues.last_id += 1;
        let id = queues.last_id;
        let connection = Connection { id, peer: peer.to_canonical(), close };
        close_now(queues.silent.push(connection, MAX_SILENT));
        (id, closed)
    }

    /// Makes a connection the newest of the heard ones.
    pub fn hear(&self, id: ConnectionId) {
        let mut queues = self.queues();
        let known = queues.silent.remove(id).or_else(|| queues.heard.remove(id));
        if let Some(connection) = known {
            close_now(queues.heard.push(connection, MAX_HEARD));
        }
    }

    /// Closes the oldest silent connection of the peer that has the most.
    pub fn close_silent(&self) {
        close_now(self.queues().silent.remove_oldest(None));
    }

    /// Whether a connection is silent.
    pub fn is_silent(&self, id: ConnectionId) -> bool {
        self.queues().silent.contains(id)
    }

    /// Forgets a connection without closing it.
    pub fn remove(&self, id: ConnectionId) {
        let mut queues = self.queues();
        if queues.silent.remove(id).is_none() {
            queues.heard.remove(id);
        }
    }

    fn queues(&self) -> MutexGuard<'_, Queues> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn close_now(connection: Option<Connection>) {
    if let Some(Connection { close, .. }) = connection {
        close.send_replace(true);
    }
}
