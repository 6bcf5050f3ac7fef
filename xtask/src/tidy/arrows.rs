//! Allowed dependencies between crates, and the crates that may read TOML and command lines.

use super::finding::Finding;
use super::tree::{File, Package, Tree};

/// The crates of algorithms: none depends on another.
pub const ALGORITHM_CRATES: [&str; 8] = [
    "trundle-vision",
    "trundle-slam",
    "trundle-mapping",
    "trundle-estimation",
    "trundle-planning",
    "trundle-control",
    "trundle-docking",
    "trundle-surface",
];
/// The edges: they depend on core alone.
pub const EDGES: [&str; 5] = ["trundle-sim", "trundle-io", "trundle-drivers", "trundle-viz", "trundle-eval"];
/// Crates that may read TOML or command lines.
const SETTINGS_CRATES: [&str; 6] =
    ["trundle-runtime", "trundle-app", "trundle-cli", "trundle-io", "trundle-fuzz", "xtask"];
/// Crates that serve connections: two speak HTTP, one accepts connections for both.
const HTTP_CRATES: [&str; 3] = ["trundle-live", "trundle-foxglove", "trundle-server"];
/// Packages with HTTP.
const HTTP_PACKAGES: [&str; 5] = ["axum", "hyper", "hyper-util", "tokio", "tokio-tungstenite"];

/// Checks every arrow between packages.
pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.packages.iter().flat_map(|package| check_package(tree, package)).collect()
}

fn check_package(tree: &Tree, package: &Package) -> Vec<Finding> {
    let path = format!("{}/Cargo.toml", package.folder);
    let Some(file) = tree.file(&path) else { return Vec::new() };
    let mut findings = Vec::new();
    let Package { name, .. } = package;
    if !is_known(name) {
        findings.push(Finding::error(
            &path,
            line_of(file, "name", 1),
            format!("{name} is not a crate of the design"),
        ));
    }
    for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
        let Some(dependencies) = package.manifest.get(kind).and_then(toml::Value::as_table) else { continue };
        let header =
            file.text.lines().position(|line| line.trim() == format!("[{kind}]")).map_or(1, |i| i + 1);
        for dependency in dependencies.keys() {
            let line = line_of(file, dependency, header);
            if is_ours(dependency) && !may_know(name, dependency) && !may_test_with(name, dependency, kind) {
                let message =
                    format!("{name} must not depend on {dependency} ({kind}): no such arrow in the design");
                findings.push(Finding::error(&path, line, message));
            }
            if ["toml", "clap"].contains(&dependency.as_str()) && !SETTINGS_CRATES.contains(&name.as_str()) {
                let message = format!(
                    "{name} must not depend on {dependency}: only runtime, app, cli, io, fuzz and xtask do"
                );
                findings.push(Finding::error(&path, line, message));
            }
            if HTTP_PACKAGES.contains(&dependency.as_str()) && !HTTP_CRATES.contains(&name.as_str()) {
                let message = format!(
                    "{name} must not depend on {dependency}: only trundle-live, trundle-foxglove and trundle-server serve connections"
                );
                findings.push(Finding::error(&path, line, message));
            }
        }
    }
    findings
}

fn is_ours(name: &str) -> bool {
    name == "trundle" || name.starts_with("trundle-")
}

fn is_known(name: &str) -> bool {
    ALGORITHM_CRATES.contains(&name)
        || EDGES.contains(&name)
        || [
            "trundle-core",
            "trundle-collision",
            "trundle-grid",
            "trundle-optim",
            "trundle-runtime",
            "trundle-app",
            "trundle-experiments",
            "trundle-ros2",
            "trundle-server",
            "trundle-live",
            "trundle-fleet",
            "trundle-foxglove",
            "trundle",
            "trundle-cli",
            "trundle-python",
            "xtask",
            "trundle-bench",
            "trundle-fuzz",
            "trundle-libfuzzer",
        ]
        .contains(&name)
}

/// The simulator as the body of the app's examples and tests; output folders for the runs behind the tests of front ends.
fn may_test_with(from: &str, to: &str, kind: &str) -> bool {
    let pairs =
        [("trundle-app", "trundle-sim"), ("trundle-live", "trundle-io"), ("trundle-foxglove", "trundle-io")];
    kind == "dev-dependencies" && pairs.contains(&(from, to))
}

