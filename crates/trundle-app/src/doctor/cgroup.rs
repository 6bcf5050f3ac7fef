//! Limits of the control group: memory and processor time of a container or a service.

use super::check::Check;
use super::system::System;

/// Memory limit below which a run may not fit \[MB\]. Source: as for available memory.
const MIN_MEMORY_MB: u64 = 500;
/// Limits of version 1 above this mean none \[bytes\]. Source: Linux, the page counter's maximum is near 2^63.
const NO_LIMIT_BYTES: u64 = 1 << 60;

/// Checks of the group's memory and processor time.
pub fn check(system: &System) -> Vec<Check> {
    let groups = system.text("/proc/self/cgroup").unwrap_or_default();
    vec![memory(system, &groups), processor(system, &groups)]
}

fn memory(system: &System, groups: &str) -> Check {
    let topic = "cgroup memory";
    let text = read(system, groups, "", "memory.max")
        .or_else(|| read(system, groups, "memory", "memory.limit_in_bytes"));
    match text.as_deref().map(|text| (text, text.parse::<u64>())) {
        Some(("max", _)) => Check::ok(topic, "no limit"),
        Some((_, Ok(bytes))) if bytes > NO_LIMIT_BYTES => Check::ok(topic, "no limit"),
        Some((_, Ok(bytes))) if bytes / 1_000_000 < MIN_MEMORY_MB => Check::warning(
            topic,
            format!("at most {} MB, expected {MIN_MEMORY_MB} MB or more", bytes / 1_000_000),
            "MemoryMax= of the service, or --memory of the container",
        ),
        Some((_, Ok(bytes))) => Check::ok(topic, format!("at most {} MB", bytes / 1_000_000)),
        _ => unread(topic),
    }
}

fn processor(system: &System, groups: &str) -> Check {
    let topic = "cgroup cpu";
    match cores(system, groups) {
        Some(cores) if cores < 1.0 => Check::warning(
            topic,
            format!("at most {cores:.2} cores, expected 1 or more for runs in real time"),
            "CPUQuota= of the service, or --cpus of the container",
        ),
        Some(cores) if cores.is_infinite() => Check::ok(topic, "no limit"),
        Some(cores) => Check::ok(topic, format!("at most {cores:.2} cores")),
        None => unread(topic),
    }
}

/// Processor time that the group may use at most, in cores; infinite without a limit, `None` if unknown.
fn cores(system: &System, groups: &str) -> Option<f64> {
    let text = read(system, groups, "", "cpu.max").or_else(|| {
        let part = |file| read(system, groups, "cpu", file);
        Some(format!("{} {}", part("cpu.cfs_quota_us")?, part("cpu.cfs_period_us")?))
    })?;
    let (quota, period) = text.split_once(' ')?;
    if ["max", "-1"].contains(&quota) {
        return Some(f64::INFINITY);
    }
    let (quota, period): (f64, f64) = (quota.parse().ok()?, period.parse().ok()?);
    (quota > 0.0 && period > 0.0).then_some(quota / period)
}

/// A file of the group that contains this process; in a container the group may be the root of the mounted folder. `controller` is empty
/// for version 2.
fn read(system: &System, groups: &str, controller: &str, file: &str) -> Option<String> {
    let group = groups.lines().find_map(|line| group(line, controller))?;
    let folder = if controller.is_empty() { String::new() } else { format!("{controller}/") };
    let paths = [format!("/sys/fs/cgroup/{folder}{group}/{file}"), format!("/sys/fs/cgroup/{folder}{file}")];
    paths.iter().find_map(|path| system.text(path)).map(|text| text.trim().to_owned())
}

/// Path of the group, if the line of `/proc/self/cgroup` is the controller's.
fn group<'a>(line: &'a str, controller: &str) -> Option<&'a str> {
    let mut fields = line.splitn(3, ':');
    let names = fields.nth(1)?;
    names
        .split(',')
        .any(|name| name == controller)
        .then(|| fields.next())
        .flatten()
        .map(|path| path.trim_matches('/'))
}

fn unread(topic: &'static str) -> Check {
    Check::warning(
        topic,
        "the limit cannot be read",
        "mount /sys/fs/cgroup; without a container there is none",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;

    /// The checks of a system with these files.
    fn checks(files: &[(&str, &str)]) -> Vec<Check> {
        let folder = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        check(&System::of(folder.path(), &[]))
    }

    #[test]
    fn limits_of_both_versions_are_read() {
        let two = checks(&[
            ("proc/self/cgroup", "0::/system.slice/trundle.service\n"),
            ("sys/fs/cgroup/system.slice/trundle.service/memory.max", "100000000\n"),
            ("sys/fs/cgroup/cpu.max", "max 100000\n"),
        ]);
        assert_eq!(two[0].finding, "at most 100 MB, expected 500 MB or more");
        assert_eq!((two[0].level, two[1].finding.as_str()), (CheckLevel::Warning, "no limit"));
        let one = checks(&[
            ("proc/self/cgroup", "4:memory:/x\n1:cpu,cpuacct:/\n0::/\n"),
            ("sys/fs/cgroup/memory/x/memory.limit_in_bytes", "9223372036854771712\n"),
            ("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "50000\n"),
            ("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n"),
        ]);
        assert_eq!(one[0].finding, "no limit");
        assert!(one[1].level == CheckLevel::Warning && one[1].finding.starts_with("at most 0.50 cores"));
    }
}
