//! Charts from JSON, as SVG files: `cargo run -p trundle-viz --example charts -- FOLDER < charts.json`. `cargo xtask gallery` calls it.
//!
//! The input is a list of charts. `groups` compares series by bars: `{"file": "a.svg", "groups": {"title", "unit", "series": [NAME],
//! "rows": [[LABEL, [VALUE]]]}}`. `lines` shows series over x: `{"file": "b.svg", "lines": {"title", "x", "y", "log_y", "series": [[NAME,
//! [[X, Y]]]]}}`. A value of `null` was not measured.

use serde::Deserialize;
use std::io::{Error, Read, Result, stdin};
use std::path::PathBuf;
use trundle_viz::{Chart, Color, GroupChart};

/// Colours of the series, in their order.
const COLORS: [Color; 4] = [Color::BLUE, Color::VERMILLION, Color::GREEN, Color::PURPLE];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChartFile {
    file: String,
    groups: Option<Groups>,
    lines: Option<Lines>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Groups {
    title: String,
    unit: String,
    series: Vec<String>,
    rows: Vec<(String, Vec<Option<f64>>)>,
}

/// x and y.
type Points = Vec<(f64, Option<f64>)>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Lines {
    title: String,
    x: String,
    y: String,
    log_y: bool,
    series: Vec<(String, Points)>,
}

fn main() -> Result<()> {
    let folder = std::env::args().nth(1).ok_or_else(|| Error::other("usage: charts FOLDER < charts.json"))?;
    let folder = PathBuf::from(folder);
    let mut text = String::new();
    stdin().read_to_string(&mut text)?;
    let charts: Vec<ChartFile> = serde_json::from_str(&text)?;
    std::fs::create_dir_all(&folder)?;
    for chart in charts {
        let svg = match (chart.groups, chart.lines) {
            (Some(groups), None) => group_chart(&groups).to_svg_file(),
            (None, Some(lines)) => line_chart(lines).to_svg_file(),
            _ => return Err(Error::other(format!("{}: expected one of `groups` and `lines`", chart.file))),
        };
        std::fs::write(folder.join(&chart.file), svg)?;
    }
    Ok(())
}

fn color(i: usize) -> Color {
    COLORS[i % COLORS.len()]
}

fn group_chart(groups: &Groups) -> GroupChart {
    let mut chart = GroupChart::new(&groups.title, &groups.unit);
    for (i, name) in groups.series.iter().enumerate() {
        chart = chart.series(name, color(i));
    }
    groups.rows.iter().fold(chart, |chart, (label, values)| {
        let values: Vec<f64> = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
        chart.row(label, &values)
    })
}

fn line_chart(lines: Lines) -> Chart {
    let chart = Chart::new(&lines.title, &lines.x, &lines.y);
    let chart = if lines.log_y { chart.log_y() } else { chart.from_zero() };
    lines.series.into_iter().enumerate().fold(chart, |chart, (i, (name, points))| {
        let points = points.into_iter().map(|(x, y)| (x, y.unwrap_or(f64::NAN))).collect();
        chart.marked(&name, color(i), points)
    })
}
