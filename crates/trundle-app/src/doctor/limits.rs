//! Limits of the process that matter in real time: priority and locked memory.

use super::check::Check;
use super::system::System;

/// Locked memory below which a control process does not fit \[bytes\]. Source: `docs/how-to/small-computer.md`, the robot's memory.
const MIN_LOCKED_BYTES: u64 = 512 << 20;

/// Checks of the limits.
pub fn check(system: &System) -> Vec<Check> {
    let text = system.text("/proc/self/limits").unwrap_or_default();
    vec![priority(soft_limit(&text, "Max realtime priority")), locked(soft_limit(&text, "Max locked memory"))]
}

fn priority(limit: Option<u64>) -> Check {
    let topic = "priority";
    match limit {
        None => unread(topic),
        Some(0) => Check::warning(
            topic,
            "no right to real-time scheduling (rtprio 0), which trundle does not need",
            "for `chrt -f 10 trundle run`: `@dialout - rtprio 20` in /etc/security/limits.d/trundle.conf",
        ),
        Some(priority) => Check::ok(topic, format!("real-time priorities up to {priority} are allowed")),
    }
}

fn locked(limit: Option<u64>) -> Check {
    let topic = "locked memory";
    match limit {
        None => unread(topic),
        Some(bytes) if bytes < MIN_LOCKED_BYTES => Check::warning(
            topic,
            format!("{} MB may be locked, expected {} MB or more", bytes >> 20, MIN_LOCKED_BYTES >> 20),
            "`@dialout - memlock unlimited` in /etc/security/limits.d/trundle.conf, or switch swap off",
        ),
        Some(u64::MAX) => Check::ok(topic, "all memory may be locked"),
        Some(bytes) => Check::ok(topic, format!("{} MB may be locked", bytes >> 20)),
    }
}

fn unread(topic: &'static str) -> Check {
    Check::warning(
        topic,
        "/proc/self/limits does not list the limit; locked memory and priority unknown",
        "mount /proc",
    )
}

/// The soft limit of a line; `u64::MAX` is unlimited.
fn soft_limit(text: &str, name: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?;
    if value == "unlimited" { Some(u64::MAX) } else { value.parse().ok() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;

    #[test]
    fn limits_are_read() {
        let text = "Limit                     Soft Limit           Hard Limit           Units\n\
                    Max locked memory         8388608              unlimited            bytes\n\
                    Max realtime priority     95                   99\n";
        assert_eq!(soft_limit(text, "Max locked memory"), Some(8 << 20));
        assert_eq!(soft_limit("Max locked memory unlimited x", "Max locked memory"), Some(u64::MAX));
        assert_eq!(soft_limit(text, "Max nice priority"), None);
        assert_eq!(locked(Some(8 << 20)).level, CheckLevel::Warning);
        assert_eq!(priority(Some(95)).level, CheckLevel::Ok);
        assert_eq!(priority(Some(0)).level, CheckLevel::Warning);
    }
}
