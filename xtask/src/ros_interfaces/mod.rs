//! The Rust structures of ROS 2 interfaces, written from `crates/trundle-ros2/interfaces`.

mod definition;
mod rust;

use crate::workspace::Verdict;
use definition::{Interface, Kind, parse};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// The table of definitions: `PACKAGE/{msg,srv,action}/NAME.{msg,srv,action}`.
const TABLE: &str = "crates/trundle-ros2/interfaces";
/// The folder of the structures.
const GENERATED: &str = "crates/trundle-ros2/src/generated";
/// The list of all interfaces in the program that prints their bytes.
const LIST: &str = "crates/trundle-ros2/examples/interface_bytes/all.rs";

/// Writes the structures; with `check_only`, only reports whether they are up to date.
pub fn run(root: &Path, check_only: bool) -> Verdict {
    let files = files(&read(&root.join(TABLE))?);
    let mut is_current = true;
    for (name, text) in &files {
        let path = root.join(name);
        if std::fs::read_to_string(&path).is_ok_and(|old| old == *text) {
            continue;
        }
        if check_only {
            println!("{name} is not what the interfaces give: cargo xtask ros-interfaces");
            is_current = false;
        } else {
            write(&path, text)?;
        }
    }
    Ok(is_current)
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("cannot write {}: {e}", path.display());
    path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(failed)?;
    std::fs::write(path, text).map_err(failed)
}

/// All interfaces of the table, by package and name.
fn read(table: &Path) -> Result<Vec<Interface>, String> {
    let mut interfaces = Vec::new();
    for package in names(table)? {
        for folder in names(&table.join(&package))? {
            let Some(kind) = Kind::of_folder(&folder) else { continue };
            for file in names(&table.join(&package).join(&folder))? {
                let path = table.join(&package).join(&folder).join(&file);
                let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
                let name = file.split('.').next().unwrap_or_default();
                interfaces.push(parse(&package, kind, name, &text)?);
            }
        }
    }
    Ok(interfaces)
}

/// Names in a folder, sorted; a file has none.
fn names(folder: &Path) -> Result<Vec<String>, String> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let failed = |e: std::io::Error| format!("cannot list {}: {e}", folder.display());
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    let name = |entry: std::io::Result<std::fs::DirEntry>| {
        entry.map(|entry| entry.file_name().to_string_lossy().into_owned()).map_err(failed)
    };
    let mut names = entries.map(name).collect::<Result<Vec<_>, _>>()?;
    names.sort();
    Ok(names)
}

/// The files by their paths: one per interface, one per package, one of all packages, and the list of all interfaces.
fn files(interfaces: &[Interface]) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    let mut packages = BTreeMap::<&str, Vec<String>>::new();
    for interface in interfaces {
        let module = snake(&interface.name);
        files.insert(format!("{GENERATED}/{}/{module}.rs", interface.package), rust::file(interface));
        packages.entry(&interface.package).or_default().push(module);
    }
    let mut root = "//! ROS 2 interfaces. Written by `cargo xtask ros-interfaces`.\n\n".to_owned();
    for (package, mut modules) in packages {
        modules.sort();
        let mut text = format!("//! `{package}`. Written by `cargo xtask ros-interfaces`.\n\n");
        modules.iter().for_each(|module| _ = writeln!(text, "mod {module};"));
        text.push('\n');
        modules.iter().for_each(|module| _ = writeln!(text, "pub use {module}::*;"));
        files.insert(format!("{GENERATED}/{package}/mod.rs"), text);
        let _ = writeln!(root, "pub mod {package};");
    }
    files.insert(format!("{GENERATED}/mod.rs"), root);
    files.insert(LIST.to_owned(), rust::list(interfaces));
    files
}

fn snake(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut snake = String::new();
    for (i, c) in letters.iter().enumerate() {
        let follows_lower = i > 0 && !letters[i - 1].is_uppercase();
        let begins_word = i > 0 && letters.get(i + 1).is_some_and(|next| next.is_lowercase());
        if c.is_uppercase() && (follows_lower || begins_word) {
            snake.push('_');
        }
        snake.extend(c.to_lowercase());
    }
    snake
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_structures_are_what_the_interfaces_give() {
        let root = crate::workspace::root();
        assert!(run(&root, true).unwrap(), "run `cargo xtask ros-interfaces`");
    }

    #[test]
    fn modules_are_in_snake_case() {
        assert_eq!(snake("TFMessage"), "tf_message");
        assert_eq!(snake("PoseWithCovarianceStamped"), "pose_with_covariance_stamped");
    }
}
