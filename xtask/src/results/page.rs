//! The results page: one table a subject, then known limits.

use super::model::{Figure, Goal, Measurement};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Longest page, lines.
pub const MAX_LINES: usize = 150;

const HEAD: &str = "# Results

Written by `cargo xtask results` from `results/*.json`; `cargo xtask results --measure NAME` repeats a measurement. Figures in **bold** miss
their goal. The ratio says how many times better than the peer; above 1 is better. Times depend on the machine, the other figures do not.
How a peer was measured stands in `bench/`; a peer marked * is a published figure, not one of the same run.
";

/// The page for measurements by name, and for limits.
pub fn page(measurements: &BTreeMap<String, Measurement>, limits: &[String]) -> String {
    let mut subjects: BTreeMap<&str, Vec<(&String, &Measurement)>> = BTreeMap::new();
    for (name, measurement) in measurements {
        subjects.entry(&measurement.subject).or_default().push((name, measurement));
    }
    let mut page = HEAD.to_owned();
    for (subject, measurements) in subjects {
        let _ = write!(
            page,
            "\n## {subject}\n\n| what | trundle | goal | peer | ratio |\n|---|---|---|---|---|\n"
        );
        for (_, measurement) in &measurements {
            for figure in &measurement.figures {
                page.push_str(&row(measurement, figure));
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

/// The commands of a subject in one line, by machine.
fn commands(measurements: &[(&String, &Measurement)]) -> String {
    let mut machines: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (name, m) in measurements {
        let entry = format!("`{name}`: `{}`, commit `{}`, {}", m.command, m.commit, m.date);
        machines.entry(&m.machine).or_default().push(entry);
    }
    let parts = machines.iter().map(|(machine, entries)| format!("On {machine}: {}", entries.join("; ")));
    parts.collect::<Vec<_>>().join(". ") + ".\n"
}

fn row(measurement: &Measurement, figure: &Figure) -> String {
    let value = format!("{} {}", figure.value, figure.unit);
    let value = value.trim();
    let is_missed = figure.goal.is_some_and(|goal| !goal.is_kept_by(figure.value));
    let value = if is_missed { format!("**{value}**") } else { value.to_owned() };
    let goal = match figure.goal {
        Some(Goal::AtMost(limit)) => format!("at most {limit}"),
        Some(Goal::AtLeast(limit)) => format!("at least {limit}"),
        None => String::new(),
    };
    let peer = figure.peer.as_ref().map_or(String::new(), |peer| {
        format!("{} {}{}", peer.value, peer.name, if peer.same_run { "" } else { " *" })
    });
    let ratio = figure.ratio().map_or(String::new(), |ratio| format!("{ratio:.1}"));
    let what = format!("{}: {}", measurement.title, figure.name).replace('|', "&#124;");
    format!("| {what} | {value} | {goal} | {peer} | {ratio} |\n")
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
}
