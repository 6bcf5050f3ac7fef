//! The table of transitions: every pair of states.

use super::*;
use std::collections::BTreeSet;

const KINDS: [StateKind; 16] = [
    Idle, Initialize, Spin, Plan, Drive, Approach, Face, Confirm, Maneuver, Relative, Station, Wait, Recover,
    Relocalize, Arrived, Stopped,
];
/// A row for each state, a column for each next state, both in the order of `KINDS`; `#`: some reason leads there.
const NEXT: [&str; 16] = [
    "###.....###.....", // idle
    "####....###..#.#", // initialize
    "###.....###..###", // spin
    "###.#...######.#", // plan
    "###.############", // drive
    "###....#####.###", // approach
    "###....#####.###", // face
    "####....###..#.#", // confirm
    "###....####..###", // maneuver
    "###.....###..###", // relative
    "###.....###..###", // station
    "###.#...######.#", // wait
    "###.#...######.#", // recover
    "###.....###..#.#", // relocalize
    "###.....###.....", // arrived
    "###.....###.....", // stopped
];

fn reasons() -> BTreeSet<TransitionReason> {
    TRANSITIONS.iter().map(|row| row.reason).collect()
}

#[test]
fn every_pair_of_states_is_allowed_or_refused_as_drawn() {
    for (from, row) in KINDS.into_iter().zip(NEXT) {
        let allows = |to: StateKind| reasons().iter().any(|why| is_allowed(from, *why, to));
        let drawn: String = KINDS.into_iter().map(|to| if allows(to) { '#' } else { '.' }).collect();
        assert_eq!(drawn, row.replace('*', "#"), "{from:?}");
    }
}