/// The arrows of the design.
fn may_know(from: &str, to: &str) -> bool {
    let base = ["trundle-core", "trundle-collision", "trundle-grid", "trundle-optim"].contains(&to);
    match from {
        "trundle-core" | "xtask" => false,
        "trundle-collision" | "trundle-grid" | "trundle-optim" => to == "trundle-core",
        "trundle-slam" => base || to == "trundle-vision",
        "trundle-runtime" => base || ALGORITHM_CRATES.contains(&to),
        "trundle-app" => {
            let edges = ["trundle-io", "trundle-drivers", "trundle-viz", "trundle-eval"];
            base || ALGORITHM_CRATES.contains(&to) || edges.contains(&to) || to == "trundle-runtime"
        }
        "trundle-experiments" => {
            base || ALGORITHM_CRATES.contains(&to)
                || EDGES.contains(&to)
                || ["trundle-runtime", "trundle-app"].contains(&to)
        }
        "trundle-ros2" => {
            let edges = ["trundle-io", "trundle-drivers"];
            base || ALGORITHM_CRATES.contains(&to)
                || edges.contains(&to)
                || ["trundle-runtime", "trundle-app"].contains(&to)
        }
        "trundle-server" => to == "trundle-runtime",
        "trundle-live" => {
            base || ["trundle-planning", "trundle-runtime", "trundle-app", "trundle-server"].contains(&to)
        }
        "trundle-fleet" => base || ["trundle-runtime", "trundle-app", "trundle-viz"].contains(&to),
        "trundle-foxglove" => base || ["trundle-runtime", "trundle-app", "trundle-server"].contains(&to),
        "trundle" => !["trundle", "trundle-cli"].contains(&to),
        "trundle-cli" | "trundle-fuzz" => to == "trundle",
        "trundle-python" => ["trundle", "trundle-cli"].contains(&to),
        "trundle-libfuzzer" => to == "trundle-fuzz",
        "trundle-bench" => to != "trundle-cli",
        algorithm if ALGORITHM_CRATES.contains(&algorithm) => base,
        edge if EDGES.contains(&edge) => to == "trundle-core",
        _ => false,
    }
}

/// The line, from `header` on, that sets `key`.
fn line_of(file: &File, key: &str, header: usize) -> usize {
    let sets = |line: &str| {
        let rest = line.trim_start().strip_prefix(key);
        rest.is_some_and(|rest| rest.trim_start().starts_with(['=', '.']))
    };
    file.text.lines().enumerate().skip(header - 1).find(|(_, line)| sets(line)).map_or(header, |(i, _)| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    fn messages(name: &str, dependencies: &str) -> Vec<String> {
        let manifest = format!("[package]\nname = \"{name}\"\n\n[dependencies]\n{dependencies}");
        check(&tree(&[("crates/x/Cargo.toml", &manifest)])).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn only_the_designs_arrows_pass() {
        let slam =
            "trundle-core.workspace = true\ntrundle-optim.workspace = true\ntrundle-vision.workspace = true";
        assert!(messages("trundle-slam", slam).is_empty());
        let found =
            messages("trundle-mapping", "trundle-core.workspace = true\ntrundle-vision = { path = \"\" }");
        assert!(
            found[0].starts_with("crates/x/Cargo.toml:6: trundle-mapping must not depend on trundle-vision"),
            "{found:?}"
        );
        assert_eq!(messages("trundle-sim", "trundle-optim.workspace = true").len(), 1);
        assert_eq!(messages("trundle-runtime", "trundle-sim.workspace = true").len(), 1);
        assert_eq!(messages("trundle-cli", "trundle-core.workspace = true").len(), 1);
        assert!(
            messages("trundle", "trundle-sim.workspace = true\ntrundle-runtime.workspace = true").is_empty()
        );
    }

    #[test]
    fn settings_files_are_for_the_outer_crates() {
        assert_eq!(messages("trundle-planning", "toml.workspace = true").len(), 1);
        assert_eq!(messages("trundle-viz", "clap.workspace = true").len(), 1);
        assert!(messages("trundle-io", "toml.workspace = true").is_empty());
    }

    #[test]
    fn http_is_for_the_live_page() {
        assert_eq!(messages("trundle-app", "axum.workspace = true").len(), 1);
        assert!(messages("trundle-live", "axum.workspace = true\ntrundle-app.workspace = true").is_empty());
        assert_eq!(messages("trundle-live", "trundle-sim.workspace = true").len(), 1);
        assert!(messages("trundle-live", "trundle-server.workspace = true").is_empty());
        assert!(messages("trundle-server", "tokio.workspace = true").is_empty());
        assert_eq!(messages("trundle-server", "trundle-app.workspace = true").len(), 1);
    }

    #[test]
    fn a_package_must_be_in_the_design() {
        assert!(messages("trundle-unknown", "")[0].contains("not a crate of the design"));
    }
}
