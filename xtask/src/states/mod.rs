//! The diagram and the tables of the robot's state machine, read from its table of transitions. `docs/explanation/behaviour.md` holds them
//! between two marks; the rest of that page is written by hand.

mod diagram;
mod table;

use crate::workspace::Verdict;
use std::path::Path;
use table::StateTable;

/// The page.
const PAGE: &str = "docs/explanation/behaviour.md";
/// The line above the generated part.
const BEGIN: &str = "<!-- begin: cargo xtask states -->";
/// The line below the generated part.
const END: &str = "<!-- end: cargo xtask states -->";

/// Writes the generated part of the page; with `check_only`, only reports whether it is up to date.
pub fn run(root: &Path, check_only: bool) -> Verdict {
    let path = root.join(PAGE);
    let old = std::fs::read_to_string(&path).map_err(|e| format!("cannot read {PAGE}: {e}"))?;
    let new = with_part(&old, &part(&StateTable::read(root)?))?;
    if check_only {
        if old != new {
            println!("{PAGE} is not what the table of transitions gives: cargo xtask states");
        }
        return Ok(old == new);
    }
    std::fs::write(&path, new).map_err(|e| format!("cannot write {PAGE}: {e}"))?;
    Ok(true)
}

/// The page with this part between the marks.
fn with_part(page: &str, part: &str) -> Result<String, String> {
    let missing = |mark: &str| format!("{PAGE} has no line '{mark}'");
    let (before, rest) = page.split_once(BEGIN).ok_or_else(|| missing(BEGIN))?;
    let (_, after) = rest.split_once(END).ok_or_else(|| missing(END))?;
    Ok(format!("{before}{BEGIN}\n\n{part}\n{END}{after}"))
}

/// Diagram and tables.
fn part(table: &StateTable) -> String {
    let [states, transitions] = [state_rows(table), transition_rows(table)];
    format!(
        "```mermaid\n{}```\n\n| state | shown as | the robot |\n|---|---|---|\n{states}\n\
         | from | to | reason |\n|---|---|---|\n{transitions}",
        diagram::diagram(table)
    )
}

fn state_rows(table: &StateTable) -> String {
    let shown = |name: &str| table.shown.get(name).map_or("", String::as_str).to_owned();
    let row = |(name, doc): &(String, String)| format!("| {name} | {} | {doc} |\n", shown(name));
    table.states.iter().map(row).collect()
}

fn transition_rows(table: &StateTable) -> String {
    let row = |row: &table::Row| {
        let reason = table.reasons.get(&row.reason).map_or("", String::as_str);
        format!("| {} | {} | **{}** {reason} |\n", row.from.text(), row.to.join(", "), row.reason)
    };
    table.rows.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_what_the_table_of_transitions_gives() {
        assert!(run(&crate::workspace::root(), true).unwrap(), "run `cargo xtask states`");
    }

    #[test]
    fn only_the_part_between_the_marks_changes() {
        let page = format!("# Title\n\n{BEGIN}\nold\n{END}\n\nmore\n");
        assert_eq!(
            with_part(&page, "new\n").unwrap(),
            format!("# Title\n\n{BEGIN}\n\nnew\n\n{END}\n\nmore\n")
        );
        assert!(with_part("# Title\n", "new\n").unwrap_err().contains(BEGIN));
    }

    #[test]
    fn every_state_and_reason_of_the_table_is_explained_and_shown() {
        let table = StateTable::read(&crate::workspace::root()).unwrap();
        let names: Vec<&String> = table.states.iter().map(|(name, _)| name).collect();
        assert!(table.states.iter().all(|(name, doc)| !doc.is_empty() && table.shown.contains_key(name)));
        for row in &table.rows {
            assert!(table.reasons.get(&row.reason).is_some_and(|doc| !doc.is_empty()), "{}", row.reason);
            assert!(
                row.to.iter().chain(row.from.names()).all(|name| names.contains(&name)),
                "{}",
                row.reason
            );
        }
        let used = |reason: &String| table.rows.iter().any(|row| row.reason == *reason);
        assert!(table.reasons.keys().all(used), "a reason that no transition has");
    }
}
