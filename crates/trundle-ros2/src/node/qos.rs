//! Qualities of service by kind of topic, as REP 2003 and Nav2 have them.

use ros2_client::qos::{Durability, History, QosProfile, WhenFull};

/// Readings and images: the newest count, none is sent twice.
pub fn sensor(depth: usize) -> QosProfile {
    QosProfile::default().reliability_best_effort().history(History::KeepLast { depth })
}

/// Every message arrives; a full queue refuses the newest and never delays the sender.
pub fn reliable(depth: usize) -> QosProfile {
    QosProfile::default().reliability_reliable(WhenFull::Fail).history(History::KeepLast { depth })
}

/// As [`reliable`], and a late subscriber receives the last message: maps, static transforms.
pub fn latched() -> QosProfile {
    reliable(1).durability(Durability::TransientLocal)
}
