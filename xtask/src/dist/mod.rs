//! The program of a release: small, stripped, with paths that do not depend on the machine.

pub mod deb;
mod deb_content;
pub mod reproduce;
pub mod sbom;

use crate::program::{self, FEATURES};
use crate::workspace::Verdict;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Build profile of the program of a release.
const PROFILE: &str = "dist";
/// Size above which the program of a release is refused \[MB\]: above the goal of the measurement. Source: ours,
/// `results/program-size.json` and some room.
const MAX_SIZE_MB: f64 = 28.0;

/// Builds the program and prints its size and checksum; with `sizes`, first its size with the default features, as `cargo install` builds
/// it. Returns whether the program of a release is small enough.
pub fn run(root: &Path, sizes: bool) -> Verdict {
    if sizes {
        println!("default features: {:.2} MB", size_mb(&build_with(root, None, "")?)?);
    }
    let program = build(root, None)?;
    let size_mb = size_mb(&program)?;
    println!(
        "{}\nsize: {size_mb:.2} MB, at most {MAX_SIZE_MB} MB\nsha256: {}",
        program.display(),
        sha256(&program)?
    );
    Ok(size_mb <= MAX_SIZE_MB)
}

/// Size of a file \[MB\].
fn size_mb(file: &Path) -> Result<f64, String> {
    let data = std::fs::metadata(file).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
    Ok(data.len() as f64 / 1e6)
}

/// Builds the program of a release for this computer or for `target`; its path.
pub fn build(root: &Path, target: Option<&str>) -> Result<PathBuf, String> {
    build_with(root, target, FEATURES)
}

/// Builds the program with these features beside the default ones, in the profile of a release.
fn build_with(root: &Path, target: Option<&str>, features: &str) -> Result<PathBuf, String> {
    let mut args = vec!["build", "--profile", PROFILE, "--locked", "--package", "trundle-cli"];
    args.extend(["--features", features]);
    args.extend(target.into_iter().flat_map(|target| ["--target", target]));
    let flags = flags(root)?;
    let env = [("RUSTFLAGS", flags.as_str()), ("CARGO_INCREMENTAL", "0"), crate::aarch64::LINKER_VARIABLE];
    if !program::cargo(root, &args, &env)? {
        return Err(format!("the program does not build in profile {PROFILE}"));
    }
    let folder = program::target(root)?.join(target.unwrap_or("")).join(PROFILE);
    Ok(folder.join(format!("trundle{}", std::env::consts::EXE_SUFFIX)))
}

/// Flags of the compiler that replace this machine's folders in the program: sources, build results, registry.
fn flags(root: &Path) -> Result<String, String> {
    Ok(flags_of(root, &program::target(root)?))
}

/// The flags for the folders of the sources and of the build results.
fn flags_of(root: &Path, target: &Path) -> String {
    let home = std::env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let cargo = std::env::var_os("CARGO_HOME").map_or_else(|| home.join(".cargo"), PathBuf::from);
    let mut folders = vec![(root, "/trundle"), (cargo.as_path(), "/cargo")];
    // The last prefix that fits counts; within the sources, the build results are named as theirs.
    folders.extend((!target.starts_with(root)).then_some((target, "/trundle/target")));
    let flags =
        folders.iter().map(|(folder, name)| format!("--remap-path-prefix={}={name}", folder.display()));
    flags.collect::<Vec<_>>().join(" ")
}

/// SHA-256 of a file, in hexadecimal digits, by the system's program.
pub fn sha256(file: &Path) -> Result<String, String> {
    let output = Command::new("sha256sum").arg(file).stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start sha256sum: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let sum = text.split_whitespace().next().filter(|_| output.status.success());
    sum.map(|sum| sum.trim_start_matches('\\').to_owned())
        .ok_or(format!("sha256sum cannot read {}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_bytes() {
        let file = program::target(&crate::workspace::root()).unwrap().join("xtask-sha256");
        std::fs::write(&file, "abc").unwrap();
        // FIPS 180-2, appendix B.1.
        assert_eq!(
            sha256(&file).unwrap(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        std::fs::remove_file(&file).unwrap();
        assert!(sha256(&file).is_err());
    }

    #[test]
    fn the_container_has_the_program_of_a_release() {
        let file = crate::workspace::root().join("packaging/container/Containerfile");
        let text = std::fs::read_to_string(file).unwrap();
        let build =
            format!("cargo build --profile {PROFILE} --locked --package trundle-cli --features {FEATURES}\n");
        assert!(text.contains(&build), "expected `{}` in {text}", build.trim());
        assert!(text.contains(&format!("/target/{PROFILE}/trundle ")), "{text}");
        let manifest: toml::Table =
            std::fs::read_to_string(crate::workspace::root().join("Cargo.toml")).unwrap().parse().unwrap();
        let version = manifest["workspace"]["package"]["rust-version"].as_str().unwrap();
        assert!(text.contains(&format!("/rust:{version}-")), "Rust {version} in {text}");
    }

    #[test]
    fn the_folders_of_this_machine_are_replaced() {
        let root = crate::workspace::root();
        let flags = flags(&root).unwrap();
        assert!(flags.starts_with(&format!("--remap-path-prefix={}=/trundle ", root.display())), "{flags}");
        assert!(flags.contains("=/cargo"), "{flags}");
    }
}
