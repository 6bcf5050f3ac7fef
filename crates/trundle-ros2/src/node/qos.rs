//! Qualities of service by kind of topic, as REP 2003 and Nav2 have them.

use ros2_client::qos::{Durability, History, QosProfile, WhenFull};

/// Subscribers of readings, and publishers of images: the newest count, none is sent twice. It reads reliable publishers too.
pub fn sensor(depth: usize) -> QosProfile {
    QosProfile::default().reliability_best_effort().history(History::KeepLast { depth })
}

/// Publishers of readings, commands and states \[REP 2003\]: every message arrives at reliable readers, the others get what is not lost. A
/// full queue refuses the newest and never delays the sender.
pub fn reliable(depth: usize) -> QosProfile {
    QosProfile::default().reliability_reliable(WhenFull::Fail).history(History::KeepLast { depth })
}

/// As [`reliable`], and a late subscriber receives the last message: maps, static transforms.
pub fn latched() -> QosProfile {
    reliable(1).durability(Durability::TransientLocal)
}
