//! Manifests of the crates that are published: the fields of a registry, and versions beside paths.

use super::finding::Finding;
use super::tree::{File, Package, Tree};
use toml::Value;

/// Fields that every published crate has.
const FIELDS: [&str; 12] = [
    "description",
    "version",
    "license",
    "repository",
    "homepage",
    "authors",
    "rust-version",
    "readme",
    "keywords",
    "categories",
    "include",
    "metadata",
];
/// Largest number of keywords and of categories, and longest keyword \[characters\]. Source: crates.io.
const MAX_KEYWORDS: usize = 5;
const MAX_KEYWORD_CHARACTERS: usize = 20;

/// Checks the manifests of published crates, and the workspace's own dependencies.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let published = tree.packages.iter().filter(|package| is_published(package));
    published.flat_map(|package| check_package(tree, package)).chain(check_workspace(tree)).collect()
}

/// Whether a package is published: its manifest does not say `publish = false`, and the workspace is not that of `fuzz/`.
fn is_published(package: &Package) -> bool {
    field(package, "publish") != Some(&Value::Boolean(false))
}

fn field<'a>(package: &'a Package, name: &str) -> Option<&'a Value> {
    package.manifest.get("package")?.get(name)
}

fn check_package(tree: &Tree, package: &Package) -> Vec<Finding> {
    let path = format!("{}/Cargo.toml", package.folder);
    let absent = FIELDS.iter().filter(|name| field(package, name).is_none());
    let mut messages: Vec<String> =
        absent.map(|name| format!("{} has no `{name}`, which a published crate has", package.name)).collect();
    for name in ["keywords", "categories"] {
        let words = field(package, name).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let is_long = |word: &Value| word.as_str().is_none_or(|word| word.len() > MAX_KEYWORD_CHARACTERS);
        if words.is_empty() || words.len() > MAX_KEYWORDS || (name == "keywords" && words.iter().any(is_long))
        {
            messages.push(format!(
                "{name}: {} words, expected 1 to {MAX_KEYWORDS}, a keyword of at most {MAX_KEYWORD_CHARACTERS} characters",
                words.len()
            ));
        }
    }
    if tree.file(&format!("{}/README.md", package.folder)).is_none() {
        messages.push(format!("{} has no README.md of its own", package.name));
    }
    messages.into_iter().map(|message| Finding::error(&path, 1, message)).collect()
}

/// Findings of the workspace's dependencies: a path without the version that the registry needs.
fn check_workspace(tree: &Tree) -> Vec<Finding> {
    let Some(file) = tree.file("Cargo.toml") else { return Vec::new() };
    let Ok(manifest) = file.text.parse::<toml::Table>() else { return Vec::new() };
    let Some(workspace) = manifest.get("workspace") else { return Vec::new() };
    let version = workspace.get("package").and_then(|package| package.get("version"));
    let dependencies = workspace.get("dependencies").and_then(Value::as_table).into_iter().flatten();
    let wrong =
        dependencies.filter(|(_, value)| value.get("path").is_some() && value.get("version") != version);
    wrong.map(|(name, _)| version_finding(file, name)).collect()
}

fn version_finding(file: &File, name: &str) -> Finding {
    let line = file.text.lines().position(|line| line.starts_with(&format!("{name} ="))).map_or(1, |i| i + 1);
    Finding::error(&file.path, line, format!("{name}: `version` is not that of workspace.package"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    const WHOLE: &str = "[package]\nname = \"x\"\ndescription = \"X.\"\nversion = \"1.0.0\"\nlicense = \"MIT\"\nrepository = \"r\"\n\
        homepage = \"h\"\nauthors = [\"a\"]\nrust-version = \"1.95\"\nreadme = \"README.md\"\nkeywords = [\"robot\"]\n\
        categories = [\"science::robotics\"]\ninclude = [\"/src\"]\n[package.metadata.docs.rs]\nall-features = true\n";

    fn findings(manifest: &str) -> Vec<String> {
        let tree = tree(&[("x/Cargo.toml", manifest), ("x/README.md", "# x")]);
        check(&tree).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn absent_fields_and_long_keywords_are_found() {
        assert_eq!(findings(WHOLE), [""; 0]);
        assert!(findings(&WHOLE.replace("license", "licence"))[0].contains("x has no `license`"));
        assert!(
            findings(&WHOLE.replace("\"robot\"", "\"a-robot-of-two-wheels-indoors\""))[0]
                .contains("keywords")
        );
        assert_eq!(findings("[package]\nname = \"x\"\npublish = false\n"), [""; 0]);
        assert_eq!(check(&tree(&[("x/Cargo.toml", WHOLE)])).len(), 1, "no README.md");
    }

    #[test]
    fn paths_need_the_version_of_the_workspace() {
        let manifest = |version| {
            format!(
                "[workspace.package]\nversion = \"0.2.0\"\n[workspace.dependencies]\n\
                 x = {{ version = \"{version}\", path = \"x\" }}\ny = \"1\"\n"
            )
        };
        assert!(check(&tree(&[("Cargo.toml", &manifest("0.2.0"))])).is_empty());
        let found = check(&tree(&[("Cargo.toml", &manifest("0.1.0"))]));
        assert_eq!(found.iter().map(|f| f.line).collect::<Vec<_>>(), [4]);
    }
}
