//! The state of a base's link: up or down, since when, and when the port is opened again.

use trundle_core::Stamp;

/// Packets without a gap that bring a link up after a silence: 3. Source: ours; a base that sends too slowly would else lose and regain the
/// link with each packet.
const MIN_STEADY_PACKETS: u32 = 3;

/// The state of a link.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinkState {
    pub(super) is_up: bool,
    /// Last packet, or opening of the port, or loss.
    pub(super) since: Stamp,
    /// Wait before the next attempt to open the port \[s\].
    pub(super) retry_s: f64,
    /// Packets without a gap so far.
    steady: u32,
    /// Packets without a gap that bring the link up.
    needed: u32,
}

impl LinkState {
    /// A link whose port was opened at `now`.
    pub(super) fn new(now: Stamp, retry_s: f64) -> Self {
        Self { is_up: false, since: now, retry_s, steady: 0, needed: 1 }
    }

    /// Records the arrival of a packet. A gap is longer than `max_gap_s`. Returns whether the packet brings the link up.
    pub(super) fn on_packet(&mut self, arrival: Stamp, max_gap_s: f64) -> bool {
        let is_steady = arrival - self.since < max_gap_s;
        self.since = arrival;
        self.steady = if is_steady { self.steady.saturating_add(1) } else { 1 };
        !self.is_up && self.steady >= self.needed
    }

    /// Records the loss of the link; after a silence the next link needs steady packets.
    pub(super) fn lose(&mut self, now: Stamp, is_silence: bool) {
        (self.is_up, self.since, self.steady) = (false, now, 0);
        self.needed = if is_silence { MIN_STEADY_PACKETS } else { 1 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn after_a_silence_only_steady_packets_bring_the_link_up() {
        let mut link = LinkState::new(at(0), 0.1);
        assert!(link.on_packet(at(500), 0.1), "the start has read packets");
        link.is_up = true;
        link.lose(at(700), true);
        let slow: Vec<bool> = (0..20).map(|i| link.on_packet(at(900 + 200 * i), 0.1)).collect();
        assert!(!slow.contains(&true), "5 Hz");
        let steady: Vec<bool> = (0..4).map(|i| link.on_packet(at(9000 + 20 * i), 0.1)).collect();
        assert_eq!(steady, [false, false, true, true]);
        link.lose(at(9100), false);
        assert!(link.on_packet(at(9500), 0.1), "the port broke, and the base sends");
    }
}
