//! Comparison of the public interfaces with the last release.

use crate::program::{self, answers, output};
use crate::workspace::Verdict;
use std::path::Path;

/// Packages that are not published.
const TOOLS: [&str; 3] = ["trundle-fuzz", "trundle-python", "xtask"];

/// Runs `cargo semver-checks` against the last tag `vX.Y.Z`; skipped by name without such a tag, or without the program.
pub fn run(root: &Path) -> Verdict {
    let folder = root.display().to_string();
    let tags = output(Path::new("git"), &["-C", &folder, "tag", "--list", "v*", "--sort=version:refname"])?;
    let Some(tag) = last_release(&String::from_utf8_lossy(&tags)) else {
        println!("  skipped: the comparison of interfaces needs a tag vX.Y.Z of an earlier release");
        return Ok(true);
    };
    if !answers("cargo-semver-checks", "--version") {
        println!(
            "  skipped: the comparison of interfaces with {tag} needs cargo-semver-checks: cargo install --locked cargo-semver-checks"
        );
        return Ok(true);
    }
    let excluded = TOOLS.iter().flat_map(|name| ["--exclude", name]);
    let args: Vec<&str> =
        ["semver-checks", "--workspace", "--baseline-rev", &tag].into_iter().chain(excluded).collect();
    program::cargo(root, &args, &[])
}

/// The last of the tags, in the order of their versions, that names a release: `v`, and three numbers.
fn last_release(tags: &str) -> Option<String> {
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let is_release = |tag: &&str| {
        let parts: Vec<&str> = tag.strip_prefix('v').unwrap_or_default().split('.').collect();
        parts.len() == 3 && parts.into_iter().all(is_number)
    };
    tags.lines().map(str::trim).rfind(is_release).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_release_is_a_tag_of_three_numbers() {
        assert_eq!(last_release(""), None);
        assert_eq!(last_release("v0.9.0\nv0.10.1\nv1.0.0-rc.1\nvision\n").as_deref(), Some("v0.10.1"));
    }

    /// A tool that became a published package would not be compared.
    #[test]
    fn the_excluded_packages_are_not_published() {
        let metadata = program::metadata(&crate::workspace::root()).unwrap();
        let packages = metadata["packages"].as_array().unwrap();
        let is_private =
            |package: &&serde_json::Value| package["publish"].as_array().is_some_and(Vec::is_empty);
        let unpublished = packages.iter().filter(is_private);
        let mut names: Vec<&str> = unpublished.map(|package| package["name"].as_str().unwrap()).collect();
        names.sort_unstable();
        assert_eq!(names, TOOLS);
    }
}
