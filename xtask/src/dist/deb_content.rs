//! Content of the Debian package: its files, and the program and the service of an unpacked system.

use crate::program::{self, answers, output};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Largest exposure of the service, ten times the figure of `systemd-analyze security`, which goes from 0 (safe) to 10. Source: ours, the
/// service has 1.9: it needs devices, the network and two groups.
const MAX_EXPOSURE: &str = "20";
/// Why `systemd-analyze` checks nothing.
const NO_SYSTEMD: &str = "skipped: the check of the service needs systemd-analyze: apt-get install systemd";

/// Files that the package has, with their rights.
const EXPECTED: [(&str, &str); 11] = [
    ("-rwxr-xr-x", "./usr/bin/trundle"),
    ("-rw-r--r--", "./usr/share/man/man1/trundle.1.gz"),
    ("-rw-r--r--", "./usr/share/man/man1/trundle-run.1.gz"),
    ("-rw-r--r--", "./usr/share/bash-completion/completions/trundle"),
    ("-rw-r--r--", "./usr/share/zsh/vendor-completions/_trundle"),
    ("-rw-r--r--", "./usr/share/fish/vendor_completions.d/trundle.fish"),
    ("-rw-r--r--", "./usr/lib/udev/rules.d/60-trundle.rules"),
    ("-rw-r--r--", "./usr/lib/systemd/system/trundle@.service"),
    ("-rw-r--r--", "./etc/trundle/robot.toml"),
    ("-rw-r--r--", "./etc/trundle/robot.conf"),
    ("-rw-r--r--", "./usr/share/doc/trundle/copyright"),
];

/// The findings of a package, one sentence each. `runner`: the words before its program that run it here; without them it does not run.
pub fn check(root: &Path, package: &Path, runner: Option<&[PathBuf]>) -> Result<Vec<String>, String> {
    let path = package.display().to_string();
    let list = output(Path::new("dpkg-deb"), &["-c", &path])?;
    let mut findings = missing(&String::from_utf8_lossy(&list));
    let system = program::scratch(root, "deb-root")?;
    output(Path::new("dpkg-deb"), &["-x", &path, &system.display().to_string()])?;
    match runner {
        Some(runner) => findings.extend(try_program(&system, runner).err()),
        None => println!("  skipped: the program of the package does not run without an emulator"),
    }
    findings.extend(verify_service(&system));
    findings.extend(exposed(&system.join("usr/lib/systemd/system/trundle@.service")));
    findings.extend(lintian(package));
    Ok(findings)
}

/// A sentence for each expected file that a listing of `dpkg-deb -c` does not have.
fn missing(list: &str) -> Vec<String> {
    let has = |rights: &str, path: &str| {
        list.lines().any(|line| line.starts_with(rights) && line.split_whitespace().last() == Some(path))
    };
    let absent = EXPECTED.into_iter().filter(|(rights, path)| !has(rights, path));
    absent.map(|(rights, path)| format!("the package has no {path} with the rights {rights}")).collect()
}

/// Runs the program of the unpacked system: its version, its own robot file, and this computer's check.
fn try_program(system: &Path, runner: &[PathBuf]) -> Result<(), String> {
    let own = system.join("usr/bin/trundle");
    let words: Vec<String> = runner.iter().chain([&own]).map(|word| word.display().to_string()).collect();
    let printed = |given: &[&str]| {
        let all: Vec<&str> = words.iter().map(String::as_str).chain(given.iter().copied()).collect();
        output(Path::new(all[0]), &all[1..])
    };
    println!("  {}", String::from_utf8_lossy(&printed(&["-V"])?).trim());
    let config = system.join("etc/trundle/robot.toml").display().to_string();
    printed(&["config", "--quiet", &config])?;
    let mut doctor = Command::new(&words[0]);
    let checks = doctor.args(&words[1..]).args(["doctor", "--json"]).stdin(Stdio::null()).output();
    let checks = checks.map_err(|e| format!("cannot start {}: {e}", words[0]))?;
    let is_json = serde_json::from_slice::<serde_json::Value>(&checks.stdout).is_ok();
    is_json.then_some(()).ok_or("trundle doctor --json of the package is not JSON".to_owned())
}

