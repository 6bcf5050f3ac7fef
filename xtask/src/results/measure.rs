//! Repeats a measurement: runs its command and reads the figures from its output.

use super::model::{Measurement, Source};
use crate::program;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};

/// Result of a command.
struct Output {
    summary: Value,
    printed: String,
}

/// Runs the command of `measurement`; the same with new figures, commit, machine and date. With `printed`, the folder of an earlier run or a
/// file with its standard output, the command is not run again.
pub fn measure(
    root: &Path,
    name: &str,
    measurement: &Measurement,
    printed: Option<&Path>,
) -> Result<Measurement, String> {
    let output = match printed {
        Some(file) => Output::of_earlier_run(file)?,
        None => run(root, name, &measurement.command)?,
    };
    let mut new = measurement.clone();
    for figure in &mut new.figures {
        if figure.from.is_none() {
            println!("  copied by hand: {name}, {}: {}", figure.name, figure.value);
        }
        if let Some(source) = &figure.from {
            figure.value = read(&output, source).map_err(|e| format!("{name}, {}: {e}", figure.name))?;
        }
        if let Some(peer) = &mut figure.peer
            && let Some(source) = &peer.from
        {
            peer.value = read(&output, source).map_err(|e| format!("{name}, {}: {e}", peer.name))?;
        }
    }
    new.commit = said_by(root, "git", &["rev-parse", "--short", "HEAD"])?;
    new.date = said_by(root, "date", &["+%Y-%m-%d"])?;
    new.machine = machine();
    Ok(new)
}

impl Output {
    /// Output of an earlier run: its folder with `summary.json`, or a file with its standard output.
    fn of_earlier_run(place: &Path) -> Result<Self, String> {
        let read = |file: &Path| {
            std::fs::read_to_string(file).map_err(|e| format!("cannot read {}: {e}", file.display()))
        };
        if !place.is_dir() {
            return Ok(Self { summary: Value::Null, printed: read(place)? });
        }
        let file = place.join("summary.json");
        let summary = serde_json::from_str(&read(&file)?).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(Self { summary, printed: String::new() })
    }
}

fn run(root: &Path, name: &str, command: &str) -> Result<Output, String> {
    let mut words = command.split_whitespace();
    let first = words.next().ok_or("an empty command")?;
    let out = program::scratch(root, "results")?.join(name);
    let mut process = if first == "trundle" {
        let mut process = Command::new(program::release_trundle(root)?);
        process.args(words).arg("--out").arg(&out);
        process
    } else {
        let mut process = Command::new(first);
        process.args(words);
        process
    };
    println!("  {command}");
    let ended = process.current_dir(root).stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let ended = ended.map_err(|e| format!("cannot start `{command}`: {e}"))?;
    if !matches!(ended.status.code(), Some(0 | 1)) {
        return Err(format!("`{command}`: {}, expected exit code 0 or 1", ended.status));
    }
    let summary = std::fs::read(out.join("summary.json")).ok();
    let summary = summary.and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or(Value::Null);
    Ok(Output { summary, printed: String::from_utf8_lossy(&ended.stdout).into_owned() })
}

fn read(output: &Output, source: &Source) -> Result<f64, String> {
    let at = |pointer: &String| {
        let value = output.summary.pointer(pointer).and_then(Value::as_f64);
        value.ok_or(format!("no number at {pointer} of summary.json"))
    };
    let value = match (&source.summary, &source.after) {
        (Some(pointer), _) => at(pointer)?,
        (None, Some(text)) => {
            number_after(&output.printed, text).ok_or(format!("no number after '{text}'"))?
        }
        (None, None) => return Err("`from` names neither `summary` nor `after`".into()),
    };
    let value = if let Some(divisor) = &source.over { value / at(divisor)? } else { value };
    let digits = 4 - (value * source.scale).abs().max(1e-9).log10().ceil() as i32;
    let step = 10f64.powi(digits.clamp(0, 9));
    Ok((value * source.scale * step).round() / step)
}

/// The first number after `text`.
fn number_after(printed: &str, text: &str) -> Option<f64> {
    let (_, rest) = printed.split_once(text)?;
    let words = rest.split(|c: char| c.is_whitespace() || ",;:()|%".contains(c));
    words.filter(|word| !word.is_empty()).find_map(|word| word.parse().ok())
}

fn said_by(root: &Path, command: &str, args: &[&str]) -> Result<String, String> {
    let output = Command::new(command).args(args).current_dir(root).output();
    let output = output.map_err(|e| format!("cannot start {command}: {e}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Cores and processor, if the system reports them.
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    format!("{cores} cores of {}", model.map_or("an unknown processor", |(_, name)| name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_by_pointer_and_by_text() {
        let summary = serde_json::json!({"rows": [{"m": 0.012_345_678}]});
        let output = Output { summary, printed: "median: 4.5 ms, p99 9\n".into() };
        let source = |text: &str| serde_json::from_str::<Source>(text).unwrap();
        assert_eq!(read(&output, &source(r#"{"summary": "/rows/0/m", "scale": 100}"#)).unwrap(), 1.235);
        assert_eq!(read(&output, &source(r#"{"after": "p99"}"#)).unwrap(), 9.0);
        assert!(read(&output, &source(r#"{"after": "p50"}"#)).unwrap_err().contains("p50"));
        assert!(read(&output, &source(r#"{"summary": "/none"}"#)).is_err());
        assert_eq!(read(&output, &source(r#"{"summary": "/rows/0/m", "over": "/rows/0/m"}"#)).unwrap(), 1.0);
        assert!(read(&output, &source(r#"{"summary": "/rows/0/m", "over": "/none"}"#)).is_err());
    }

    #[test]
    fn a_lost_case_has_no_number() {
        let output =
            Output { summary: Value::Null, printed: "case a, error: nan cm\ncase b, error: 2 cm\n".into() };
        let source = |text: &str| Source { summary: None, after: Some(text.into()), over: None, scale: 1.0 };
        assert!(read(&output, &source("case a, error:")).unwrap().is_nan());
        assert_eq!(read(&output, &source("case b, error:")).unwrap(), 2.0);
    }
}
