//! The table of a run's changes of state, for reports.

use crate::StateChange;
use std::ops::Range;
use trundle_runtime::{Reason, ReasonKind, TransitionReason};
use trundle_viz::Table;

/// Number of changes in the longest cycle whose repetitions are one group of rows. Source: ours: planning, driving, waiting, planning
/// again.
const MAX_CYCLE: usize = 4;

/// The columns of the table.
const COLUMNS: [&str; 6] = ["time, s", "last, s", "times", "state", "reason", "place, m, m, deg"];
/// The columns without content in a log without repetitions.
const REPETITION_COLUMNS: Range<usize> = 1..3;

/// The changes of state in order, folded: time, state, reason in words, place. Repetitions of a change, or of a cycle of a few changes, are
/// one row for each change of the cycle, with the number of repetitions and the time of the last one.
pub fn state_log(title: &str, changes: &[StateChange]) -> Table {
    let entries = entries(changes);
    let has_repetitions = entries.iter().any(|entry| entry.count > 1);
    let is_shown = |column: &usize| has_repetitions || !REPETITION_COLUMNS.contains(column);
    let shown = |cells: [String; 6]| -> Vec<String> {
        cells.into_iter().enumerate().filter(|(column, _)| is_shown(column)).map(|(_, cell)| cell).collect()
    };
    let table = Table::new(title, shown(COLUMNS.map(str::to_owned))).wide().folded();
    entries.iter().map(|entry| shown(entry.cells())).fold(table, Table::row)
}

/// Changes that are equal in state and reason.
struct Entry<'a> {
    first: &'a StateChange,
    last: &'a StateChange,
    count: usize,
}

impl Entry<'_> {
    /// Time of the first change, time of the last one and number if there are several, state, reason, place of the first.
    fn cells(&self) -> [String; 6] {
        let StateChange { at, state, transition, pose } = self.first;
        let repeated = |text: String| if self.count > 1 { text } else { String::new() };
        let reason = match state.reason() {
            Some(reason) => reason.to_string(),
            None => transition.map_or_else(String::new, |transition| transition.to_string()),
        };
        // Adding 0 removes the sign of a zero.
        let [x, y] = [pose.x, pose.y].map(|value| (value * 100.0).round() / 100.0 + 0.0);
        [
            format!("{at:.1}"),
            repeated(format!("{:.1}", self.last.at)),
            repeated(self.count.to_string()),
            state.name().to_owned(),
            reason,
            format!("{x:.2}, {y:.2}, {:.0}", pose.theta.to_degrees().round() + 0.0),
        ]
    }
}

/// What makes two changes equal: numbers in the words of a reason do not count.
type Key = (&'static str, Vec<ReasonKind>, Option<TransitionReason>);

fn key(change: &StateChange) -> Key {
    let reason = change.state.reason();
    let transition = change.transition.filter(|_| reason.is_none());
    (change.state.name(), reason.map(Reason::kinds).unwrap_or_default(), transition)
}

fn entries(changes: &[StateChange]) -> Vec<Entry<'_>> {
    let keys: Vec<Key> = changes.iter().map(key).collect();
    let (mut entries, mut from) = (Vec::new(), 0);
    while from < changes.len() {
        let (cycle, count) = repetition(&keys[from..]);
        let end = from + cycle * count;
        let entry = |i| Entry { first: &changes[i], last: &changes[end - cycle + i - from], count };
        entries.extend((from..from + cycle).map(entry));
        from = end;
    }
    entries
}

