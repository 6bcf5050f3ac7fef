//! Features of the facade crate: each builds alone, and brings no more crates than it needs.

use crate::program;
use std::path::Path;

/// Features and crates that must be absent with them: a user of the planner compiles no simulator.
const ABSENT: [(&str, &[&str]); 5] = [
    ("slam", &["trundle-sim", "trundle-runtime", "trundle-io", "trundle-planning"]),
    ("mapping", &["trundle-sim", "trundle-runtime", "trundle-io", "trundle-slam"]),
    ("planning", &["trundle-sim", "trundle-runtime", "trundle-io", "trundle-slam"]),
    ("docking", &["trundle-sim", "trundle-runtime", "trundle-io", "trundle-planning"]),
    ("runtime", &["trundle-sim", "trundle-app", "trundle-experiments", "trundle-live"]),
];
/// Features that each check builds alone: those that a user of one algorithm chooses.
const ALGORITHM_FEATURES: [&str; 5] = ["slam", "mapping", "planning", "docking", "sim"];
/// Features that a release builds alone as well. `full` is what the workspace builds, `ros2`, `mqtt`, `foxglove` and `tls` are the program's.
const OTHER_FEATURES: [&str; 9] =
    ["", "estimation", "control", "surface", "drivers", "io", "eval", "viz", "runtime"];

/// The findings, one sentence each.
pub fn check(root: &Path, every: bool) -> Result<Vec<String>, String> {
    let mut findings = Vec::new();
    for (feature, absent) in ABSENT {
        let tree = tree(root, feature)?;
        let found = absent.iter().filter(|name| names(&tree).any(|package| package == **name));
        findings
            .extend(found.map(|name| format!("trundle, feature {feature}: compiles {name}, expected not")));
    }
    for feature in ALGORITHM_FEATURES.iter().chain(OTHER_FEATURES.iter().filter(|_| every)) {
        let args =
            ["check", "--quiet", "--package", "trundle", "--no-default-features", "--features", feature];
        if !program::cargo(root, &args, &[])? {
            findings.push(format!("trundle, feature '{feature}': does not build alone"));
        }
    }
    Ok(findings)
}

/// Dependencies of the facade with one feature: a package and its version on each line.
fn tree(root: &Path, feature: &str) -> Result<String, String> {
    let args = ["tree", "--offline", "--prefix=none", "--edges=normal", "--package=trundle"];
    program::cargo_output(root, &[&args[..], &["--no-default-features", "--features", feature]].concat())
}

/// Names of the packages of a tree.
fn names(tree: &str) -> impl Iterator<Item = &str> {
    tree.lines().filter_map(|line| line.split(' ').next())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_planner_has_no_simulator_and_the_whole_has() {
        let root = crate::workspace::root();
        let has = |feature, name: &str| names(&tree(&root, feature).unwrap()).any(|package| package == name);
        assert!(has("planning", "trundle-planning") && !has("planning", "trundle-sim"));
        assert!(has("full", "trundle-sim"));
        assert!(tree(&root, "no-such-feature").is_err());
    }

    /// A feature without an entry is not checked.
    #[test]
    fn every_feature_is_listed() {
        let text =
            std::fs::read_to_string(crate::workspace::root().join("crates/trundle/Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let listed = [
            &ALGORITHM_FEATURES[..],
            &OTHER_FEATURES,
            &["default", "full", "ros2", "mqtt", "foxglove", "tls", "kinect2-usb"],
        ]
        .concat();
        for feature in manifest["features"].as_table().unwrap().keys() {
            assert!(listed.contains(&feature.as_str()), "{feature}");
        }
    }
}
