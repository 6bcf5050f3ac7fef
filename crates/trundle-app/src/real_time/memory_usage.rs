//! Resident memory of the program over time.

use serde::Serialize;

/// Resident memory of the program over time.
#[derive(Debug, Clone, Default, Serialize)]
pub struct MemoryUsage {
    /// Seconds since the start, MB.
    pub samples: Vec<(f64, f64)>,
}

/// Time between two samples \[s\]. Source: ours.
const SAMPLE_PERIOD_S: f64 = 5.0;

impl MemoryUsage {
    /// Takes a sample if one is due.
    pub fn sample(&mut self, time: f64) {
        if self.samples.last().is_none_or(|(last, _)| time - last >= SAMPLE_PERIOD_S) {
            self.samples.extend(resident_mb().map(|mb| (time, mb)));
        }
    }

    /// Growth since `begin` (s), the slope of a fitted straight line, MB per hour; `None` for less than half a minute.
    pub fn growth_mb_an_hour(&self, begin: f64) -> Option<f64> {
        let end = self.samples.last()?.0;
        let late: Vec<_> = self.samples.iter().filter(|(time, _)| *time >= begin).collect();
        let n = late.len() as f64;
        let (t, m) = late.iter().fold((0.0, 0.0), |(t, m), (time, mb)| (t + time / n, m + mb / n));
        let spread: f64 = late.iter().map(|(time, _)| (time - t).powi(2)).sum();
        let together: f64 = late.iter().map(|(time, mb)| (time - t) * (mb - m)).sum();
        (end - begin >= 30.0 && spread > 0.0).then(|| together / spread * 3600.0)
    }
}

/// Resident memory from `/proc/self/status`, MB; `None` on systems other than Linux.
fn resident_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_that_after_the_beginning() {
        let mb = |i: u32| if i < 60 { f64::from(i) } else { 60.0 + 0.01 * f64::from(i - 60) };
        let curve = MemoryUsage { samples: (0..=120).map(|i| (f64::from(i) * 10.0, mb(i))).collect() };
        assert!((curve.growth_mb_an_hour(600.0).unwrap() - 3.6).abs() < 1e-9);
        assert_eq!(MemoryUsage::default().growth_mb_an_hour(0.0), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_program_has_some() {
        assert!(resident_mb().unwrap() > 0.5);
    }
}
