//! The crates as packages of a registry: each is packed and its content checked, and each feature of the facade builds alone.

mod contents;
mod dry_run;
mod features;

use crate::program;
use crate::workspace::Verdict;
use dry_run::DryRun;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Largest package that crates.io accepts \[bytes\]. Source: the registry's default limit, 10 MiB.
const MAX_PACKAGE_BYTES: u64 = 10 << 20;

/// A package that is published.
pub struct Published {
    /// Name of the package.
    pub name: String,
    /// Version of the package.
    version: String,
}

/// Publishes every crate as a dry run, packs it, and checks the packages and the facade's features: the usual ones, or every one.
pub fn run(root: &Path, every_feature: bool) -> Verdict {
    let packages = published(root)?;
    let findings = [check_packages(root, &packages)?, features::check(root, every_feature)?].concat();
    findings.iter().for_each(|finding| println!("{finding}"));
    println!("packages: {} packed, {} errors", packages.len(), findings.len());
    Ok(findings.is_empty())
}

/// The crates of the workspace that `publish` does not exclude.
pub fn published(root: &Path) -> Result<Vec<Published>, String> {
    let metadata = program::metadata(root)?;
    let all = metadata["packages"].as_array().ok_or("cargo metadata names no packages")?;
    let is_published = |package: &&serde_json::Value| package["publish"] != serde_json::json!([]);
    let text = |package: &serde_json::Value, key: &str| package[key].as_str().unwrap_or_default().to_owned();
    let packages = all.iter().filter(is_published);
    Ok(packages.map(|p| Published { name: text(p, "name"), version: text(p, "version") }).collect())
}

fn check_packages(root: &Path, packages: &[Published]) -> Result<Vec<String>, String> {
    match dry_run::run(root)? {
        DryRun::Passed => println!("  cargo publish --dry-run: {} crates in order", packages.len()),
        DryRun::Failed(why) => return Err(format!("cargo publish --dry-run fails: {why}")),
        DryRun::Unreachable(why) => println!("  skipped: cargo publish --dry-run needs the registry ({why})"),
    }
    pack(root, packages)?;
    let unpacked = program::scratch(root, "packages")?;
    let mut findings = Vec::new();
    for package in packages {
        let folder = unpack(root, package, &unpacked)?;
        findings
            .extend(contents::check(&folder)?.into_iter().map(|what| format!("{}: {what}", package.name)));
    }
    Ok(findings)
}

/// Packs the crates without network.
fn pack(root: &Path, packages: &[Published]) -> Result<(), String> {
    let mut args = vec!["package", "--quiet", "--no-verify", "--offline", "--allow-dirty"];
    args.extend(packages.iter().flat_map(|package| ["--package", &package.name]));
    let is_packed = program::cargo(root, &args, &[])?;
    is_packed.then_some(()).ok_or_else(|| "cargo package fails".into())
}

/// Unpacks a package; its folder.
fn unpack(root: &Path, package: &Published, into: &Path) -> Result<PathBuf, String> {
    let stem = format!("{}-{}", package.name, package.version);
    let archive = program::target(root)?.join("package").join(format!("{stem}.crate"));
    let bytes = std::fs::metadata(&archive).map_err(|e| format!("cannot read {}: {e}", archive.display()))?;
    if bytes.len() > MAX_PACKAGE_BYTES {
        return Err(format!(
            "{stem}.crate: {} bytes, at most {MAX_PACKAGE_BYTES}: narrow `include`",
            bytes.len()
        ));
    }
    let mut tar = Command::new("tar");
    tar.arg("-xzf").arg(&archive).arg("-C").arg(into).stdin(Stdio::null());
    let status = tar.status().map_err(|e| format!("cannot start tar: {e}"))?;
    if status.success() {
        Ok(into.join(stem))
    } else {
        Err(format!("tar cannot unpack {}", archive.display()))
    }
}
