//! The Debian package: built, its content checked, unpacked, and its program run.

use super::{build, deb_content, sha256};
use crate::aarch64::{self, TARGET};
use crate::program::{self, answers, output};
use crate::workspace::Verdict;
use std::path::{Path, PathBuf};

/// Files of the sources that the package has as they are.
const COPIED: [(&str, &str); 5] = [
    ("packaging/debian/trundle@.service", "trundle@.service"),
    ("packaging/debian/robot.conf", "robot.conf"),
    ("CHANGELOG.md", "changelog"),
    ("NOTICE", "NOTICE"),
    ("packaging/debian/copyright", "copyright"),
];
/// Files that the program writes: its arguments and the file.
const WRITTEN: [(&[&str], &str); 5] = [
    (&["completions", "bash"], "trundle.bash"),
    (&["completions", "zsh"], "_trundle"),
    (&["completions", "fish"], "trundle.fish"),
    (&["devices", "--udev"], "60-trundle.rules"),
    (&["config"], "robot.toml"),
];
/// Programs that the step needs, and how to get them.
const TOOLS: [(&str, &str, &str); 2] = [
    ("cargo-deb", "--version", "cargo install cargo-deb"),
    ("dpkg-deb", "--version", "apt-get install dpkg"),
];

/// What the package is built of.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// For aarch64.
    #[arg(long)]
    arm64: bool,
    /// Build profile of the program: dist, or release, which `.ci/run` has built already and which no user gets.
    #[arg(long, default_value = super::PROFILE, value_parser = [super::PROFILE, "release"])]
    profile: String,
}

/// Builds the package for this computer, or for aarch64, and checks it; skipped by name if tools are missing.
pub fn run(root: &Path, options: &Options) -> Verdict {
    let is_arm64 = options.arm64;
    let missing: Vec<_> = TOOLS.iter().filter(|(tool, argument, _)| !answers(tool, argument)).collect();
    for (tool, _, remedy) in &missing {
        println!("  skipped: the Debian package needs {tool}: {remedy}");
    }
    let is_dist = options.profile == super::PROFILE;
    let emulator = aarch64::emulator();
    let lacks = [
        (!aarch64::builds(), "the compiler of"),
        // The release program of aarch64 is built by `cargo xtask aarch64`, which needs an emulator.
        (!is_dist && emulator.is_none(), "an emulator of"),
    ];
    let lacks: Vec<&str> =
        lacks.iter().filter(|(lacks, _)| is_arm64 && *lacks).map(|(_, what)| *what).collect();
    for what in &lacks {
        println!("  skipped: the Debian package of arm64 needs {what} {TARGET} (cargo xtask aarch64)");
    }
    if !missing.is_empty() || !lacks.is_empty() {
        return Ok(true);
    }
    let own = if is_dist { build(root, None) } else { program::trundle(root, &options.profile) }?;
    let program = match (is_arm64, is_dist) {
        (false, _) => own.clone(),
        (true, true) => build(root, Some(TARGET))?,
        (true, false) => aarch64::release_trundle(root)?,
    };
    collect(root, &own, &program.with_file_name("deb"))?;
    let package = pack(root, options)?;
    println!("{}\nsha256: {}", package.display(), sha256(&package)?);
    let runner = if is_arm64 { emulator.map(Vec::from) } else { Some(Vec::new()) };
    let findings = deb_content::check(root, &package, runner.as_deref())?;
    findings.iter().for_each(|finding| println!("{finding}"));
    println!("deb: {} errors", findings.len());
    Ok(findings.is_empty())
}

/// Collects the files of the package beside its program.
fn collect(root: &Path, own: &Path, folder: &Path) -> Result<(), String> {
    let failed = |path: &Path| {
        let path = path.display().to_string();
        move |e: std::io::Error| format!("cannot write {path}: {e}")
    };
    // The folder of an earlier version may hold pages of commands that are gone.
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    for (from, to) in COPIED {
        std::fs::copy(root.join(from), folder.join(to)).map_err(failed(&folder.join(to)))?;
    }
    for (args, to) in WRITTEN {
        std::fs::write(folder.join(to), output(own, args)?).map_err(failed(&folder.join(to)))?;
    }
    let pages = folder.join("man");
    output(own, &["man", &pages.display().to_string()])?;
    let entries = std::fs::read_dir(&pages).map_err(|e| format!("cannot list {}: {e}", pages.display()))?;
    let pages = entries.flatten().map(|entry| entry.path());
    let log = folder.join("changelog.Debian");
    std::fs::write(&log, debian_changelog(root)?).map_err(failed(&log))?;
    pages.chain([folder.join("changelog"), log]).try_for_each(|file| compress(&file))
}

/// The changelog of the package in Debian's form, with the date of the last commit.
fn debian_changelog(root: &Path) -> Result<String, String> {
    let metadata = program::metadata(root)?;
    let packages = metadata["packages"].as_array().map(Vec::as_slice).unwrap_or_default();
    let package =
        packages.iter().find(|package| package["name"] == "trundle-cli").ok_or("no package trundle-cli")?;
    let version = package["version"].as_str().unwrap_or_default();
    let maintainer = package["metadata"]["deb"]["maintainer"].as_str().unwrap_or_default();
    let folder = root.display().to_string();
    let date = output(Path::new("git"), &["-C", &folder, "log", "-1", "--format=%cD"])?;
    let date = String::from_utf8_lossy(&date).trim().to_owned();
    Ok(format!(
        "trundle ({version}-1) unstable; urgency=medium\n\n  * The changes are in changelog.gz.\n\n -- {maintainer}  {date}\n"
    ))
}

/// Compresses a file as Debian's policy asks (12.1, 12.7), without name and time.
fn compress(file: &Path) -> Result<(), String> {
    output(Path::new("gzip"), &["-9", "--no-name", "--force", &file.display().to_string()]).map(|_| ())
}

/// Packs; the package.
fn pack(root: &Path, options: &Options) -> Result<PathBuf, String> {
    let folder = program::scratch(root, if options.arm64 { "deb-arm64" } else { "deb" })?;
    let out = folder.display().to_string();
    let mut args = vec![
        "deb",
        "--no-build",
        "--no-strip",
        "--profile",
        &options.profile,
        "--package",
        "trundle-cli",
        "--output",
        &out,
    ];
    if options.profile != super::PROFILE {
        // Only its content is checked.
        args.push("--fast");
    }
    if options.arm64 {
        args.extend(["--target", TARGET]);
    }
    if !program::cargo(root, &args, &[])? {
        return Err("cargo deb fails".into());
    }
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("cannot list {out}: {e}"))?;
    let mut packages = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|end| end == "deb"));
    packages.next().ok_or(format!("cargo deb wrote no package into {out}"))
}
