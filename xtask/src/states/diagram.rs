//! The state machine as a Mermaid diagram. The states of a search for a path are drawn as one superstate.

use super::table::{From, Row, StateTable};
use crate::settings::snake;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Edges between two nodes, with the reasons of each.
type Edges = BTreeMap<(String, String), Vec<String>>;

/// The superstate of a search for a path.
const SEARCH: &str = "Search";
/// The node of every state.
const ANY: &str = "AnyState";
/// The node of every state with a goal.
const ACTIVE: &str = "AnyStateWithGoal";

/// The diagram. A transition from a state to itself is not drawn.
pub fn diagram(table: &StateTable) -> String {
    let (mut inner, mut outer) = (Edges::new(), Edges::new());
    for row in &table.rows {
        for (from, to) in edges(row, &table.search) {
            let is_inner = table.search.contains(&from) && table.search.contains(&to);
            let edges = if is_inner { &mut inner } else { &mut outer };
            edges.entry((from, to)).or_default().push(snake(&row.reason).replace('_', " "));
        }
    }
    let mut text = String::from("stateDiagram-v2\n");
    let _ =
        writeln!(text, "    state \"any state\" as {ANY}\n    state \"any state with a goal\" as {ACTIVE}");
    let _ = writeln!(text, "    [*] --> {}", table.over.first().map_or("Idle", String::as_str));
    let _ = writeln!(text, "    state {SEARCH} {{");
    write_edges(&mut text, "        ", &inner);
    let _ = writeln!(text, "    }}");
    write_edges(&mut text, "    ", &outer);
    text
}

fn write_edges(text: &mut String, indent: &str, edges: &Edges) {
    for ((from, to), reasons) in edges {
        let _ = writeln!(text, "{indent}{from} --> {to}: {}", reasons.join(", "));
    }
}

/// The edges of a row. All states of the search together are one node, unless the edge stays within the search.
fn edges(row: &Row, search: &[String]) -> Vec<(String, String)> {
    let pairs = |from: &[String], to: &String| -> Vec<(String, String)> {
        let others = from.iter().filter(|from| *from != to);
        others.map(|from| (from.clone(), to.clone())).collect()
    };
    let leads_out = |to: &String| !search.contains(to);
    let is_whole = search.iter().all(|name| row.from.names().contains(name));
    row.to
        .iter()
        .flat_map(|to| match &row.from {
            From::Any => pairs(&[ANY.to_owned()], to),
            From::Active => pairs(&[ACTIVE.to_owned()], to),
            From::Of(names) if is_whole && leads_out(to) => {
                let rest = names.iter().filter(|name| !search.contains(name)).cloned();
                let from: Vec<String> = std::iter::once(SEARCH.to_owned()).chain(rest).collect();
                pairs(&from, to)
            }
            From::Of(names) => pairs(names, to),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn a_search_is_one_node_outwards_and_three_inwards() {
        let table = StateTable {
            states: Vec::new(),
            shown: BTreeMap::new(),
            over: names(&["Idle"]),
            search: names(&["Plan", "Wait"]),
            reasons: BTreeMap::new(),
            rows: vec![
                Row {
                    from: From::Of(names(&["Plan", "Drive", "Wait"])),
                    reason: "PlanFound".into(),
                    to: names(&["Drive"]),
                },
                Row {
                    from: From::Of(names(&["Plan", "Wait"])),
                    reason: "NoPath".into(),
                    to: names(&["Wait"]),
                },
                Row { from: From::Active, reason: "NoProgress".into(), to: names(&["Stopped"]) },
            ],
        };
        let drawn = diagram(&table);
        let edges: Vec<&str> = drawn.lines().filter(|line| line.contains(": ")).map(str::trim).collect();
        let expected = [
            "Plan --> Wait: no path",
            "AnyStateWithGoal --> Stopped: no progress",
            "Search --> Drive: plan found",
        ];
        assert_eq!(edges, expected);
    }
}
