//! The ticket of a connection.

use crate::fair_queue::ConnectionId;
use crate::pools::Pools;
use std::future::pending;
use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::watch;

/// Longest time from the start of a connection to its first whole request, the start of encryption included. Then the connection is closed.
/// Source: ours; a browser on a slow network takes less than a second.
pub const SILENT_TIMEOUT: Duration = Duration::from_secs(5);

/// The ticket of a connection. Copies are of the same connection, which leaves the pools with the last copy.
#[derive(Debug, Clone)]
pub struct Ticket(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    id: ConnectionId,
    pools: Pools,
    closed: watch::Receiver<bool>,
}

impl Ticket {
    /// The ticket of a new connection of a peer.
    pub(crate) fn new(pools: &Pools, peer: IpAddr) -> Self {
        let (id, closed) = pools.add(peer);
        Self(Arc::new(Inner { id, pools: pools.clone(), closed }))
    }

    /// Reports a whole request: the connection is no longer silent.
    pub fn heard(&self) {
        self.0.pools.hear(self.0.id);
    }

    /// Reports that another list counts the connection, as a list of viewers: no limit of the pools closes it.
    pub fn leave(&self) {
        self.0.pools.remove(self.0.id);
    }

    /// Waits until the connection has to close in favour of another one.
    pub async fn closed(&self) {
        let mut closed = self.0.closed.clone();
        if closed.wait_for(|is_closed| *is_closed).await.is_err() {
            // The connection has left the pools.
            pending().await
        }
    }

    /// Waits until the connection has been silent for too long.
    pub(crate) async fn silent_too_long(&self) {
        tokio::time::sleep(SILENT_TIMEOUT).await;
        if !self.0.pools.is_silent(self.0.id) {
            pending().await
        }
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.pools.remove(self.id);
    }
}
