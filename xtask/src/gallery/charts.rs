//! Charts of the gallery: the figures of each, drawn by the example `charts` of trundle-viz.

use crate::results::model::{Figure, Measurement, Measurements};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Folder of the charts, relative to the workspace.
pub const FOLDER: &str = "docs/pictures/gallery";

/// A case of the degradation bench, and the strength of the degradation.
type Case = (&'static str, f64);

const RATES: [Case; 4] = [("5 Hz", 5.0), ("10 Hz", 10.0), ("15 Hz", 15.0), ("unchanged", 30.0)];
const BLURS: [Case; 4] =
    [("unchanged", 1.0), ("blur of 7 px", 7.0), ("blur of 15 px", 15.0), ("blur of 31 px", 31.0)];
const DEPTHS: [Case; 3] =
    [("unchanged", 0.0), ("half the depth missing", 50.0), ("0.8 of the depth missing", 80.0)];
const PHOTOS: [Case; 4] = [
    ("unchanged", 0.0),
    ("photo over 10 % of the image", 10.0),
    ("photo over 20 % of the image", 20.0),
    ("photo over 35 % of the image", 35.0),
];

/// Charts as the example reads them.
///
/// # Errors
/// When a measurement or a figure is missing.
pub fn all(measurements: &Measurements) -> Result<Vec<Value>, String> {
    let of = |name: &str| measurements.get(name).ok_or_else(|| format!("no results/{name}.json"));
    let (slam, stages) = (of("slam-degradation")?, of("robot-stages")?);
    Ok(vec![
        pairs(
            "li18.svg",
            "Errors at the goal",
            "cm, deg",
            ["trundle, simulated", "[Li18], real robot"],
            of("poses")?,
        ),
        pairs("hong24.svg", "Time of the manoeuvre", "s", ["trundle", "method of [Hong24]"], of("corridor")?),
        peers("barn.svg", "Mean score of BARN", figure(of("barn")?, "mean score")?),
        curve("slam-rate.svg", "images a second, Hz", false, &RATES, slam)?,
        curve("slam-blur.svg", "blur along the rows, px", false, &BLURS, slam)?,
        curve("slam-depth.svg", "depth missing, %", false, &DEPTHS, slam)?,
        curve("slam-photo.svg", "image behind a moving photo, %", true, &PHOTOS, slam)?,
        shares("stages.svg", "Share of a core", stages),
    ])
}

/// Draws the charts into `folder`.
pub fn draw(root: &Path, measurements: &Measurements, folder: &Path) -> Result<(), String> {
    let input = serde_json::to_vec(&all(measurements)?).map_err(|e| e.to_string())?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut process = Command::new(cargo);
    process.args(["run", "--quiet", "--package", "trundle-viz", "--example", "charts", "--"]).arg(folder);
    process.current_dir(root).stdin(Stdio::piped());
    let mut child = process.spawn().map_err(|e| format!("cannot start cargo: {e}"))?;
    // A child that ends early is reported by its exit status.
    let _ = child.stdin.take().map(|mut stdin| stdin.write_all(&input));
    let status = child.wait().map_err(|e| format!("cargo: {e}"))?;
    status
        .success()
        .then_some(())
        .ok_or_else(|| format!("the example `charts` of trundle-viz: {status}, expected 0"))
}

/// The figure of this name.
fn figure<'a>(measurement: &'a Measurement, name: &str) -> Result<&'a Figure, String> {
    let found = measurement.figures.iter().find(|figure| figure.name == name);
    found.ok_or_else(|| format!("{}: no figure '{name}'", measurement.title))
}

/// A value for JSON; `null` if there is none.
fn number(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// Figure and peer side by side, for each figure with a peer.
fn pairs(file: &str, title: &str, unit: &str, series: [&str; 2], measurement: &Measurement) -> Value {
    let row = |f: &Figure| Some(json!([f.name, [number(f.value), number(f.peer.as_ref()?.value)]]));
    let rows: Vec<Value> = measurement.figures.iter().filter_map(row).collect();
    json!({"file": file, "groups": {"title": title, "unit": unit, "series": series, "rows": rows}})
}

/// A figure and all its peers, one below the other.
fn peers(file: &str, title: &str, figure: &Figure) -> Value {
    let peers = figure.peer.iter().chain(&figure.more_peers);
    let mut rows = vec![json!(["trundle", [number(figure.value)]])];
    rows.extend(peers.map(|peer| json!([peer.name, [number(peer.value)]])));
    json!({"file": file, "groups": {"title": title, "unit": figure.unit, "series": ["score"], "rows": rows}})
}

/// Error of both programs over the strength of a degradation.
fn curve(
    file: &str,
    x: &str,
    log_y: bool,
    cases: &[Case],
    measurement: &Measurement,
) -> Result<Value, String> {
    let mut lines = [Vec::new(), Vec::new()];
    for (case, strength) in cases {
        let error = figure(measurement, &format!("{case}: error"))?;
        let peer = error.peer.as_ref().map_or(f64::NAN, |peer| peer.value);
        lines[0].push(json!([strength, number(error.value)]));
        lines[1].push(json!([strength, number(peer)]));
    }
    let [ours, theirs] = lines;
    let series = json!([["trundle", ours], ["ORB-SLAM3", theirs]]);
    let title = format!("Error over {x}");
    Ok(
        json!({"file": file, "lines": {"title": title, "x": x, "y": "ATE, cm", "log_y": log_y, "series": series}}),
    )
}

/// The share of each stage, the largest first.
fn shares(file: &str, title: &str, measurement: &Measurement) -> Value {
    let of = |f: &Figure| Some((f.name.strip_suffix(": share of a core")?.to_owned(), f.value));
    let mut stages: Vec<(String, f64)> = measurement.figures.iter().filter_map(of).collect();
    stages.sort_by(|a, b| b.1.total_cmp(&a.1));
    let rows: Vec<Value> = stages.iter().map(|(name, share)| json!([name, [number(*share)]])).collect();
    json!({"file": file, "groups": {"title": title, "unit": "% of a core", "series": ["share"], "rows": rows}})
}
