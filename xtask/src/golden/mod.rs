//! The golden net: runs stored recordings and seeded simulations, and compares hashes of twists, poses, grids, maps and plans with a
//! committed file. It proves that a change does not affect results.

mod cases;
mod digest;
mod expected;
mod recording;

use crate::program;
use crate::workspace::Verdict;
use cases::{CASES, Case};
use digest::Digest;
use expected::Digests;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

/// The committed digests, relative to the workspace.
const GOLDEN_FILE: &str = "data/golden/expected.txt";

/// Cases run side by side. Source: ours.
const CASES_AT_ONCE: usize = 2;

/// Options of the golden net.
pub struct Options {
    /// Write the found digests into the golden file instead of comparing.
    pub update: bool,
    /// Run only cases whose name holds this.
    pub only: Option<String>,
    /// The build profile of the program under test: `release` or `dev`.
    pub profile: String,
}

/// Runs the cases and compares (or, with `update`, rewrites the golden file).
pub fn run(root: &Path, options: &Options) -> Verdict {
    let net = Net {
        root,
        trundle: program::trundle(root, &options.profile)?,
        scratch: program::scratch(root, "golden")?,
    };
    let is_chosen = |case: &&Case| options.only.as_ref().is_none_or(|only| case.name.contains(only));
    let chosen: Vec<&Case> = CASES.iter().filter(is_chosen).collect();
    let (runnable, skipped): (Vec<&Case>, Vec<&Case>) = chosen.iter().partition(|case| net.has_inputs(case));
    for case in &skipped {
        println!("  skipped: {} needs {}", case.name, case.needs.unwrap_or_default());
    }
    let found = net.run_all(&runnable)?;
    let file = root.join(GOLDEN_FILE);
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read {GOLDEN_FILE}: {e}"))?;
    let mut expected = expected::parse(&text).map_err(|e| format!("{GOLDEN_FILE}: {e}"))?;
    let ran = |key: &str| runnable.iter().any(|case| key.split('/').next() == Some(case.name));
    if options.update {
        expected
            .retain(|key, _| !ran(key) && CASES.iter().any(|case| key.split('/').next() == Some(case.name)));
        expected.extend(found);
        std::fs::write(&file, expected::write(&expected))
            .map_err(|e| format!("cannot write {GOLDEN_FILE}: {e}"))?;
        println!("wrote {GOLDEN_FILE}");
        return Ok(true);
    }
    let left_out: Vec<&str> =
        CASES.iter().map(|case| case.name).filter(|name| !ran(&format!("{name}/"))).collect();
    let differences = expected::differences(&expected, &found, &left_out);
    for difference in &differences {
        println!("  {difference}");
    }
    println!(
        "golden: {} quantities of {} cases compared, {} differ, {} cases skipped",
        found.len(),
        runnable.len(),
        differences.len(),
        skipped.len()
    );
    if !differences.is_empty() {
        println!(
            "Outputs are in {}. Build the commit before yours and compare the folders to see where they part. If the \
             change is meant: cargo xtask golden --update, and say why in the commit, with figures.",
            net.scratch.display()
        );
    }
    Ok(differences.is_empty())
}

/// Folders of the cases.
struct Net<'a> {
    root: &'a Path,
    trundle: PathBuf,
    scratch: PathBuf,
}

impl Net<'_> {
    fn has_inputs(&self, case: &Case) -> bool {
        case.needs.is_none_or(|needs| self.root.join(needs).exists())
    }

    /// Runs the cases on [`CASES_AT_ONCE`] threads; the digests by key.
    fn run_all(&self, cases: &[&Case]) -> Result<Digests, String> {
        let queue = Mutex::new(cases.iter());
        let results = Mutex::new(Vec::new());
        let next = || queue.lock().ok().and_then(|mut queue| queue.next().copied());
        std::thread::scope(|scope| {
            for _ in 0..CASES_AT_ONCE {
                scope.spawn(|| {
                    while let Some(case) = next() {
                        let result = self.run_case(case);
                        results.lock().expect("invariant: no thread panics with the lock").push(result);
                    }
                });
            }
        });
        let results = results.into_inner().expect("invariant: no thread panics with the lock");
        Ok(results.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    fn run_case(&self, case: &Case) -> Result<Vec<(String, String)>, String> {
        let out = self.scratch.join(case.name);
        std::fs::create_dir_all(&out).map_err(|e| format!("cannot create {}: {e}", out.display()))?;
        let mut digests = Vec::new();
        for (i, line) in case.commands.iter().enumerate() {
            let code = self.run_command(line, &out)?;
            digests.push((format!("{}/exit-code-{}", case.name, i + 1), format!("{code} 0")));
        }
        for (label, quantity, file) in case.outputs {
            let digest = Digest::of(*quantity, &out.join(file)).map_err(|e| format!("{}: {e}", case.name))?;
            digests.push((format!("{}/{label}", case.name), digest.to_string()));
        }
        println!("  ran {}", case.name);
        Ok(digests)
    }

    /// Runs one command line; its exit code.
    fn run_command(&self, line: &str, out: &Path) -> Result<i32, String> {
        let data = self.root.join("data/golden").display().to_string();
        let shared = self.root.join("../shared/data").display().to_string();
        let out = out.display().to_string();
        let fill =
            |word: &str| word.replace("{out}", &out).replace("{data}", &data).replace("{shared}", &shared);
        let mut command = Command::new(&self.trundle);
        command.args(line.split(' ').map(fill)).args(["--quiet", "--threads", "1"]);
        let output = command.stdin(Stdio::null()).output();
        let output = output.map_err(|e| format!("cannot start {}: {e}", self.trundle.display()))?;
        let error = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(code @ (0 | 1)) => Ok(code),
            code => Err(format!("`trundle {line}`: exit code {code:?}, expected 0 or 1: {error}")),
        }
    }
}
