//! Whether two folders hold the same bytes.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The one object of `summary.json` that may differ: it holds times of the wall clock.
const WALL_CLOCK: &str = "wall_clock";

/// The files that may differ, for the same reason: the page of times, and the list of results with their checksums.
const MAY_DIFFER: [&str; 2] = ["timing.html", ".trundle-run"];

/// Differences between the folders, one sentence per file; empty for equal folders. The object `wall_clock` of `summary.json` is ignored.
pub fn compare_folders(a: &Path, b: &Path) -> Result<Vec<String>, String> {
    let (in_a, in_b) = (files(a)?, files(b)?);
    if in_a.is_empty() {
        return Ok(vec![format!("{} is empty", a.display())]);
    }
    let mut differences = Vec::new();
    for name in in_a.union(&in_b) {
        match (in_a.contains(name), in_b.contains(name)) {
            (true, true) if MAY_DIFFER.iter().any(|free| name == Path::new(free)) => {}
            (true, true) => differences.extend(compare_files(name, &a.join(name), &b.join(name))?),
            (true, false) => differences.push(format!("{} is only in {}", name.display(), a.display())),
            _ => differences.push(format!("{} is only in {}", name.display(), b.display())),
        }
    }
    Ok(differences)
}

/// The files of a folder, as paths relative to it.
fn files(folder: &Path) -> Result<BTreeSet<PathBuf>, String> {
    let mut found = BTreeSet::new();
    let mut open = vec![PathBuf::new()];
    while let Some(inner) = open.pop() {
        let at = folder.join(&inner);
        let entries = std::fs::read_dir(&at).map_err(|e| format!("cannot list {}: {e}", at.display()))?;
        for entry in entries {
            let entry = entry.map_err(|e| format!("cannot list {}: {e}", at.display()))?;
            let name = inner.join(entry.file_name());
            if entry.path().is_dir() {
                open.push(name);
            } else {
                found.insert(name);
            }
        }
    }
    Ok(found)
}

fn compare_files(name: &Path, a: &Path, b: &Path) -> Result<Option<String>, String> {
    let read = |path: &Path| std::fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()));
    let (a, b) = (read(a)?, read(b)?);
    if name == Path::new("summary.json") {
        let (a, b) = (without_wall_clock(&a)?, without_wall_clock(&b)?);
        let difference = first_difference("", &a, &b);
        return Ok(difference.map(|difference| format!("summary.json, {difference}")));
    }
    let at = a.iter().zip(&b).position(|(x, y)| x != y);
    let at = at.or_else(|| (a.len() != b.len()).then_some(a.len().min(b.len())));
    Ok(at.map(|at| {
        let line = a[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
        format!("{} at byte {at} (line {line}); {} and {} bytes", name.display(), a.len(), b.len())
    }))
}

fn without_wall_clock(bytes: &[u8]) -> Result<Value, String> {
    let mut summary: Value = serde_json::from_slice(bytes).map_err(|e| format!("summary.json: {e}"))?;
    if let Some(object) = summary.as_object_mut() {
        object.remove(WALL_CLOCK);
    }
    Ok(summary)
}

/// Place of the first difference between two values, and the values.
fn first_difference(at: &str, a: &Value, b: &Value) -> Option<String> {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let keys: BTreeSet<_> = a.keys().chain(b.keys()).collect();
            keys.into_iter().find_map(|key| {
                let missing = Value::String("(missing)".into());
                let of = |map: &serde_json::Map<String, Value>| map.get(key).unwrap_or(&missing).clone();
                first_difference(&format!("{at}.{key}"), &of(a), &of(b))
            })
        }
        _ if a == b => None,
        _ => Some(format!("{at} is {a} and {b}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("xtask-{}-{name}", std::process::id()));
        std::fs::create_dir_all(folder.join("inner")).unwrap();
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
        folder
    }

    fn differences(name: &str, a: &[(&str, &str)], b: &[(&str, &str)]) -> Vec<String> {
        let (a, b) = (folder(&format!("{name}-a"), a), folder(&format!("{name}-b"), b));
        let differences = compare_folders(&a, &b).unwrap();
        std::fs::remove_dir_all(a).unwrap();
        std::fs::remove_dir_all(b).unwrap();
        differences
    }

    #[test]
    fn only_the_wall_clock_may_differ() {
        let summary = |ms: &str, error: &str| {
            format!(r#"{{"goal": {{"error_m": {error}}}, "wall_clock": {{"slam_ms": {ms}}}}}"#)
        };
        let (a, b, c) = (summary("1.5", "0.01"), summary("2.5", "0.01"), summary("1.5", "0.02"));
        assert!(differences("clock", &[("summary.json", &a)], &[("summary.json", &b)]).is_empty());
        for name in MAY_DIFFER {
            assert!(differences(name, &[(name, "1"), ("map", "")], &[(name, "2"), ("map", "")]).is_empty());
            assert_eq!(differences(name, &[(name, "1")], &[("map", "")]).len(), 2);
        }
        let found = differences("goal", &[("summary.json", &a)], &[("summary.json", &c)]);
        assert_eq!(found, ["summary.json, .goal.error_m is 0.01 and 0.02"]);
    }

    #[test]
    fn it_says_which_file_and_where() {
        let found = differences("bytes", &[("inner/a.txt", "one\ntwo\n")], &[("inner/a.txt", "one\ntwa\n")]);
        assert_eq!(found, ["inner/a.txt at byte 6 (line 2); 8 and 8 bytes"]);
        let found = differences("longer", &[("a.txt", "one")], &[("a.txt", "one and more")]);
        assert_eq!(found, ["a.txt at byte 3 (line 1); 3 and 12 bytes"]);
        let found = differences("missing", &[("a.txt", ""), ("b.txt", "")], &[("a.txt", "")]);
        assert!(found.len() == 1 && found[0].starts_with("b.txt is only in"), "{found:?}");
        let found = differences("empty", &[], &[]);
        assert!(found.len() == 1 && found[0].ends_with("is empty"), "an empty folder proves nothing");
    }
}
