//! The list of parts (SBOM) of the program of a release, as CycloneDX: the packages that are compiled into it, and which needs which.

use crate::program::{self, FEATURES};
use crate::workspace::Verdict;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Version of the form. Source: CycloneDX 1.6 (ECMA-424).
const SPEC_VERSION: &str = "1.6";
/// The package of the program.
const PROGRAM: &str = "trundle-cli";
/// Its manifest, relative to the workspace.
const MANIFEST: &str = "apps/trundle-cli/Cargo.toml";
/// Folder below the build results, and the file in it.
const PLACE: (&str, &str) = ("sbom", "trundle-cli.cdx.json");

/// Name and version of a package.
type Part = (String, String);

/// Writes the list of parts of the program for this computer. It has no date: the same sources give the same bytes.
pub fn run(root: &Path) -> Verdict {
    let sbom = sbom(root)?;
    let file = program::scratch(root, PLACE.0)?.join(PLACE.1);
    let text = format!("{sbom:#}\n");
    std::fs::write(&file, text).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    let number = sbom["components"].as_array().map_or(0, Vec::len);
    println!("{}: {number} packages", file.display());
    Ok(true)
}

fn sbom(root: &Path) -> Result<Value, String> {
    let parts = compiled(root)?;
    let metadata = metadata(root)?;
    let checksums = checksums(root)?;
    let packages: BTreeMap<Part, &Value> = items(&metadata["packages"])
        .map(|package| (part(package), package))
        .filter(|(part, _)| parts.contains(part))
        .collect();
    if let Some(unknown) = parts.iter().find(|part| !packages.contains_key(*part)) {
        return Err(format!(
            "cargo metadata does not name {} {}, which cargo tree does",
            unknown.0, unknown.1
        ));
    }
    let component = |(part, package): (&Part, &&Value)| component(part, package, checksums.get(part));
    let (own, others): (Vec<Value>, Vec<Value>) =
        packages.iter().map(component).partition(|component| component["name"] == PROGRAM);
    let mut program = own.into_iter().next().ok_or(format!("cargo tree does not name {PROGRAM}"))?;
    program["type"] = json!("application");
    Ok(json!({
        "bomFormat": "CycloneDX", "specVersion": SPEC_VERSION, "version": 1,
        "metadata": { "component": program }, "components": others, "dependencies": dependencies(&metadata, &packages),
    }))
}

/// Cargo's metadata of the program with its features, and of all its dependencies on this kind of computer.
fn metadata(root: &Path) -> Result<Value, String> {
    let host = program::output(Path::new("rustc"), &["--print", "host-tuple"])?;
    let host = String::from_utf8_lossy(&host);
    let args = ["metadata", "--format-version=1", "--locked", "--offline", "--manifest-path", MANIFEST];
    let text = program::cargo_output(
        root,
        &[&args[..], &["--features", FEATURES, "--filter-platform", host.trim()]].concat(),
    )?;
    serde_json::from_str(&text).map_err(|e| format!("cargo metadata: {e}"))
}

/// The packages that a build of the program compiles into it.
fn compiled(root: &Path) -> Result<BTreeSet<Part>, String> {
    let args = ["tree", "--locked", "--offline", "--edges=normal", "--prefix=none", "--package", PROGRAM];
    let tree = program::cargo_output(root, &[&args[..], &["--features", FEATURES]].concat())?;
    let part = |line: &str| {
        let (name, rest) = line.split_once(" v")?;
        Some((name.to_owned(), rest.split(' ').next()?.to_owned()))
    };
    Ok(tree.lines().filter_map(part).collect())
}

/// Checksums of the packages that come from a registry, by the lock file.
fn checksums(root: &Path) -> Result<BTreeMap<Part, String>, String> {
    let file = root.join("Cargo.lock");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
    let lock: toml::Table = text.parse().map_err(|e| format!("{}: {e}", file.display()))?;
    let packages =
        lock.get("package").and_then(toml::Value::as_array).ok_or("Cargo.lock names no package")?;
    let text = |package: &toml::Value, key: &str| Some(package.get(key)?.as_str()?.to_owned());
    let entry =
        |package| Some(((text(package, "name")?, text(package, "version")?), text(package, "checksum")?));
    Ok(packages.iter().filter_map(entry).collect())
}

/// The entry of a package.
fn component((name, version): &Part, package: &Value, checksum: Option<&String>) -> Value {
    let reference = reference(name, version);
    let mut entry = json!({ "type": "library", "bom-ref": reference, "name": name, "version": version, "purl": reference });
    if let Some(licence) = package["license"].as_str() {
        // The older form of cargo writes `MIT/Apache-2.0`.
        let licence = licence.replace(" / ", "/").replace('/', " OR ");
        entry["licenses"] = json!([{ "expression": licence }]);
    }
    if let Some(checksum) = checksum {
        entry["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
    }
    if let Some(repository) = package["repository"].as_str() {
        entry["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
    }
    entry
}

/// Which package needs which others.
fn dependencies(metadata: &Value, packages: &BTreeMap<Part, &Value>) -> Vec<Value> {
    let by_id: BTreeMap<&str, &Part> =
        packages.iter().filter_map(|(part, package)| Some((package["id"].as_str()?, part))).collect();
    let reference = |id: &Value| by_id.get(id.as_str()?).map(|(name, version)| reference(name, version));
    let is_compiled_in = |dep: &&Value| items(&dep["dep_kinds"]).any(|kind| kind["kind"].is_null());
    let entry = |node: &Value| {
        let needs = items(&node["deps"]).filter(is_compiled_in).filter_map(|dep| reference(&dep["pkg"]));
        Some(json!({ "ref": reference(&node["id"])?, "dependsOn": needs.collect::<BTreeSet<_>>() }))
    };
    items(&metadata["resolve"]["nodes"]).filter_map(entry).collect()
}

/// The package URL, which is also the name of the entry.
fn reference(name: &str, version: &str) -> String {
    format!("pkg:cargo/{name}@{}", version.replace('+', "%2B"))
}

fn part(package: &Value) -> Part {
    let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
    (text("name"), text("version"))
}

fn items(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_has_what_is_compiled_with_licence_checksum_and_needs() {
        let sbom = sbom(&crate::workspace::root()).unwrap();
        let named = |name: &str| items(&sbom["components"]).find(|part| part["name"] == name);
        let serde = named("serde").unwrap();
        assert_eq!(serde["hashes"][0]["content"].as_str().unwrap().len(), 64);
        assert_eq!(serde["licenses"][0]["expression"], "MIT OR Apache-2.0");
        // rustdds is of the feature ros2, pyo3 of the Python package, tempfile of the tests alone.
        assert!(named("rustdds").is_some() && named("pyo3").is_none() && named("proptest").is_none());
        let references: BTreeSet<&str> = items(&sbom["components"])
            .chain([&sbom["metadata"]["component"]])
            .filter_map(|part| part["bom-ref"].as_str())
            .collect();
        let dependencies: Vec<&Value> = items(&sbom["dependencies"]).collect();
        assert_eq!(dependencies.len(), references.len());
        for dependency in dependencies {
            assert!(
                items(&dependency["dependsOn"]).all(|needed| references.contains(needed.as_str().unwrap()))
            );
        }
    }
}
