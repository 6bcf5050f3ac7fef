//! The program on small computers: built for aarch64, its kernels tested and a few runs compared with this computer's, under qemu.
//!
//! The tests compare the NEON kernels with plain code. Other kernels are plain code, vectorised by the compiler for each processor family.
//! For these, the runs verify that aarch64 and this computer write equal bytes: lengths and angles come from functions without a difference
//! between processors (`trundle_core::Hypotenuse`).

use crate::workspace::Verdict;
use crate::{compare::compare_folders, program};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Name of the processor family for the compiler.
pub const TARGET: &str = "aarch64-unknown-linux-gnu";
const LINKER: &str = "aarch64-linux-gnu-gcc";
/// Variable of cargo with that linker.
pub const LINKER_VARIABLE: (&str, &str) = ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", LINKER);
/// Names of the emulator of single programs: Debian's static one, and others'.
const EMULATORS: [&str; 2] = ["qemu-aarch64-static", "qemu-aarch64"];
/// Folder of the aarch64 C library in Debian's and Ubuntu's `libc6-arm64-cross`.
const LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// Crates with kernels, and their tests.
const KERNELS: [(&str, &[&str]); 5] = [
    ("trundle-vision", &["orb", "alignment::template", "vocabulary::hamming", "matching"]),
    ("trundle-mapping", &["depth_scan::pixel_row", "scan_match"]),
    ("trundle-grid", &["tiles"]),
    ("trundle-optim", &["arrow", "bundle_system", "block_cholesky"]),
    ("trundle-sim", &["world", "camera::band"]),
];

/// The file that may differ: the encoder of its JPEG images rounds differently on different processors.
const MAY_DIFFER: &str = "recording.mcap";

/// Runs, in a folder of this computer or of the emulator: the name of the results' folder in it; `{data}` is the folder of the golden net.
/// The drive has 30 images.
const RUNS: [(&str, &str); 3] = [
    (
        "recorded",
        "sim room --drive {data}/twists.txt --duration 6 --rate 5 --laser urg-04lx --record recorded",
    ),
    ("map", "map recorded/laser.log --out map"),
    ("slam", "slam recorded --height 0.45 --tilt 8 --out slam"),
];

/// Requirements of the step on this computer.
struct Tools {
    emulator: &'static str,
}

impl Tools {
    /// The tools, or the missing ones with their remedy.
    fn find() -> Result<Self, Vec<String>> {
        let mut missing = Vec::new();
        if !has_standard_library() {
            missing.push(format!("Rust's standard library of {TARGET}: rustup target add {TARGET}"));
        }
        if !answers(LINKER) {
            missing.push(format!("{LINKER}: apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross"));
        }
        let emulator = EMULATORS.into_iter().find(|name| answers(name));
        if emulator.is_none() {
            missing.push(format!("{}: apt-get install qemu-user-static", EMULATORS[0]));
        }
        if !Path::new(LIBRARIES).is_dir() {
            missing.push(format!("{LIBRARIES}: apt-get install libc6-arm64-cross"));
        }
        emulator.filter(|_| missing.is_empty()).map(|emulator| Self { emulator }).ok_or(missing)
    }