/// What `systemd-analyze verify` has against the service; skipped by name without it.
fn verify_service(system: &Path) -> Option<String> {
    if !answers("systemd-analyze", "--version") {
        println!("  {NO_SYSTEMD}");
        return None;
    }
    let unit = system.join("usr/lib/systemd/system/trundle@.service");
    // The service names the installed program; here the program of the unpacked system stands for it.
    let text =
        std::fs::read_to_string(&unit).ok()?.replace("/usr/bin/", &format!("{}/usr/bin/", system.display()));
    let instance = system.join("trundle@robot.service");
    std::fs::write(&instance, text).ok()?;
    let mut verify = Command::new("systemd-analyze");
    verify.args(["verify", "--man=no", "--recursive-errors=no"]).arg(&instance).stdin(Stdio::null());
    let output = verify.output().ok()?;
    let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    (!output.status.success()).then(|| format!("systemd-analyze verify: {why}"))
}

/// A sentence if the service of a unit file can do more than [`MAX_EXPOSURE`] allows; skipped by name without systemd-analyze.
fn exposed(unit: &Path) -> Option<String> {
    if !answers("systemd-analyze", "--version") {
        println!("  {NO_SYSTEMD}");
        return None;
    }
    let mut security = Command::new("systemd-analyze");
    security.args(["security", "--offline=yes", "--no-pager", &format!("--threshold={MAX_EXPOSURE}")]);
    let output = security.arg(unit).stdin(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let level = text.lines().last().unwrap_or("no result").trim_start_matches('→').trim().to_owned();
    (!output.status.success())
        .then(|| format!("systemd-analyze security: {level}, at most {MAX_EXPOSURE} tenths expected"))
}

/// The errors that lintian finds; skipped by name without it.
fn lintian(package: &Path) -> Vec<String> {
    if !answers("lintian", "--version") {
        println!("  skipped: lintian is not here: apt-get install lintian");
        return Vec::new();
    }
    let mut lintian = Command::new("lintian");
    lintian.args(["--fail-on", "none", "--allow-root"]).arg(package).stdin(Stdio::null());
    let Ok(output) = lintian.output() else { return vec!["lintian cannot be started".into()] };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    print!("{text}");
    text.lines().filter(|line| line.starts_with("E:")).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_files_and_wrong_rights_are_found() {
        let line = |(rights, path): &(&str, &str)| format!("{rights} root/root  1 2026-01-01 00:00 {path}\n");
        let whole: String = EXPECTED.iter().map(line).collect();
        assert!(missing(&whole).is_empty());
        let wrong = whole.replace("-rwxr-xr-x", "-rw-r--r--").replace("robot.conf", "other.conf");
        assert_eq!(missing(&wrong).len(), 2);
    }

    #[test]
    fn the_service_has_no_more_rights_than_it_needs() {
        let unit = crate::workspace::root().join("packaging/debian/trundle@.service");
        assert_eq!(exposed(&unit), None);
        if !answers("systemd-analyze", "--version") {
            return;
        }
        let open = std::fs::read_to_string(&unit).unwrap().replace("DynamicUser=yes", "DynamicUser=no");
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("trundle@.service");
        std::fs::write(&file, open).unwrap();
        let why = exposed(&file).unwrap();
        assert!(why.contains("exposure level"), "{why}");
    }

    #[test]
    #[cfg(unix)]
    fn the_program_of_the_package_runs_by_its_runner() {
        use std::os::unix::fs::PermissionsExt;
        let system = tempfile::tempdir().unwrap();
        let program = system.path().join("usr/bin/trundle");
        std::fs::create_dir_all(program.parent().unwrap()).unwrap();
        std::fs::write(&program, "[ -n \"$EMULATED\" ] && echo '{}'\n").unwrap();
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o644)).unwrap();
        let runner = ["env", "EMULATED=1", "sh"].map(PathBuf::from);
        assert_eq!(try_program(system.path(), &runner), Ok(()));
        assert!(try_program(system.path(), &runner[..1]).is_err());
    }

    /// A file that is listed in the manifest and not checked could vanish.
    #[test]
    fn the_manifest_installs_what_is_expected() {
        let text =
            std::fs::read_to_string(crate::workspace::root().join("apps/trundle-cli/Cargo.toml")).unwrap();
        for (_, path) in EXPECTED {
            let folder = path.trim_start_matches("./").rsplit_once('/').unwrap().0;
            assert!(path.ends_with("copyright") || text.contains(&format!("\"{folder}/")), "{path}");
        }
    }
}
