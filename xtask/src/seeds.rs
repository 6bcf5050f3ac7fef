//! The demo on many seeds.

use crate::program;
use crate::workspace::Verdict;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// A run: its exit code, its duration and its summary's numbers and words by key.
struct Run {
    seed: u64,
    code: Option<i32>,
    seconds: f64,
    summary: BTreeMap<String, Value>,
}

/// Runs the demo on each seed, straight to its goal or as in the README, and prints a table with one column per seed. Recordings of failed
/// runs are stored.
pub fn run(root: &Path, seeds: Range<u64>, explores: bool) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let scratch = program::scratch(root, "demo-seeds")?;
    let runs = seeds.map(|seed| one(&trundle, &scratch, seed, explores)).collect::<Result<Vec<_>, _>>()?;
    for line in table(&runs) {
        println!("{line}");
    }
    let missed = runs.iter().filter(|run| run.code != Some(0)).count();
    println!("{} of {} seeds reached their goal untouched", runs.len() - missed, runs.len());
    Ok(missed == 0)
}

fn one(trundle: &Path, scratch: &Path, seed: u64, explores: bool) -> Result<Run, String> {
    let out = scratch.join(seed.to_string());
    let begin = Instant::now();
    let (seed_word, folder) = (seed.to_string(), out.display().to_string());
    let mut args = vec!["demo", "--seed", &seed_word, "--quiet", "--out", &folder];
    args.extend((!explores).then_some("--direct"));
    let code = program::run(trundle, &args)?;
    let mut summary = BTreeMap::new();
    if let Ok(bytes) = std::fs::read(out.join("summary.json")) {
        let value =
            serde_json::from_slice(&bytes).map_err(|e| format!("summary.json of seed {seed}: {e}"))?;
        flatten("", &value, &mut summary);
    }
    if code == Some(0) {
        program::drop_recording(&out);
    }
    Ok(Run { seed, code, seconds: begin.elapsed().as_secs_f64(), summary })
}

/// Numbers, truths and words of a summary by their dotted keys; lists are left out.
fn flatten(at: &str, value: &Value, into: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(object) => {
            for (key, inner) in object {
                let dot = if at.is_empty() { "" } else { "." };
                flatten(&format!("{at}{dot}{key}"), inner, into);
            }
        }
        Value::Array(_) | Value::Null => {}
        scalar => {
            into.insert(at.to_owned(), scalar.clone());
        }
    }
}

fn table(runs: &[Run]) -> Vec<String> {
    let mut rows = vec![row("seed", runs, |run| run.seed.to_string())];
    rows.push(row("exit code", runs, |run| run.code.map_or("killed".into(), |code| code.to_string())));
    rows.push(row("wall clock, s", runs, |run| format!("{:.1}", run.seconds)));
    let mut keys: Vec<&String> = runs.iter().flat_map(|run| run.summary.keys()).collect();
    keys.sort();
    keys.dedup();
    for key in keys {
        let mut cells = row(key, runs, |run| run.summary.get(key).map_or("-".into(), show));
        let numbers: Vec<f64> = runs.iter().filter_map(|run| run.summary.get(key)?.as_f64()).collect();
        if !numbers.is_empty() {
            cells.push(format!("{:.4}", numbers.iter().sum::<f64>() / numbers.len() as f64));
            cells.push(format!("{:.4}", numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max)));
        }
        rows.push(cells);
    }
    rows[0].extend(["mean".into(), "max".into()]);
    align(&rows)
}

fn row(name: &str, runs: &[Run], cell: impl Fn(&Run) -> String) -> Vec<String> {
    std::iter::once(name.to_owned()).chain(runs.iter().map(cell)).collect()
}

fn show(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_f64() => format!("{:.4}", number.as_f64().unwrap_or(f64::NAN)),
        Value::String(text) => text.chars().take(16).collect(),
        other => other.to_string(),
    }
}

fn align(rows: &[Vec<String>]) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate();
        let cells = cells.map(|(c, (s, &w))| if c == 0 { format!("{s:<w$}") } else { format!("{s:>w$}") });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_a_column_a_seed_and_a_row_a_key() {
        let run = |seed, text: &str| {
            let mut summary = BTreeMap::new();
            flatten("", &serde_json::from_str(text).unwrap(), &mut summary);
            Run { seed, code: Some(0), seconds: 1.0, summary }
        };
        let runs =
            [run(1, r#"{"goal": {"error_m": 0.01}, "list": [1]}"#), run(2, r#"{"goal": {"error_m": 0.03}}"#)];
        let table = table(&runs);
        let expected = "goal.error_m  0.0100  0.0300  0.0200  0.0300";
        assert_eq!(table.last().unwrap().split_whitespace().collect::<Vec<_>>().join("  "), expected);
        assert_eq!(table.len(), 4);
    }
}