/// Length of the cycle at the front that covers the most keys, and how often it repeats: 1 and 1 without a repetition. Of cycles that
/// cover equally many keys the shortest.
fn repetition(keys: &[Key]) -> (usize, usize) {
    let repeats = |cycle: usize| {
        let equal = keys.iter().zip(&keys[cycle.min(keys.len())..]).take_while(|(a, b)| a == b).count();
        (cycle, 1 + equal / cycle)
    };
    let repeated = (1..=MAX_CYCLE).rev().map(repeats).filter(|(_, count)| *count > 1);
    repeated.max_by_key(|(cycle, count)| cycle * count).unwrap_or((1, 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Pose2;
    use trundle_runtime::DriveState;
    use trundle_viz::Report;

    fn change(at: f64, state: DriveState, transition: Option<TransitionReason>) -> StateChange {
        StateChange { at, state, transition, pose: Pose2::new(0.5, -0.25, 0.5) }
    }

    fn driving(at: f64) -> StateChange {
        change(at, DriveState::Driving, Some(TransitionReason::PlanFound))
    }

    fn waiting(at: f64, time: f64) -> StateChange {
        let reason = Reason::NoProgress { time, state: "driving", cause: None };
        change(at, DriveState::Waiting { reason }, Some(TransitionReason::NoPath))
    }

    fn rows(changes: &[StateChange]) -> Vec<[String; 6]> {
        entries(changes).iter().map(Entry::cells).collect()
    }

    #[test]
    fn a_change_has_its_time_state_and_reason_in_words() {
        let stopped = change(7.25, DriveState::Stopped { reason: Reason::Interrupted }, None);
        let found = rows(&[driving(1.5), stopped, change(9.0, DriveState::Idle, None)]);
        let interrupted = Reason::Interrupted.to_string();
        let place = "0.50, -0.25, 29";
        let expected = [
            ["1.5", "", "", "driving", "a path is found", place],
            ["7.2", "", "", "stopped", &interrupted, place],
            ["9.0", "", "", "idle", "", place],
        ];
        assert_eq!(found, expected.map(|row| row.map(str::to_owned)));
    }

    #[test]
    fn repetitions_and_cycles_are_counted_whatever_their_numbers() {
        let cycle = |i: i32| [driving(f64::from(i)), waiting(f64::from(i) + 0.5, f64::from(i) + 30.0)];
        let mut changes: Vec<StateChange> = (0..200).flat_map(cycle).collect();
        changes.extend([waiting(300.0, 1.0), waiting(301.0, 2.0), change(302.0, DriveState::Arrived, None)]);
        let found = rows(&changes);
        let shown: Vec<_> = found.iter().map(|row| [0, 1, 2, 3].map(|cell| row[cell].as_str())).collect();
        assert_eq!(shown[0], ["0.0", "199.0", "200", "driving"]);
        assert_eq!(shown[1], ["0.5", "199.5", "200", "waiting"]);
        assert_eq!(shown[2], ["300.0", "301.0", "2", "waiting"]);
        assert_eq!((shown[3], shown.len()), (["302.0", "", "", "arrived"], 4));
        assert!(found[1][4].contains("30 s"), "the words of the first: {}", found[1][4]);
    }

    #[test]
    fn only_a_log_with_repetitions_has_columns_for_them() {
        let html = |changes: &[StateChange]| Report::new("r").table(state_log("t", changes)).to_html();
        let mut moved = driving(2.0);
        moved.pose = Pose2::new(-0.001, -0.0, -0.001);
        let single = html(&[moved]);
        let cells =
            "<td class=\"num\">2.0</td><td>driving</td><td>a path is found</td><td>0.00, 0.00, 0</td>";
        assert!(single.contains(cells) && !single.contains("times"), "{single}");
        let twice = html(&[driving(2.0), driving(3.0)]);
        assert!(
            twice.contains("<td class=\"num\">2.0</td><td class=\"num\">3.0</td><td class=\"num\">2</td>")
        );
    }

    #[test]
    fn every_change_is_counted_once() {
        let pick = |at: usize, code: usize| match code % 3 {
            0 => driving(at as f64),
            1 => waiting(at as f64, 1.0),
            _ => change(at as f64, DriveState::Planning, None),
        };
        for seed in 0..2000_usize {
            let changes: Vec<_> = (0..8).map(|at| pick(at, seed / 3_usize.pow(at as u32 % 7))).collect();
            let total: usize = entries(&changes).iter().map(|entry| entry.count).sum();
            assert_eq!(total, changes.len(), "{seed}");
        }
    }

    #[test]
    fn words_of_a_reason_are_text_in_the_page() {
        let failed = "{\"reason\": \"<script>alert(1)</script> & more\", \"kinds\": [\"no_progress\"]}";
        let reason: Reason = serde_json::from_str(failed).unwrap();
        let changes = [change(1.0, DriveState::Stopped { reason }, None)];
        let html = Report::new("r").table(state_log("<b>", &changes)).to_html();
        assert!(html.contains("<td>&lt;script&gt;alert(1)&lt;/script&gt; &amp; more</td>"), "{html}");
        assert!(!html.contains("<script") && !html.contains("<b>"));
    }
}
