//! The monotonic clock, which stamps the sensors, and the state of the wall clock.

use super::check::Check;
use super::system::System;
use std::time::Instant;

/// File of the kernel that names its source of time.
const SOURCE_FILE: &str = "/sys/devices/system/clocksource/clocksource0/current_clocksource";
/// Sources that take microseconds to read. Source: Linux, Documentation/timers/timekeeping.rst.
const SLOW_SOURCES: [&str; 3] = ["hpet", "acpi_pm", "jiffies"];
/// Files that show a synchronised wall clock, and those of daemons that keep one.
const SYNCHRONISED: &str = "/run/systemd/timesync/synchronized";
const TIME_DAEMONS: [&str; 3] = ["/run/chrony", "/run/ntpd.pid", "/run/openntpd.pid"];
/// Number of readings that must not go back. Source: ours.
const CLOCK_READINGS: usize = 10_000;

/// Checks of both clocks.
pub fn check(system: &System) -> Vec<Check> {
    vec![monotonic(system), wall(system)]
}

fn monotonic(system: &System) -> Check {
    let topic = "clock";
    let readings: Vec<Instant> = (0..CLOCK_READINGS).map(|_| Instant::now()).collect();
    if !readings.is_sorted() {
        return Check::problem(
            topic,
            "the monotonic clock goes back",
            "boot with clocksource=tsc or replace the kernel",
        );
    }
    let source = system.text(SOURCE_FILE).map(|text| text.trim().to_owned()).filter(|text| !text.is_empty());
    match source {
        Some(source) if SLOW_SOURCES.contains(&source.as_str()) => Check::warning(
            topic,
            format!("the monotonic clock reads {source}, which is slow"),
            "boot with clocksource=tsc",
        ),
        Some(source) => Check::ok(topic, format!("the monotonic clock reads {}", source.escape_debug())),
        None => Check::warning(
            topic,
            "the source of the monotonic clock cannot be read",
            "mount /sys; stamps are right if the clock is",
        ),
    }
}

fn wall(system: &System) -> Check {
    let topic = "wall clock";
    if system.exists(SYNCHRONISED) || TIME_DAEMONS.iter().any(|path| system.exists(path)) {
        return Check::ok(topic, "a time service keeps the wall clock");
    }
    Check::warning(
        topic,
        "no time service is seen, NTP state unknown",
        "sudo timedatectl set-ntp true; only dates of results and stamps of ROS 2 and VDA 5050 depend on it",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;

    #[test]
    fn slow_sources_and_time_services_are_recognised() {
        let folder = tempfile::tempdir().unwrap();
        let system = System::of(folder.path(), &[]);
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path.trim_start_matches('/'));
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        write(SOURCE_FILE, "hpet\n");
        assert!(monotonic(&system).finding.contains("hpet"));
        write(SOURCE_FILE, "arch_sys_counter\n");
        assert_eq!(monotonic(&system).level, CheckLevel::Ok);
        assert_eq!(wall(&system).level, CheckLevel::Warning);
        write(SYNCHRONISED, "");
        assert_eq!(wall(&system).level, CheckLevel::Ok);
    }
}
