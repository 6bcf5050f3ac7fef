//! Content of one package: the files that belong to every package, and no path that leads out of it.

use std::path::{Component, Path, PathBuf};

/// Files that every package has.
const NEEDED: [&str; 5] = ["Cargo.toml", "README.md", "LICENSE-MIT", "LICENSE-APACHE", "NOTICE"];
/// Text before the path of another file, in Rust.
const REFERENCES: [&str; 4] = ["include_str!(\"", "include_bytes!(\"", "include!(\"", "#[path = \""];

/// The findings in the folder of an unpacked package, one sentence each.
pub fn check(folder: &Path) -> Result<Vec<String>, String> {
    let needed = NEEDED.iter().filter(|name| !is_plain_file(&folder.join(name)));
    let mut findings: Vec<String> = needed
        .map(|name| format!("{name} is absent, expected a file: link it from the crate's folder"))
        .collect();
    findings.extend(outside_manifest(&read(&folder.join("Cargo.toml"))?));
    for file in rust_files(folder)? {
        let text = read(&file)?;
        let name = file.strip_prefix(folder).unwrap_or(&file);
        findings.extend(references(&text).filter(|path| leads_out(name, path)).map(|path| {
            format!(
                "{}: the path {path} leads out of the package: move the file into the crate",
                name.display()
            )
        }));
    }
    Ok(findings)
}

/// Whether the path is a file with content, and no link.
fn is_plain_file(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|data| data.is_file() && data.len() > 0)
}

/// Paths of the packed manifest that lead out of the package.
fn outside_manifest(text: &str) -> impl Iterator<Item = String> {
    let paths = text.lines().filter(|line| line.contains("\"../") || line.contains("= \"/"));
    paths.map(|line| format!("Cargo.toml: `{}` leads out of the package", line.trim()))
}

/// Paths of other files that a Rust file names.
fn references(text: &str) -> impl Iterator<Item = &str> {
    let after = |word| text.split(word).skip(1).filter_map(|rest: &str| rest.split('"').next());
    let at_compile_time = REFERENCES.into_iter().flat_map(after);
    // `concat!(env!("CARGO_MANIFEST_DIR"), "/../..")`: the separator is cut off, as the path starts at the package.
    at_compile_time.chain(
        text.split("env!(\"CARGO_MANIFEST_DIR\"), \"/").skip(1).filter_map(|rest| rest.split('"').next()),
    )
}

/// Whether a path that a file names leads out of the package.
fn leads_out(file: &Path, path: &str) -> bool {
    let parts: Vec<Component<'_>> = Path::new(path).components().collect();
    let ups = parts.iter().filter(|part| **part == Component::ParentDir).count();
    let depth = file.components().count() - 1;
    ups > depth || parts.first() == Some(&Component::RootDir)
}

/// The Rust files below a folder, by name.
fn rust_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("cannot list {}: {e}", folder.display()))?;
    let mut files = Vec::new();
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|end| end == "rs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|e| format!("cannot read {}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A package of these files, with those that every package has.
    fn package(name: &str, files: &[(&str, &str)]) -> Vec<String> {
        let folder =
            crate::program::scratch(&crate::workspace::root(), &format!("xtask-contents-{name}")).unwrap();
        let needed = NEEDED.map(|name| (name, "text"));
        for (path, text) in needed.iter().chain(files) {
            let path = folder.join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let findings = check(&folder).unwrap();
        std::fs::remove_dir_all(folder).unwrap();
        findings
    }

    #[test]
    fn whole_packages_pass() {
        let inside =
            "const A: &str = include_str!(\"../../data/a.txt\");\n#[path = \"other.rs\"]\nmod other;\n";
        assert_eq!(package("whole", &[("src/b/c.rs", inside)]), [""; 0]);
    }

    #[test]
    fn paths_out_of_the_package_are_found() {
        let outside = "const A: &str = include_str!(\"../../data/a.txt\");\n#[path = \"/other.rs\"]\nmod other;\n\
                       const D: &str = concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/../../docs\");\n";
        let manifest = "[[example]]\npath = \"../../bench/main.rs\"\n";
        let findings = package("outside", &[("src/lib.rs", outside), ("Cargo.toml", manifest)]);
        assert_eq!(findings.len(), 4, "{findings:?}");
    }

    #[test]
    fn absent_and_empty_files_are_found() {
        let findings = package("empty", &[("LICENSE-MIT", "")]);
        assert!(findings[0].starts_with("LICENSE-MIT is absent"), "{findings:?}");
    }
}
