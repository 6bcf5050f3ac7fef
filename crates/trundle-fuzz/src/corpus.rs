//! Inputs in addition to the seeds: those of `fuzz/corpus`, and test data if available.

use crate::FuzzTarget;
use std::path::{Path, PathBuf};

/// Longest file that becomes an input \[bytes\]. Mutations of longer files are slow. Source: ours.
const MAX_INPUT_BYTES: u64 = 100_000;

/// The seeds of a target, and its committed inputs.
#[must_use]
pub fn committed_inputs(target: &FuzzTarget) -> Vec<Vec<u8>> {
    let folder: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "..", "fuzz", "corpus", target.name].iter().collect();
    let mut inputs = (target.seeds)();
    inputs.extend(files_of(&folder).iter().filter_map(|path| input(path)));
    inputs
}

/// Files in `folder` and its subfolders with an extension of the target's inputs. Empty if the folder does not exist.
#[must_use]
pub fn inputs_below(folder: &Path, target: &FuzzTarget) -> Vec<Vec<u8>> {
    let all = files_of(folder)
        .into_iter()
        .flat_map(|path| if path.is_dir() { files_of(&path) } else { vec![path] });
    let fits = |path: &PathBuf| {
        let name = path.to_string_lossy();
        target.endings.iter().any(|ending| name.ends_with(ending))
    };
    all.filter(fits).filter_map(|path| input(&path)).collect()
}

fn input(path: &Path) -> Option<Vec<u8>> {
    let is_short = std::fs::metadata(path).is_ok_and(|meta| meta.is_file() && meta.len() <= MAX_INPUT_BYTES);
    if is_short { std::fs::read(path).ok() } else { None }
}

/// The paths in a folder by name.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
