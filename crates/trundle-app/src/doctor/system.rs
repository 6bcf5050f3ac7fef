//! Files and variables that the checks read, of this computer or of a folder that represents a computer.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that the checks read.
#[cfg(test)]
pub const FILES: [&str; 8] = [
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/proc/self/status",
    "/proc/self/limits",
    "/proc/self/cgroup",
    "/sys/devices/system/clocksource/clocksource0/current_clocksource",
    "/etc/group",
    "/etc/udev/rules.d/60-trundle.rules",
];

/// A computer: its files and the variables of its environment.
#[derive(Debug, Clone)]
pub struct System {
    root: PathBuf,
    variables: BTreeMap<String, String>,
}

impl System {
    /// The computer that runs this program.
    #[must_use]
    pub fn this_computer() -> Self {
        let text = |value: std::ffi::OsString| value.to_string_lossy().into_owned();
        let variables = std::env::vars_os().map(|(name, value)| (text(name), text(value))).collect();
        Self { root: PathBuf::from("/"), variables }
    }

    /// A computer whose files are below `root`, with these variables.
    #[must_use]
    pub fn of(root: &Path, variables: &[(&str, &str)]) -> Self {
        let owned = |(name, value): &(&str, &str)| ((*name).to_owned(), (*value).to_owned());
        Self { root: root.to_owned(), variables: variables.iter().map(owned).collect() }
    }

    /// Text of a file at an absolute path; `None` if it cannot be read. Bytes that are no text are replaced.
    pub(super) fn text(&self, path: &str) -> Option<String> {
        let bytes = std::fs::read(self.path(path)).ok()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Whether a file or folder exists.
    pub(super) fn exists(&self, path: &str) -> bool {
        self.path(path).exists()
    }

    /// Value of a variable; `None` if it is absent or empty.
    pub(super) fn variable(&self, name: &str) -> Option<&str> {
        self.variables.get(name).map(String::as_str).filter(|value| !value.is_empty())
    }

    fn path(&self, path: &str) -> PathBuf {
        self.root.join(path.trim_start_matches('/'))
    }
}
