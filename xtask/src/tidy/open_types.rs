//! Public settings and events of the libraries are `#[non_exhaustive]`: a further field or variant breaks no caller.

use super::finding::Finding;
use super::source::definitions;
use super::tree::Tree;

/// Endings of the names of settings and events.
const ENDINGS: [&str; 4] = ["Config", "Settings", "Options", "Event"];

/// Crates that no other program builds upon.
const NO_LIBRARIES: [&str; 2] = ["trundle-experiments", "trundle-fuzz"];

/// Checks the public structs and enums of the libraries.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let libraries = tree.packages.iter().filter(|package| {
        package.folder.starts_with("crates/") && !NO_LIBRARIES.contains(&package.name.as_str())
    });
    for source in libraries.flat_map(|package| tree.sources(package)).filter(|s| !s.is_generated()) {
        for (line, name) in closed_types(source.code.text()) {
            let message =
                format!("{name} is not #[non_exhaustive]: a further field or variant would break callers");
            findings.push(Finding::error(&source.file.path, line, message));
        }
    }
    findings
}

/// Line and name of each public type of settings or events without the attribute.
fn closed_types(code: &str) -> Vec<(usize, &str)> {
    let lines: Vec<&str> = code.lines().collect();
    let is_open = |i: usize| {
        let attributes = lines[..i].iter().rev().take_while(|line| !line.trim().is_empty());
        attributes.take_while(|line| !line.starts_with('}')).any(|line| line.contains("#[non_exhaustive]"))
    };
    let named = lines.iter().enumerate().filter_map(|(i, line)| Some((i, public_type(line)?)));
    named.filter(|(i, _)| !is_open(*i)).map(|(i, name)| (i + 1, name)).collect()
}

/// Name of the settings or events that a line declares `pub`.
fn public_type(line: &str) -> Option<&str> {
    let (keyword, name) = *definitions(line.trim_start().strip_prefix("pub ")?).first()?;
    let is_meant = ["struct", "enum"].contains(&keyword) && ENDINGS.iter().any(|end| name.ends_with(end));
    is_meant.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn settings_and_events_without_the_attribute_are_found() {
        let code = "#[derive(Debug)]\npub struct AConfig {\n}\n\n#[derive(\n    Debug,\n)]\n#[non_exhaustive]\npub enum BEvent {\n}\n\
                    pub struct COptions;\nstruct DConfig;\npub struct Other;\npub type EConfig = u8;\n";
        assert_eq!(closed_types(code), [(2, "AConfig"), (11, "COptions")]);
    }

    #[test]
    fn only_libraries_are_checked() {
        let found = |name: &str| {
            let manifest = format!("[package]\nname = \"{name}\"");
            let code = "/// Settings.\npub struct ASettings;\n";
            let tree = tree(&[("crates/x/Cargo.toml", &manifest), ("crates/x/src/a.rs", code)]);
            check(&tree).iter().map(Finding::to_string).collect::<Vec<_>>()
        };
        assert!(found("trundle-x")[0].starts_with("crates/x/src/a.rs:2: ASettings is not #[non_exhaustive]"));
        assert!(found("trundle-experiments").is_empty());
    }
}
