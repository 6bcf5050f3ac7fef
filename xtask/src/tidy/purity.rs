//! No file, socket, thread, clock or global random generator below the edges and the runtime.

use super::arrows::{ALGORITHM_CRATES, EDGES};
use super::finding::Finding;
use super::tree::Tree;

/// Words of code that access anything outside a function's arguments, and the accessed thing.
const OUTSIDE: [(&str, &str); 14] = [
    ("std::fs", "files"),
    ("std::net", "sockets"),
    ("std::thread", "threads"),
    ("std::process", "processes"),
    ("std::env", "the environment"),
    ("File::open", "files"),
    ("File::create", "files"),
    ("println!", "the terminal"),
    ("eprintln!", "the terminal"),
    ("print!", "the terminal"),
    ("eprint!", "the terminal"),
    ("dbg!", "the terminal"),
    ("stdin()", "the terminal"),
    ("stdout()", "the terminal"),
];
/// Members of `std` that do.
const OUTSIDE_OF_STD: [&str; 5] = ["fs", "net", "thread", "process", "env"];
/// Words that make a result depend on the time and place of its computation.
const NONDETERMINISM: [(&str, &str); 9] = [
    ("Instant", "the clock"),
    ("SystemTime", "the clock"),
    ("thread_rng", "the global random generator"),
    ("rand::rng", "the global random generator"),
    ("rand::random", "the global random generator"),
    ("ThreadRng", "the global random generator"),
    ("OsRng", "the system's random generator"),
    ("from_os_rng", "the system's random generator"),
    ("RandomState", "the global random generator"),
];

/// Edges that work with devices and links, which need the clock.
const LIVE_EDGES: [&str; 1] = ["trundle-drivers"];

/// Checks the sources of all crates of algorithms, and of the edges for clocks and randomness.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &tree.packages {
        let name = package.name.as_str();
        let inner = ALGORITHM_CRATES.contains(&name)
            || ["trundle-core", "trundle-collision", "trundle-grid", "trundle-optim"].contains(&name);
        let is_timeless = EDGES.contains(&name) && !LIVE_EDGES.contains(&name);
        if !inner && !is_timeless {
            continue;
        }
        for source in tree.sources(package) {
            let path = &source.file.path;
            let words = NONDETERMINISM.iter().chain(if inner { &OUTSIDE[..] } else { &[] });
            for (word, what) in words {
                let at = source.code.lines_with(word);
                findings.extend(at.map(|line| Finding::error(path, line, forbidden(name, word, what))));
            }
            let members =
                source.code.group("std").into_iter().filter(|(_, m)| inner && OUTSIDE_OF_STD.contains(m));
            findings.extend(
                members.map(|(line, m)| Finding::error(path, line, forbidden(name, m, "the outside"))),
            );
        }
    }
    findings
}

fn forbidden(package: &str, word: &str, what: &str) -> String {
    format!("`{word}`: {package} must not reach for {what}; pass it in as an argument")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    fn findings(name: &str, code: &str) -> Vec<String> {
        let manifest = format!("[package]\nname = \"{name}\"");
        let tree = tree(&[
            ("crates/x/Cargo.toml", &manifest),
            ("crates/x/src/a.rs", code),
            ("crates/x/tests/it.rs", code),
        ]);
        check(&tree).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn the_outside_is_for_the_edges() {
        let found = findings("trundle-mapping", "\nuse std::fs;\n");
        assert_eq!(found.len(), 1);
        assert!(
            found[0].starts_with("crates/x/src/a.rs:2: `std::fs`: trundle-mapping must not"),
            "{found:?}"
        );
        assert_eq!(findings("trundle-planning", "use std::{fmt, thread};").len(), 1);
        assert!(findings("trundle-io", "use std::fs;").is_empty());
        assert!(findings("trundle-planning", "#[cfg(test)]\nmod tests { use std::fs; }").is_empty());
    }

    #[test]
    fn clocks_and_randomness_are_for_nobody_but_the_runtime() {
        assert_eq!(findings("trundle-sim", "let t = std::time::Instant::now();").len(), 1);
        assert_eq!(findings("trundle-slam", "let r = rand::rng();").len(), 1);
        assert!(findings("trundle-slam", "let r = rand_chacha::ChaCha8Rng::seed_from_u64(1);").is_empty());
        assert!(findings("trundle-runtime", "let t = std::time::Instant::now();").is_empty());
    }
}
