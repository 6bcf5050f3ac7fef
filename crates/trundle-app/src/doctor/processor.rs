//! Processor and memory.

use super::check::Check;
use super::system::System;

/// Flags of the instructions that the kernels use, of x86-64 and of aarch64. Source: the kernels of vision, grid and mapping.
const VECTOR_FLAGS: [&str; 2] = ["avx2", "asimd"];
/// Minimum number of cores at which the control thread has a core of its own. Source: `trundle_app::real_time`.
const MIN_CORES: usize = 2;
/// Available memory below which a run may not fit \[MB\]. Source: `docs/how-to/small-computer.md`, twice the robot's memory and a map's.
const MIN_AVAILABLE_MB: u64 = 500;

/// Checks of the processor and the memory.
pub fn check(system: &System) -> Vec<Check> {
    vec![processor(system), memory(system)]
}

fn processor(system: &System) -> Check {
    let topic = "processor";
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let text = system.text("/proc/cpuinfo").unwrap_or_default();
    let flags: Vec<&str> = text.lines().find_map(flags).unwrap_or_default();
    let found = VECTOR_FLAGS.into_iter().find(|flag| flags.contains(flag));
    match found {
        _ if cores < MIN_CORES => Check::warning(
            topic,
            format!("{cores} core, expected {MIN_CORES} or more for runs in real time"),
            "give the program more cores",
        ),
        Some(flag) => Check::ok(topic, format!("{cores} cores with {flag}")),
        None if flags.is_empty() => Check::warning(
            topic,
            format!("{cores} cores; /proc/cpuinfo lists no flags"),
            "mount /proc; without AVX2 or NEON the maps are drawn more slowly",
        ),
        None => Check::warning(
            topic,
            format!("{cores} cores without AVX2 and NEON"),
            "the results are the same, drawing maps takes longer: use a newer processor",
        ),
    }
}

/// The flags of a line of `/proc/cpuinfo`, if it lists them.
fn flags(line: &str) -> Option<Vec<&str>> {
    let (name, values) = line.split_once(':')?;
    ["flags", "Features"].contains(&name.trim()).then(|| values.split_whitespace().collect())
}

fn memory(system: &System) -> Check {
    let topic = "memory";
    let text = system.text("/proc/meminfo").unwrap_or_default();
    match text.lines().find_map(available_mb) {
        Some(mb) if mb < MIN_AVAILABLE_MB => Check::warning(
            topic,
            format!("{mb} MB are available, expected {MIN_AVAILABLE_MB} MB or more"),
            "end other programs",
        ),
        Some(mb) => Check::ok(topic, format!("{mb} MB are available")),
        None => Check::warning(topic, "/proc/meminfo does not list the available memory", "mount /proc"),
    }
}

/// Available memory of a line of `/proc/meminfo` \[MB\].
fn available_mb(line: &str) -> Option<u64> {
    let kilobytes = line.strip_prefix("MemAvailable:")?.split_whitespace().next()?;
    kilobytes.parse::<u64>().ok().map(|kilobytes| kilobytes / 1000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_and_memory_are_read() {
        assert_eq!(flags("flags\t\t: fpu avx2"), Some(vec!["fpu", "avx2"]));
        assert_eq!(flags("Features\t: fp asimd"), Some(vec!["fp", "asimd"]));
        assert_eq!(flags("model name : flags"), None);
        assert_eq!(available_mb("MemAvailable:    2048000 kB"), Some(2048));
        assert_eq!(available_mb("MemAvailable:    much"), None);
    }
}
