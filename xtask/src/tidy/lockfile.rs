//! A single version of nalgebra, and no C or C++ in the dependency graph.

use super::finding::Finding;
use super::tree::Tree;

/// Packages that compile or search for foreign code.
const FOREIGN: [&str; 7] = ["cc", "cmake", "bindgen", "pkg-config", "vcpkg", "nasm-rs", "cxx"];
/// Packages that are named in the lock file and never built: one of an unsupported system, and one of an inactive feature of rustls-webpki,
/// which deny.toml forbids in the graph.
const NEVER_BUILT: [&str; 2] = ["iana-time-zone-haiku", "ring"];
/// Packages that must have one version: their types cross crates.
const SINGLE: [&str; 1] = ["nalgebra"];

/// Checks `Cargo.lock`.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(lock) = tree.file("Cargo.lock") else { return Vec::new() };
    let names: Vec<(usize, &str)> = lock
        .text
        .lines()
        .enumerate()
        .filter_map(|(i, line)| Some((i + 1, line.strip_prefix("name = \"")?.strip_suffix('"')?)))
        .collect();
    let mut findings = Vec::new();
    for (line, name) in &names {
        if FOREIGN.contains(name) && is_built(&lock.text, name) {
            let message = format!("{name} is in the graph: trundle builds with a Rust toolchain alone");
            findings.push(Finding::error(&lock.path, *line, message));
        }
    }
    for single in SINGLE {
        for (line, _) in names.iter().filter(|(_, name)| *name == single).skip(1) {
            findings.push(Finding::error(&lock.path, *line, format!("a second version of {single}")));
        }
    }
    findings
}

/// Whether a package of systems that trundle runs on depends on `name`.
fn is_built(lock: &str, name: &str) -> bool {
    let needs = |package: &&str| package.lines().any(|line| line.trim_matches([' ', '"', ',']) == name);
    let own = |package: &str| {
        package.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"')).map(str::to_owned)
    };
    let mut dependents = lock.split("[[package]]").filter(needs).filter_map(own).peekable();
    dependents.peek().is_none() || dependents.any(|package| !NEVER_BUILT.contains(&package.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn foreign_code_and_second_versions_are_found() {
        let lock = "[[package]]\nname = \"nalgebra\"\n[[package]]\nname = \"cc\"\n[[package]]\nname = \"nalgebra\"\n";
        let found = check(&tree(&[("Cargo.lock", lock)]));
        assert_eq!(found.iter().map(|f| f.line).collect::<Vec<_>>(), [4, 6]);
        assert!(check(&tree(&[("Cargo.lock", "name = \"linux-raw-sys\"")])).is_empty());
        let of = |dependent: &str| {
            format!(
                "[[package]]\nname = \"cc\"\n[[package]]\nname = \"{dependent}\"\ndependencies = [\n \"cc\",\n]\n"
            )
        };
        assert!(check(&tree(&[("Cargo.lock", &of("iana-time-zone-haiku"))])).is_empty());
        assert_eq!(check(&tree(&[("Cargo.lock", &of("libz"))])).len(), 1);
    }
}
