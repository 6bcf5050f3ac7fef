//! Everything that must hold before a change is merged.

use crate::workspace::Verdict;
use crate::{book, fault_scenarios, fuzz, golden, packages, program, replay_check, semver, tidy};
use std::path::Path;
use std::time::Instant;

/// A check that must pass.
struct Step {
    name: &'static str,
    check: fn(&Path) -> Verdict,
}

const TEST: Step = Step {
    name: "cargo test --workspace",
    check: |root| program::cargo(root, &["test", "--workspace"], &[]),
};

const REST: [Step; 13] = [
    Step {
        name: "cargo fmt --all --check",
        check: |root| program::cargo(root, &["fmt", "--all", "--check"], &[]),
    },
    Step {
        name: "cargo clippy --workspace --all-targets -- -D warnings",
        check: |root| {
            program::cargo(root, &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])
        },
    },
    Step { name: "cargo xtask tidy", check: tidy::run },
    Step { name: "cargo xtask semver", check: semver::run },
    Step { name: "cargo xtask packages", check: |root| packages::run(root, false) },
    Step { name: "RUSTDOCFLAGS=-Dwarnings cargo doc --workspace --no-deps", check: book::build::references },
    Step { name: "cargo xtask fuzz --seconds 2", check: fuzz::run_in_ci },
    Step {
        name: "cargo build --release --package trundle-cli --features ros2,mqtt,foxglove,tls",
        check: |root| program::release_trundle(root).map(|_| true),
    },
    Step { name: "cargo xtask golden", check: golden_net },
    Step { name: "trundle demo", check: demo },
    Step { name: "cargo xtask book", check: book::run },
    Step { name: "cargo xtask replay-check", check: |root| replay_check::run(root, 1) },
    Step { name: "cargo xtask fault-scenarios", check: fault_scenarios::run },
];

/// No result has changed unintentionally.
fn golden_net(root: &Path) -> Verdict {
    golden::run(root, &golden::Options { update: false, only: None, profile: "release".into() })
}

/// The README's first command: it must succeed, without contact.
fn demo(root: &Path) -> Verdict {
    let out = program::scratch(root, "demo")?;
    let trundle = program::release_trundle(root)?;
    let is_well = program::ends_well(&trundle, &["demo", "--quiet", "--out", &out.display().to_string()])?;
    if is_well {
        program::drop_recording(&out);
    }
    Ok(is_well)
}

/// Runs the steps in order and stops at the first that fails.
pub fn run(root: &Path, tested: bool) -> Verdict {
    let steps = if tested { None } else { Some(TEST) }.into_iter().chain(REST);
    let mut times = Vec::new();
    let begin = Instant::now();
    for step in steps {
        println!("\n==== {}", step.name);
        let start = Instant::now();
        let verdict = (step.check)(root);
        let seconds = start.elapsed().as_secs_f64();
        times.push((step.name, seconds));
        match verdict {
            Ok(true) => println!("==== ok, {seconds:.1} s"),
            Ok(false) => {
                println!("\n==== FAILED: {} (after {seconds:.1} s)", step.name);
                return Ok(false);
            }
            Err(why) => return Err(format!("{}: {why}", step.name)),
        }
    }
    println!("\n==== all passed");
    for (name, seconds) in times {
        println!("{seconds:8.1} s  {name}");
    }
    println!("{:8.1} s  in all", begin.elapsed().as_secs_f64());
    Ok(true)
}
