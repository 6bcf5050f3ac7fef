//! The people who drive the robot by hand, and which of them a stop bars.

use std::time::{Duration, Instant};
use trundle_core::Twist2;
use trundle_runtime::TELEOP_SILENCE_S;

/// Silence that ends driving by hand: [`TELEOP_SILENCE_S`].
const RELEASE_SILENCE: Duration = Duration::from_millis((TELEOP_SILENCE_S * 1000.0) as u64);

/// A person who may drive by hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum HandId {
    /// The viewer of a page, by its number.
    Viewer(u64),
    /// Those who send twists by a topic of ROS 2.
    Topic,
}

/// Those who drive now.
#[derive(Debug, Default)]
pub(super) struct Hands(Vec<Hand>);

#[derive(Debug)]
struct Hand {
    id: HandId,
    /// Time of the last twist.
    last: Instant,
    /// Whether a stop came while this person drove.
    is_barred: bool,
}

impl Hands {
    /// Notes a twist; returns whether a stop bars it. A zero twist or a silence is a release.
    pub(super) fn note(&mut self, id: HandId, twist: Twist2, now: Instant) -> bool {
        self.forget_silent(now);
        if twist == Twist2::ZERO {
            self.0.retain(|hand| hand.id != id);
            return false;
        }
        if let Some(hand) = self.0.iter_mut().find(|hand| hand.id == id) {
            hand.last = now;
            return hand.is_barred;
        }
        self.0.push(Hand { id, last: now, is_barred: false });
        false
    }

    /// Bars all who drive; returns whether anybody does.
    pub(super) fn bar(&mut self, now: Instant) -> bool {
        self.forget_silent(now);
        self.0.iter_mut().for_each(|hand| hand.is_barred = true);
        !self.0.is_empty()
    }

    fn forget_silent(&mut self, now: Instant) {
        self.0.retain(|hand| now.saturating_duration_since(hand.last) <= RELEASE_SILENCE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVE: Twist2 = Twist2::new(0.3, 0.0);

    #[test]
    fn a_hand_that_goes_on_stays_barred_and_silence_releases_it() {
        let (mut hands, id, start) = (Hands::default(), HandId::Viewer(7), Instant::now());
        let at = |ms| start + Duration::from_millis(ms);
        assert!(!hands.bar(start), "nobody drives");
        assert!(!hands.note(id, DRIVE, start));
        assert!(hands.bar(at(100)));
        assert!([300, 550, 800].iter().all(|ms| hands.note(id, DRIVE, at(*ms))), "a held key is no release");
        assert!(!hands.note(HandId::Topic, DRIVE, at(800)), "another person");
        assert!(!hands.note(id, DRIVE, at(1101)), "silence is a release");
        assert!(hands.bar(at(1200)));
        assert!(!hands.note(id, Twist2::ZERO, at(1210)) && !hands.note(id, DRIVE, at(1220)));
    }

    #[test]
    fn those_who_are_silent_take_no_memory() {
        let (mut hands, start) = (Hands::default(), Instant::now());
        for i in 0..1000 {
            hands.note(HandId::Viewer(i), DRIVE, start + Duration::from_millis(10 * i));
        }
        assert!(hands.0.len() <= 31, "{}", hands.0.len());
    }
}