    /// `cargo` for aarch64.
    fn cargo(&self, root: &Path, args: &[&str]) -> Verdict {
        let runner = format!("{} -L {LIBRARIES}", self.emulator);
        let env = [LINKER_VARIABLE, ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", &runner)];
        program::cargo(root, args, &env)
    }
}

/// Tests the kernels under qemu and compares the runs; skipped by name if tools are missing.
pub fn run(root: &Path) -> Verdict {
    let tools = match Tools::find() {
        Ok(tools) => tools,
        Err(missing) => {
            println!("  skipped: aarch64 needs");
            missing.iter().for_each(|tool| println!("    {tool}"));
            return Ok(true);
        }
    };
    for (package, tests) in KERNELS {
        let mut args = vec!["test", "--target", TARGET, "--package", package, "--lib", "--"];
        args.extend(tests);
        if !tools.cargo(root, &args)? {
            println!("the kernels of {package} fail on aarch64");
            return Ok(false);
        }
    }
    let program = release_trundle(root)?;
    compare(root, &tools, program)
}

/// The words before a program of aarch64 that run it on this computer; none without an emulator and its libraries.
pub fn emulator() -> Option<[PathBuf; 3]> {
    let emulator = EMULATORS.into_iter().find(|name| answers(name)).filter(|_| Path::new(LIBRARIES).is_dir());
    emulator.map(|emulator| [emulator.into(), "-L".into(), LIBRARIES.into()])
}

/// Builds the release program for aarch64, with all its features; its path.
pub fn release_trundle(root: &Path) -> Result<PathBuf, String> {
    let build = ["build", "--release", "--target", TARGET, "--package", "trundle-cli"];
    if !program::cargo(root, &[&build[..], &["--features", program::FEATURES]].concat(), &[LINKER_VARIABLE])?
    {
        return Err(format!("the program does not build for {TARGET}"));
    }
    Ok(program::target(root)?.join(TARGET).join("release").join("trundle"))
}

/// Runs the program on this computer and `other` under qemu. Returns whether the folders hold the same bytes.
fn compare(root: &Path, tools: &Tools, other: PathBuf) -> Verdict {
    let scratch = program::scratch(root, "aarch64-runs")?;
    let own = program::release_trundle(root)?;
    let emulated: [PathBuf; 4] = [tools.emulator.into(), "-L".into(), LIBRARIES.into(), other];
    let mut same = true;
    for (name, command) in RUNS {
        for (folder, program) in [("here", &[own.clone()][..]), ("aarch64", &emulated)] {
            let out = scratch.join(folder);
            if !ends(root, program, command, &out)? {
                println!("{name} does not end well: {}", program[program.len() - 1].display());
                return Ok(false);
            }
        }
        let (here, there) = (scratch.join("here").join(name), scratch.join("aarch64").join(name));
        let mut differences = compare_folders(&here, &there)?;
        differences.retain(|difference| !difference.starts_with(&format!("{MAY_DIFFER} at byte")));
        for difference in &differences {
            println!("{name} differs on aarch64: {difference}");
        }
        same &= differences.is_empty();
    }
    println!("{}", if same { "same results on aarch64" } else { "not the same results" });
    Ok(same)
}

/// Runs a command of `trundle` in a folder. Returns whether it ended regularly: with 0, or with 1 for a missed aim. The paths of its
/// results are relative, and therefore equal on both computers.
fn ends(root: &Path, program: &[PathBuf], command: &str, folder: &Path) -> Verdict {
    std::fs::create_dir_all(folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
    let data = root.join("data/golden").display().to_string();
    let words = command.split_whitespace().map(|word| word.replace("{data}", &data));
    let mut process = Command::new(&program[0]);
    process.args(&program[1..]).args(words).arg("--quiet").current_dir(folder).stdin(Stdio::null());
    let status = process.status().map_err(|e| format!("cannot start {}: {e}", program[0].display()))?;
    Ok(matches!(status.code(), Some(0 | 1)))
}

/// Whether this computer can build for aarch64.
pub fn builds() -> bool {
    has_standard_library() && answers(LINKER)
}

/// Whether the compiler has the standard library of aarch64.
fn has_standard_library() -> bool {
    let mut process = Command::new("rustc");
    let output = process.args(["--print", "target-libdir", "--target", TARGET]).stdin(Stdio::null()).output();
    output.is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}

/// Whether a program can be started.
fn answers(program: &str) -> bool {
    let mut process = Command::new(program);
    process.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    process.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_tools_are_not_found() {
        assert!(answers("cargo") && !answers("no-such-program-of-trundle"));
    }

    /// A filter that matches no test would pass.
    #[test]
    fn every_filter_names_a_module_with_tests() {
        let root = crate::workspace::root();
        for (package, modules) in KERNELS {
            for module in modules {
                let path = root.join("crates").join(package).join("src").join(module.replace("::", "/"));
                let sources = if path.is_dir() {
                    let entries = std::fs::read_dir(&path).unwrap();
                    entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file()).collect()
                } else {
                    vec![path.with_extension("rs")]
                };
                let has_tests = |path: &PathBuf| std::fs::read_to_string(path).unwrap().contains("#[test]");
                assert!(sources.iter().any(has_tests), "{package}, {module}");
            }
        }
    }
}
