//! The workspace's text files and packages, read once.

use super::source::Code;
use std::path::Path;

/// The workspace's text files and packages.
pub struct Tree {
    /// Files by path.
    pub files: Vec<File>,
    /// Packages by folder.
    pub packages: Vec<Package>,
}

/// A text file.
pub struct File {
    /// Relative to the workspace, with `/`.
    pub path: String,
    /// Text of the file.
    pub text: String,
}

/// A package of the workspace.
pub struct Package {
    /// Name of the package.
    pub name: String,
    /// Folder of the package, relative to the workspace.
    pub folder: String,
    /// Parsed `Cargo.toml`.
    pub manifest: toml::Table,
}

/// A Rust file of a package's `src`.
pub struct Source<'a> {
    /// The file.
    pub file: &'a File,
    /// Code of the file without comments, strings and tests.
    pub code: Code,
}

/// Folder of code written by `cargo xtask ros-interfaces`: names and fields of its types are those of ROS 2's messages.
const GENERATED_FOLDER: &str = "/src/generated/";

impl Source<'_> {
    /// Whether a program wrote the file, from definitions that are not the project's.
    pub fn is_generated(&self) -> bool {
        self.file.path.contains(GENERATED_FOLDER)
    }
}

/// Folders without code of the project.
const SKIPPED: [&str; 5] = ["target", "out", ".git", ".scratch", "node_modules"];
/// Files that are read.
const EXTENSIONS: [&str; 6] = ["rs", "toml", "md", "lock", "sh", "yml"];

impl Tree {
    /// Reads the tree below `root`.
    pub fn read(root: &Path) -> Result<Self, String> {
        let mut files = Vec::new();
        collect(root, "", &mut files)?;
        files.sort_by(|a, b| a.path.cmp(&b.path));
        Self::of(files)
    }

    /// A tree of these files.
    pub fn of(files: Vec<File>) -> Result<Self, String> {
        let manifests =
            files.iter().filter_map(|f| f.path.strip_suffix("/Cargo.toml").map(|folder| (folder, f)));
        let packages = manifests.map(|(folder, file)| package(folder, file)).collect::<Result<_, _>>()?;
        Ok(Self { files, packages })
    }

    /// The file at a path.
    pub fn file(&self, path: &str) -> Option<&File> {
        self.files.iter().find(|file| file.path == path)
    }

    /// The files that end so.
    pub fn ending<'a>(&'a self, end: &'a str) -> impl Iterator<Item = &'a File> {
        self.files.iter().filter(move |file| file.path.ends_with(end))
    }

    /// All Rust files of a package, each with its code and its tests.
    pub fn sources_with_tests<'a>(&'a self, package: &Package) -> impl Iterator<Item = Source<'a>> {
        let folder = format!("{}/", package.folder);
        self.ending(".rs")
            .filter(move |file| file.path.starts_with(&folder))
            .map(|file| Source { file, code: Code::with_tests(&file.text) })
    }

    /// The Rust files of a package's `src`.
    pub fn sources<'a>(&'a self, package: &Package) -> impl Iterator<Item = Source<'a>> {
        let src = format!("{}/src/", package.folder);
        self.ending(".rs")
            .filter(move |file| file.path.starts_with(&src))
            .map(|file| Source { file, code: Code::of(&file.text) })
    }
}

fn collect(root: &Path, inner: &str, files: &mut Vec<File>) -> Result<(), String> {
    let at = root.join(inner);
    let entries = std::fs::read_dir(&at).map_err(|e| format!("cannot list {}: {e}", at.display()))?;
    for entry in entries {
        let entry = entry.map_err(|e| format!("cannot list {}: {e}", at.display()))?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        let path = if inner.is_empty() { name.clone() } else { format!("{inner}/{name}") };
        if entry.path().is_dir() {
            if !SKIPPED.contains(&name.as_str()) {
                collect(root, &path, files)?;
            }
        } else if name.rsplit_once('.').is_some_and(|(_, end)| EXTENSIONS.contains(&end)) {
            // Editors and other tools come and go: a file that vanished is not a finding.
            if let Ok(text) = std::fs::read_to_string(entry.path()) {
                files.push(File { path, text });
            }
        }
    }
    Ok(())
}

fn package(folder: &str, file: &File) -> Result<Package, String> {
    let manifest: toml::Table = file.text.parse().map_err(|e| format!("{}: {e}", file.path))?;
    let name = manifest.get("package").and_then(|p| p.get("name")).and_then(toml::Value::as_str);
    let name = name.ok_or_else(|| format!("{}: no package.name", file.path))?.to_owned();
    Ok(Package { name, folder: folder.to_owned(), manifest })
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A tree in memory.
    pub fn tree(files: &[(&str, &str)]) -> Tree {
        let file = |(path, text): &(&str, &str)| File { path: (*path).to_owned(), text: (*text).to_owned() };
        Tree::of(files.iter().map(file).collect()).unwrap()
    }

    #[test]
    fn a_manifest_makes_a_package() {
        let tree =
            tree(&[("a/Cargo.toml", "[package]\nname = \"x\""), ("a/src/lib.rs", "fn f() {}"), ("b.rs", "")]);
        assert_eq!(tree.packages[0].name, "x");
        assert_eq!(tree.sources(&tree.packages[0]).count(), 1);
    }
}
