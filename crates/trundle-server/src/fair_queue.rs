//! Connections of several peers, and the one that is closed beyond a limit.

use std::net::IpAddr;
use tokio::sync::watch;

/// Number of a connection.
pub type ConnectionId = u64;

/// A connection of a queue.
#[derive(Debug)]
pub struct Connection {
    /// Number of the connection.
    pub id: ConnectionId,
    /// Address of the other end.
    pub peer: IpAddr,
    /// Whether the connection has to close.
    pub close: watch::Sender<bool>,
}

/// Connections, the oldest first.
#[derive(Debug, Default)]
pub struct FairQueue(Vec<Connection>);

impl FairQueue {
    /// Adds a connection. If `max` others are in the queue, one of them is removed and returned: the oldest of the peer that has the most
    /// connections, the new one included. Among equal peers it is the oldest connection.
    pub fn push(&mut self, new: Connection, max: usize) -> Option<Connection> {
        let removed = if self.0.len() < max { None } else { self.remove_oldest(Some(new.peer)) };
        self.0.push(new);
        removed
    }

    /// Removes the oldest connection of the peer that has the most; `newcomer` is the peer of one more connection.
    pub fn remove_oldest(&mut self, newcomer: Option<IpAddr>) -> Option<Connection> {
        let count = |peer| {
            let queued = self.0.iter().filter(|connection| connection.peer == peer).count();
            queued + usize::from(newcomer == Some(peer))
        };
        // Of equal maxima `max_by_key` returns the last, which in reverse order is the oldest.
        let oldest = (0..self.0.len()).rev().max_by_key(|&i| count(self.0[i].peer))?;
        Some(self.0.remove(oldest))
    }

    /// Removes a connection.
    pub fn remove(&mut self, id: ConnectionId) -> Option<Connection> {
        let index = self.0.iter().position(|connection| connection.id == id)?;
        Some(self.0.remove(index))
    }

    /// Whether a connection is in the queue.
    pub fn contains(&self, id: ConnectionId) -> bool {
        self.0.iter().any(|connection| connection.id == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of the connections that are closed when peers with these last bytes connect in turn.
    fn closed(peers: &[u8], max: usize) -> Vec<ConnectionId> {
        let mut queue = FairQueue::default();
        let add = |(id, &peer): (usize, &u8)| {
            let peer = IpAddr::from([192, 168, 1, peer]);
            queue.push(Connection { id: id as u64, peer, close: watch::Sender::default() }, max)
        };
        peers.iter().enumerate().filter_map(add).map(|closed| closed.id).collect()
    }

    #[test]
    fn the_peer_with_the_most_connections_closes_its_oldest() {
        assert_eq!(closed(&[1, 1, 1, 1, 1], 3), [0, 1], "one peer alone");
        assert_eq!(closed(&[2, 1, 1, 1, 1], 3), [1, 2], "the other peer came first and stays");
        assert_eq!(closed(&[1, 1, 1, 2, 2], 3), [0, 1], "a newcomer closes none of its own");
        assert_eq!(closed(&[1, 2, 3, 4], 3), [0], "of equal peers the oldest goes");
    }

    #[test]
    fn a_peer_with_one_connection_stays_through_any_number_of_another() {
        let mut peers = vec![7];
        peers.extend([1; 500]);
        assert!(!closed(&peers, 48).contains(&0));
    }

    #[test]
    fn the_new_connection_counts_for_its_peer() {
        // Two of each peer, and a third of peer 2: its own oldest goes, not the oldest of all.
        assert_eq!(closed(&[1, 1, 2, 2, 2], 4), [2]);
    }
}
