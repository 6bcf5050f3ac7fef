//! Results: `results/*.json` contain every figure; `docs/results.md` is generated from them only.

mod measure;
pub mod model;
pub mod page;

use crate::workspace::Verdict;
use model::{Measurement, Measurements};
use std::path::{Path, PathBuf};

/// The page, relative to the workspace.
pub const PAGE: &str = "docs/results.md";
/// The folder of the measurements, relative to the workspace.
const FOLDER: &str = "results";
/// The file of known limits in that folder: a list of sentences.
const LIMITS: &str = "known-limits.json";

/// Writes the page; repeats the measurements named in `measured` first. With `printed`, the only one takes its figures from this file, the
/// standard output of an earlier run of its command.
pub fn run(root: &Path, measured: &[String], printed: Option<&Path>) -> Verdict {
    if printed.is_some() && measured.len() != 1 {
        return Err(format!("--printed FILE belongs to one --measure NAME, not to {}", measured.len()));
    }
    let mut measurements = read(root)?;
    for name in measured {
        let known = || measurements.keys().cloned().collect::<Vec<_>>().join(", ");
        let old =
            measurements.get(name).ok_or_else(|| format!("no results/{name}.json; there are {}", known()))?;
        let new = measure::measure(root, name, old, printed)?;
        let text = serde_json::to_string_pretty(&new).map_err(|e| e.to_string())? + "\n";
        write(&root.join(FOLDER).join(format!("{name}.json")), &text)?;
        measurements.insert(name.clone(), new);
    }
    let text = render(root)?;
    let lines = text.lines().count();
    write(&root.join(PAGE), &text)?;
    println!("wrote {PAGE}: {} measurements, {lines} lines", measurements.len());
    Ok(lines <= page::MAX_LINES)
}

/// The page generated from the files.
///
/// # Errors
/// When a file cannot be read or is not a measurement.
pub fn render(root: &Path) -> Result<String, String> {
    let limits = root.join(FOLDER).join(LIMITS);
    let text =
        std::fs::read_to_string(&limits).map_err(|e| format!("cannot read {}: {e}", limits.display()))?;
    let limits: Vec<String> =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", limits.display()))?;
    Ok(page::page(&read(root)?, &limits))
}

/// The measurements by name.
///
/// # Errors
/// As [`render`].
pub fn read(root: &Path) -> Result<Measurements, String> {
    let folder = root.join(FOLDER);
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("cannot list {}: {e}", folder.display()))?;
    let paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    let is_measurement = |path: &&PathBuf| {
        path.extension().is_some_and(|e| e == "json") && path.file_name().is_some_and(|name| name != LIMITS)
    };
    paths.iter().filter(is_measurement).map(|path| read_one(path)).collect()
}

fn read_one(path: &Path) -> Result<(String, Measurement), String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    let measurement = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok((name, measurement))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_what_the_files_give() {
        let root = crate::workspace::root();
        let page = std::fs::read_to_string(root.join(PAGE)).unwrap();
        assert!(
            page == render(&root).unwrap(),
            "run `cargo xtask results`: {PAGE} is not made from results/*.json"
        );
        assert!(page.lines().count() <= page::MAX_LINES, "{PAGE} has {} lines", page.lines().count());
    }
}
