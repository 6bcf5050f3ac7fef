//! The check of a computer before the first drive: processor, clock, rights, disk, devices, ROS 2 and limits, each with its remedy.
//!
//! ```
//! use trundle_app::doctor::{CheckLevel, System, examine};
//!
//! let report = examine(&System::this_computer(), std::path::Path::new("out"));
//! assert!(report.checks.iter().all(|check| check.level == CheckLevel::Ok || check.remedy.is_some()));
//! ```

mod cgroup;
mod check;
mod clock;
mod devices;
mod disk;
mod limits;
mod processor;
mod rights;
mod ros;
mod system;

pub use check::{Check, CheckLevel};
pub use system::System;

use crate::aligned_table;
use serde::Serialize;
use std::path::Path;

/// All checks of a computer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct DoctorReport {
    /// The checks, by topic.
    pub checks: Vec<Check>,
}

impl DoctorReport {
    /// Number of checks of a level.
    #[must_use]
    pub fn count(&self, level: CheckLevel) -> usize {
        self.checks.iter().filter(|check| check.level == level).count()
    }

    /// Whether there is no problem.
    #[must_use]
    pub fn is_well(&self) -> bool {
        self.count(CheckLevel::Problem) == 0
    }

    /// The checks as a table: level, topic, finding with remedy; then the number of problems and warnings.
    #[must_use]
    pub fn text(&self) -> String {
        let mut lines = aligned_table(&self.checks.iter().map(Check::row).collect::<Vec<_>>());
        let (problems, warnings) = (self.count(CheckLevel::Problem), self.count(CheckLevel::Warning));
        lines.push(format!("{}, {}", counted(problems, "problem"), counted(warnings, "warning")));
        lines.join("\n")
    }

    /// The checks as JSON, with the number of problems and warnings.
    #[must_use]
    pub fn json(&self) -> String {
        let (problems, warnings) = (self.count(CheckLevel::Problem), self.count(CheckLevel::Warning));
        let value = serde_json::json!({ "problems": problems, "warnings": warnings, "checks": self.checks });
        format!("{value:#}")
    }
}

/// A number of things in words: "1 problem", "2 problems".
fn counted(count: usize, name: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {name}{plural}")
}

/// Checks a computer; `output` is the folder that runs write to, which need not exist.
#[must_use]
pub fn examine(system: &System, output: &Path) -> DoctorReport {
    let parts = [
        processor::check(system),
        clock::check(system),
        rights::check(system),
        disk::check(output),
        devices::check(),
        ros::check(system),
        limits::check(system),
        cgroup::check(system),
    ];
    DoctorReport { checks: parts.concat() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks of a system whose files all hold `text`, or are absent.
    fn broken(text: Option<&[u8]>) -> Vec<Check> {
        let folder = tempfile::tempdir().unwrap();
        for path in text.map_or(&[][..], |_| &system::FILES) {
            let path = folder.path().join(path.trim_start_matches('/'));
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text.unwrap_or_default()).unwrap();
        }
        let system = System::of(folder.path(), &[]);
        [processor::check, clock::check, rights::check, limits::check, cgroup::check]
            .map(|f| f(&system))
            .concat()
    }

    #[test]
    fn numbers_of_findings_agree_with_their_words() {
        let check = |level| Check { level, ..Check::ok("disk", "") };
        let last = |levels: &[CheckLevel]| {
            let checks = levels.iter().map(|level| check(*level)).collect();
            DoctorReport { checks }.text().lines().last().unwrap().to_owned()
        };
        let (problem, warning) = (CheckLevel::Problem, CheckLevel::Warning);
        assert_eq!(last(&[problem, warning, warning]), "1 problem, 2 warnings");
        assert_eq!(last(&[problem, problem, warning]), "2 problems, 1 warning");
        assert_eq!(last(&[CheckLevel::Ok]), "0 problems, 0 warnings");
    }

    #[test]
    fn absent_and_wrong_files_are_warnings() {
        let texts: [Option<&[u8]>; 4] = [
            None,
            Some(b""),
            Some(b"\xff\xfe\0 : -1 max 18446744073709551616\n"),
            Some(b"Groups: x\nflags\n"),
        ];
        for text in texts {
            let checks = broken(text);
            assert!(checks.len() >= 9, "{checks:?}");
            assert!(checks.iter().all(|check| check.level != CheckLevel::Problem), "{text:?}: {checks:?}");
            assert!(checks.iter().any(|check| check.level == CheckLevel::Warning), "{text:?}: {checks:?}");
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_computer_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let report = examine(&System::this_computer(), folder.path());
        let of = |topic: &str| report.checks.iter().find(|check| check.topic == topic).unwrap();
        assert!(of("processor").finding.contains("core"), "{report:?}");
        assert!(of("clock").finding.contains("monotonic"), "{report:?}");
        assert!(of("locked memory").finding.contains("locked"), "{report:?}");
        assert_ne!(of("disk").level, CheckLevel::Problem, "{report:?}");
        let json: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(json["checks"].as_array().unwrap().len(), report.checks.len());
    }
}
