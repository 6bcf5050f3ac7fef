//! The results page: one table a subject, then known limits.

use super::model::{Figure, Goal, Measurement, Peer};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Longest page, lines. Source: ours.
pub const MAX_LINES: usize = 150;

const HEAD: &str = "# Results

Written by `cargo xtask results` from `results/*.json`; `cargo xtask results --measure NAME` repeats a measurement. Figures in **bold** miss
their goal. The ratio says how many times better than the peer; above 1 is better. Times depend on the machine, the other figures do not.
How a peer was measured stands in `bench/`; a peer marked * is a published figure, not one of the same run.
";

/// The page for measurements by name, and for limits.
pub fn page(measurements: &BTreeMap<String, Measurement>, limits: &[String]) -> String {
    let mut subjects: BTreeMap<&str, Vec<(&String, &Measurement)>> = BTreeMap::new();
    let has_row = |m: &Measurement| m.figures.iter().any(|figure| !figure.detail);
    for (name, measurement) in measurements.iter().filter(|(_, m)| has_row(m)) {
        subjects.entry(&measurement.subject).or_default().push((name, measurement));
    }
    let mut page = HEAD.to_owned();
    for (subject, measurements) in subjects {
        let _ = write!(
            page,
            "\n## {subject}\n\n| what | trundle | goal | peer | ratio |\n|---|---|---|---|---|\n"
        );
        for (_, measurement) in &measurements {
            for figure in measurement.figures.iter().filter(|figure| !figure.detail) {
                page.push_str(&row(&format!("{}: {}", measurement.title, figure.name), figure));
            }
        }
        page.push('\n');
        page.push_str(&commands(&measurements));
    }
    page.push_str("\n## Known limits\n\n");
    for limit in limits {
        let _ = writeln!(page, "- {limit}");
    }
    page
}

/// Commands of measurements in one line, by machine.
pub fn commands(measurements: &[(&String, &Measurement)]) -> String {
    let mut machines: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (name, m) in measurements {
        let entry = format!("`{name}`: `{}`, commit `{}`, {}", m.command, m.commit, m.date);
        machines.entry(&m.machine).or_default().push(entry);
    }
    let parts = machines.iter().map(|(machine, entries)| format!("On {machine}: {}", entries.join("; ")));
    parts.collect::<Vec<_>>().join(". ") + ".\n"
}

/// The row of a figure: name, value, goal, peer, ratio.
pub fn row(what: &str, figure: &Figure) -> String {
    let value = value_text(figure.value, &figure.unit);
    let is_missed = figure.goal.is_some_and(|goal| !goal.is_kept_by(figure.value));
    let value = if is_missed { format!("**{value}**") } else { value };
    let goal = match figure.goal {
        Some(Goal::AtMost(limit)) => format!("at most {limit}"),
        Some(Goal::AtLeast(limit)) => format!("at least {limit}"),
        None => String::new(),
    };
    let (peer, ratio) = figure.peer.as_ref().map_or_else(Default::default, |peer| peer_cells(figure, peer));
    format!("| {} | {value} | {goal} | {peer} | {ratio} |\n", what.replace('|', "&#124;"))
}

/// A peer's value with its name, and the ratio to it.
pub fn peer_cells(figure: &Figure, peer: &Peer) -> (String, String) {
    let mark = if peer.same_run { "" } else { " *" };
    let ratio = figure.ratio_to(peer).map_or(String::new(), |ratio| format!("{ratio:.1}"));
    (format!("{} {}{mark}", value_text(peer.value, ""), peer.name), ratio)
}

/// A value with its unit; without a value, "none".
pub fn value_text(value: f64, unit: &str) -> String {
    if value.is_finite() { format!("{value} {unit}").trim().to_owned() } else { "none".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurement() -> Measurement {
        serde_json::from_str(
            r#"{"subject": "Poses", "title": "ten seeds", "command": "trundle experiment poses", "commit": "abc", "machine": "m",
            "date": "2026-01-01", "figures": [
            {"name": "|dx|", "value": 0.2, "unit": "cm", "goal": {"at_most": 0.4}, "peer": {"name": "[Li18]", "value": 0.5}},
            {"name": "goals", "value": 97, "unit": "", "goal": {"at_least": 100}}]}"#,
        )
        .unwrap()
    }

    #[test]
    fn goals_peers_and_ratios_stand_side_by_side() {
        let page = page(&BTreeMap::from([("poses".to_owned(), measurement())]), &["One limit.".into()]);
        assert!(
            page.contains("| ten seeds: &#124;dx&#124; | 0.2 cm | at most 0.4 | 0.5 [Li18] * | 2.5 |"),
            "{page}"
        );
        assert!(page.contains("| ten seeds: goals | **97** | at least 100 |  |  |"), "{page}");
        assert!(page.contains("On m: `poses`: `trundle experiment poses`, commit `abc`, 2026-01-01.\n"));
        assert!(page.ends_with("- One limit.\n"));
    }

    #[test]
    fn details_are_left_to_the_gallery() {
        let mut detailed = measurement();
        detailed.figures[0].detail = true;
        let page = |m: &Measurement| page(&BTreeMap::from([("poses".to_owned(), m.clone())]), &[]);
        assert!(!page(&detailed).contains("dx") && page(&detailed).contains("goals"));
        detailed.figures[1].detail = true;
        assert!(!page(&detailed).contains("Poses"), "a subject of details alone has no table");
    }

    #[test]
    fn a_figure_without_value_reads_and_shows_as_none() {
        let text = r#"{"name": "error", "value": null, "unit": "cm", "peer": {"name": "P", "value": null, "same_run": true}}"#;
        let figure: Figure = serde_json::from_str(text).unwrap();
        assert_eq!(row("lost", &figure), "| lost | none |  | none P |  |\n");
        assert!(serde_json::to_string(&figure).unwrap().contains(r#""value":null"#));
    }
}
