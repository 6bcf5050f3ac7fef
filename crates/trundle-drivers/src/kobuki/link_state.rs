//! The state of a base's link: up or down, since when, and when the port is opened again.

use super::stream_check::WINDOW_PACKETS;
use std::{fmt, io};
use trundle_core::Stamp;

/// Packets without a gap that bring a link up after a silence: 3. Source: ours; a base that sends too slowly would else lose and regain the
/// link with each packet.
const MIN_STEADY_PACKETS: u32 = 3;

/// Reason for the loss of a link. The reason decides how many packets without a gap bring the link up again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Loss {
    /// The port broke.
    Broken,
    /// No new packet came.
    Silence,
    /// Two bases send on the port, or another one than the run's.
    OtherBase,
}

impl Loss {
    const fn needed_packets(self) -> u32 {
        match self {
            Self::Broken => 1,
            Self::Silence => MIN_STEADY_PACKETS,
            Self::OtherBase => WINDOW_PACKETS as u32,
        }
    }
}

/// A lost link, with the reason in words.
#[derive(Debug)]
pub(super) struct LostLink {
    pub(super) loss: Loss,
    reason: String,
}

impl LostLink {
    pub(super) fn new(loss: Loss, reason: impl fmt::Display) -> Self {
        Self { loss, reason: reason.to_string() }
    }
}

impl fmt::Display for LostLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}

impl From<io::Error> for LostLink {
    fn from(error: io::Error) -> Self {
        let is_silence = error.kind() == io::ErrorKind::TimedOut;
        Self::new(if is_silence { Loss::Silence } else { Loss::Broken }, error)
    }
}

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

    /// Records the loss of the link.
    pub(super) fn lose(&mut self, now: Stamp, loss: Loss) {
        (self.is_up, self.since, self.steady) = (false, now, 0);
        self.needed = loss.needed_packets();
    }

    /// Counts the packets of a link that is down from zero again: two bases still send on the port.
    pub(super) fn restart_count(&mut self) {
        self.steady = 0;
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
        link.lose(at(700), Loss::Silence);
        let slow: Vec<bool> = (0..20).map(|i| link.on_packet(at(900 + 200 * i), 0.1)).collect();
        assert!(!slow.contains(&true), "5 Hz");
        let steady: Vec<bool> = (0..4).map(|i| link.on_packet(at(9000 + 20 * i), 0.1)).collect();
        assert_eq!(steady, [false, false, true, true]);
        link.lose(at(9100), Loss::Broken);
        assert!(link.on_packet(at(9500), 0.1), "the port broke, and the base sends");
    }
    #[test]
    fn after_two_bases_a_window_of_packets_of_one_is_needed() {
        let mut link = LinkState::new(at(0), 0.1);
        link.lose(at(0), Loss::OtherBase);
        let packets = |link: &mut LinkState, from: i64| {
            (from..).position(|i| link.on_packet(at(20 * i), 0.1)).unwrap() as i64
        };
        (0..30).for_each(|i| assert!(!link.on_packet(at(20 * i), 0.1)));
        link.restart_count();
        assert_eq!(packets(&mut link, 30), 49);
    }
}
