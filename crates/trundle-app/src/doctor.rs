//! The check of a computer before the first drive: processor, clock, rights, disk, devices, ROS 2 and limits, each with its remedy.
//!
//! ```
//! use trundle_app::doctor::{Level, System, examine};
//!
//! let report = examine(&System::this_computer(), std::path::Path::new("out"));
//! assert!(report.checks.iter().all(|check| check.level == Level::Ok || check.remedy.is_some()));
//! ```

mod cgroup;
mod clock;
mod devices;
mod disk;
mod limits;
mod processor;
mod rights;
mod ros;
mod system;

pub use system::System;

use serde::Serialize;
use std::path::Path;

/// Result of one check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Check {
    /// The checked thing, in two words at most.
    pub topic: &'static str,
    /// Level of the finding.
    pub level: Level,
    /// The finding, in words.
    pub finding: String,
    /// The remedy, in words or as a command; `None` if all is well.
    pub remedy: Option<String>,
}

/// Level of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// All is well.
    Ok,
    /// Some uses of the program are slower or not possible.
    Warning,
    /// The program cannot do its work.
    Problem,
}

impl Level {
    /// The level's word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Warning => "warning",
            Self::Problem => "problem",
        }
    }
}

/// All checks of a computer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct DoctorReport {
    /// The checks, by topic.
    pub checks: Vec<Check>,
}

impl DoctorReport {
    /// Number of checks of a level.
    #[must_use]
    pub fn count(&self, level: Level) -> usize {
        self.checks.iter().filter(|check| check.level == level).count()
    }

    /// The checks, a row each: level, topic, finding with remedy.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        self.checks.iter().map(Check::row).collect()
    }

    /// The checks as JSON, with the number of problems and warnings.
    #[must_use]
    pub fn json(&self) -> String {
        let (problems, warnings) = (self.count(Level::Problem), self.count(Level::Warning));
        let value = serde_json::json!({ "problems": problems, "warnings": warnings, "checks": self.checks });
        format!("{value:#}")
    }
}

impl Check {
    fn ok(topic: &'static str, finding: impl Into<String>) -> Self {
        Self { topic, level: Level::Ok, finding: finding.into(), remedy: None }
    }

    fn warning(topic: &'static str, finding: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { topic, level: Level::Warning, finding: finding.into(), remedy: Some(remedy.into()) }
    }

    fn problem(topic: &'static str, finding: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { level: Level::Problem, ..Self::warning(topic, finding, remedy) }
    }

    fn row(&self) -> Vec<String> {
        let remedy = self.remedy.as_ref().map_or_else(String::new, |remedy| format!(": {remedy}"));
        vec![self.level.word().to_owned(), self.topic.to_owned(), format!("{}{remedy}", self.finding)]
    }
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
            assert!(checks.iter().all(|check| check.level != Level::Problem), "{text:?}: {checks:?}");
            assert!(checks.iter().any(|check| check.level == Level::Warning), "{text:?}: {checks:?}");
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
        assert_ne!(of("disk").level, Level::Problem, "{report:?}");
        let json: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(json["checks"].as_array().unwrap().len(), report.checks.len());
    }

    #[test]
    fn rows_have_level_topic_and_remedy() {
        let row = Check::problem("disk", "1 MB are free", "free some").row();
        assert_eq!(row, ["problem", "disk", "1 MB are free: free some"]);
        assert_eq!(Check::ok("disk", "9 GB are free").row()[2], "9 GB are free");
    }
}
