//! Two nodes in one process, over the loopback network.
#![allow(clippy::unwrap_used, clippy::new_without_default, reason = "helpers of tests")]

mod actions;
mod body_server;
mod robot;
mod sensors;
mod topics;

use std::sync::atomic::{AtomicU16, Ordering};
use std::time::{Duration, Instant};
use trundle_ros2::node::{Names, Networks, NodeSettings, RosNode};

/// A node in a domain that no other test of this process has.
pub struct Domain(u16);

impl Domain {
    /// The next domain of this process.
    pub fn new() -> Self {
        static NEXT: AtomicU16 = AtomicU16::new(0);
        // Domains 100 to 229: below the system's ephemeral ports, and seldom used.
        let first = std::process::id() as u16 % 40;
        Self(100 + (first * 3 + NEXT.fetch_add(1, Ordering::Relaxed)) % 130)
    }

    /// A node of this name in the domain.
    pub fn node(&self, name: &str) -> RosNode {
        RosNode::new(&NodeSettings::new(Names::of_node(name), self.0, Networks::Loopback)).unwrap()
    }
}

/// Calls `done` every 20 ms until it is true.
pub fn wait_until(what: &str, mut done: impl FnMut() -> bool) {
    let end = Instant::now() + Duration::from_secs(20);
    while !done() {
        assert!(Instant::now() < end, "{what} did not come within 20 s");
        std::thread::sleep(Duration::from_millis(20));
    }
}
