//! Reproducible builds: the program of a release, built from two folders, has the same bytes.

use super::{build, sha256};
use crate::program;
use crate::workspace::Verdict;
use std::path::Path;
use std::process::{Command, Stdio};

/// Folder of the clone, below the build results. It is kept: the next run builds what has changed.
const CLONE: &str = "reproduce/a-clone-at-another-path";

/// Builds the committed sources here and in a clone at another path. Returns whether both programs have the same bytes.
pub fn run(root: &Path) -> Verdict {
    if !is_clean(root)? {
        return Err(
            "the sources have changes, and a clone has only what is committed: commit them first".into()
        );
    }
    let clone = program::target(root)?.join(CLONE);
    if !clone.exists() {
        git(root, &["clone", "--quiet", "--no-checkout", ".", &clone.display().to_string()])?;
    }
    let commit = git(root, &["rev-parse", "HEAD"])?;
    git(&clone, &["fetch", "--quiet", "origin", commit.trim()])?;
    git(&clone, &["checkout", "--quiet", "--force", "--detach", commit.trim()])?;
    let sums = [checksum(root)?, checksum(&clone)?];
    println!("{}", if sums[0] == sums[1] { "the same bytes" } else { "not the same bytes" });
    Ok(sums[0] == sums[1])
}

/// Builds the program of these sources; its checksum, which is printed as well.
fn checksum(root: &Path) -> Result<String, String> {
    let program = build(root, None)?;
    let sum = sha256(&program)?;
    println!("{sum}  {}", program.display());
    Ok(sum)
}

/// Whether every tracked file is as committed.
fn is_clean(root: &Path) -> Verdict {
    Ok(git(root, &["status", "--porcelain", "--untracked-files=no"])?.trim().is_empty())
}

/// Output of git.
fn git(root: &Path, args: &[&str]) -> Result<String, String> {
    let output = Command::new("git").args(args).current_dir(root).stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start git: {e}"))?;
    if !output.status.success() {
        return Err(format!("git {}: {}", args.join(" "), String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dist::{PROFILE, flags_of};
    use std::path::PathBuf;

    /// Writes sources among the build results. Their absolute path stands in the program, as that of a package of the registry does.
    const BUILD: &str = "fn main() {\n    let folder = std::env::var(\"OUT_DIR\").unwrap();\n    \
                         let text = \"fn path() -> &'static str { file!() }\";\n    \
                         std::fs::write(folder + \"/path.rs\", text).unwrap();\n}\n";
    const PROGRAM: &str =
        "include!(concat!(env!(\"OUT_DIR\"), \"/path.rs\"));\nfn main() { println!(\"{}\", path()); }\n";
    const MANIFEST: &str =
        "[package]\nname = \"small\"\nversion = \"0.1.0\"\nedition = \"2024\"\n[workspace]\n";

    /// The workspace's profiles `release` and `dist`, without those of packages.
    fn profiles() -> String {
        let text = std::fs::read_to_string(crate::workspace::root().join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let mut profiles = toml::Table::new();
        for name in ["release", "dist"] {
            let mut profile = manifest["profile"][name].as_table().unwrap().clone();
            profile.remove("package");
            profiles.insert(name.to_owned(), profile.into());
        }
        toml::to_string(&toml::Table::from_iter([("profile".to_owned(), profiles.into())])).unwrap()
    }

    /// Builds a small program in a folder as one of a release: with its flags, and its profile.
    fn small_program(root: &Path) -> PathBuf {
        std::fs::create_dir_all(root.join("src")).unwrap();
        std::fs::write(root.join("build.rs"), BUILD).unwrap();
        std::fs::write(root.join("src/main.rs"), PROGRAM).unwrap();
        std::fs::write(root.join("Cargo.toml"), format!("{MANIFEST}{}", profiles())).unwrap();
        let target = root.join("target");
        let mut cargo = Command::new(program::cargo_path());
        cargo.args(["build", "--quiet", "--offline", "--profile", PROFILE]).current_dir(root);
        cargo.env("RUSTFLAGS", flags_of(root, &target)).env("CARGO_TARGET_DIR", &target);
        let status = cargo.env("CARGO_INCREMENTAL", "0").stdin(Stdio::null()).status();
        assert!(status.unwrap().success());
        target.join(PROFILE).join("small")
    }

    #[test]
    fn a_program_has_the_same_bytes_at_every_path() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "a-clone/at/another/path"].map(|name| small_program(&folder.path().join(name)));
        // Without the flags this would be the folder of the machine, and the bytes would differ.
        let path = String::from_utf8(program::output(&a, &[]).unwrap()).unwrap();
        assert!(path.starts_with("/trundle/target/"), "{path}");
        assert_eq!(sha256(&a).unwrap(), sha256(&b).unwrap());
    }
}
