//! The same input gives the same bytes: on one thread, on two, and from the recording.

use crate::workspace::Verdict;
use crate::{compare::compare_folders, program};
use std::path::Path;

/// Runs the demo on one thread, on two, and replays the first; compares the folders.
pub fn run(root: &Path, seed: u64) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let scratch = program::scratch(root, "replay-check")?;
    let seed = seed.to_string();
    let path = |name: &str| scratch.join(name).display().to_string();
    let (one, two, replayed) = (path("one-thread"), path("two-threads"), path("replayed"));
    let recording = scratch.join("one-thread").join("recording.mcap").display().to_string();
    let runs: [&[&str]; 3] = [
        &["demo", "--direct", "--seed", &seed, "--threads", "1", "--quiet", "--record", "all", "--out", &one],
        &["demo", "--direct", "--seed", &seed, "--threads", "2", "--quiet", "--record", "all", "--out", &two],
        &["replay", &recording, "--quiet", "--out", &replayed],
    ];
    for args in runs {
        if !program::ends_well(&trundle, args)? {
            return Ok(false);
        }
    }
    let mut same = true;
    for other in ["two-threads", "replayed"] {
        let differences = compare_folders(&scratch.join("one-thread"), &scratch.join(other))?;
        for difference in &differences {
            println!("one-thread and {other} differ: {difference}");
        }
        same &= differences.is_empty();
    }
    println!(
        "{}",
        if same { "same bytes on one thread, on two, and replayed" } else { "not the same bytes" }
    );
    Ok(same)
}
