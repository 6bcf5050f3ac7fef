//! The live map and its corrections.

use crate::filter::{lap, laser, ring};
use trundle_core::{Cell, OccupancyGrid, Pose2, Scan};
use trundle_mapping::{GridMapper, LiveMapper, MapperConfig};

fn config() -> MapperConfig {
    let mut config = MapperConfig::default();
    config.blind_range = 0.0;
    config.max_range = 15.0;
    config
}

/// Scans along a lap, their true poses, and their poses in a drifting estimate.
fn run() -> Vec<(Scan, Pose2, Pose2)> {
    let room = ring();
    let mut drift = Pose2::IDENTITY;
    let lap = lap();
    lap.iter()
        .enumerate()
        .map(|(i, pose)| {
            drift = drift * Pose2::new(0.004, 0.003, 0.0004);
            (laser(&room, *pose, i), *pose, lap[0] * drift * (lap[0].inverse() * *pose))
        })
        .collect()
}

fn differ(a: &OccupancyGrid, b: &OccupancyGrid) -> usize {
    let g = *b.geometry();
    (0..g.len()).filter(|&k| a.at(g.center(g.cell(k))) != b.cells()[k]).count()
}

#[test]
fn a_corrected_map_is_redrawn_in_slices() {
    let run = run();
    let mut live = LiveMapper::new(config()).unwrap();
    for (scan, _, drifted) in &run {
        live.insert(*drifted, scan);
    }
    // The poses of the second half are corrected; those of the first half do not change.
    let middle = run.len() / 2;
    let now = |i: usize| if i < middle { run[i].2 } else { run[i].1 };
    let index = |stamp| run.iter().position(|(scan, _, _)| scan.stamp() == stamp).unwrap();
    let moved = live.correct(|stamp, _| now(index(stamp)));
    assert!(moved > middle / 2 && moved <= run.len() - middle, "{moved}");
    let before = live.grid().clone();
    let (mut slices, mut max) = (0, 0);
    loop {
        // During the redrawing the map in use is still published and receives new scans.
        assert_eq!(live.grid(), &before);
        let done = live.work(20_000);
        max = max.max(done.cells);
        slices += 1;
        if done.left == 0 {
            break;
        }
    }
    assert!(slices > 10 && max < 20_000 + 30_000, "{slices} slices, at most {max} cells");
    // The result equals a map drawn at the corrected poses; scans nearer than 0.1 m to another are not redrawn.
    let mut fresh = GridMapper::new(config()).unwrap();
    for (i, (scan, _, _)) in run.iter().enumerate() {
        fresh.insert(now(i), scan);
    }
    let walls = fresh.grid().cells().iter().filter(|c| **c == Cell::Occupied).count();
    assert!(
        differ(live.grid(), fresh.grid()) < walls / 20,
        "{} of {walls}",
        differ(live.grid(), fresh.grid())
    );
    assert!(differ(&before, fresh.grid()) > walls / 2, "the correction matters");
    assert_eq!(live.work(1000).left, 0);
}

#[test]
fn all_is_redrawn_within_the_calls_asked_for() {
    let run = run();
    let mut live = LiveMapper::new(config()).unwrap();
    for (scan, _, drifted) in &run {
        live.insert(*drifted, scan);
    }
    let truth = |stamp, old| run.iter().find(|(scan, _, _)| scan.stamp() == stamp).map_or(old, |r| r.1);
    // Simulates scans that arrive during the redrawing and are redrawn too.
    let mut all = Vec::new();
    for (calls, budget) in [(20, 0), (20, usize::MAX), (1, 0), (0, 0)] {
        let mut mapper = live.clone();
        assert!(mapper.correct(truth) > 20);
        let (mut done, mut max) = (0, 0);
        while mapper.is_redrawing() {
            let (scan, pose, _) = &run[done % run.len()];
            mapper.insert(*pose, scan);
            let redrawn = mapper.work_within(budget, calls - done.min(calls));
            (done, max) = (done + 1, max.max(redrawn.cells));
        }
        assert_eq!(done, if budget > 0 { 1 } else { calls.max(1) });
        all.push(max);
    }
    assert!(all[0] < all[2] / 10, "the work is shared out: {all:?}");
}

#[test]
fn scans_that_come_while_redrawing_are_not_lost() {
    let run = run();
    let mut live = LiveMapper::new(config()).unwrap();
    let half = run.len() / 2;
    for (scan, _, drifted) in &run[..half] {
        live.insert(*drifted, scan);
    }
    let truth = |stamp, old| run.iter().find(|(scan, _, _)| scan.stamp() == stamp).map_or(old, |r| r.1);
    live.correct(truth);
    for (scan, pose, _) in &run[half..] {
        live.insert(*pose, scan);
        live.work(5_000);
    }
    while live.is_redrawing() {
        live.work(50_000);
    }
    let mut fresh = GridMapper::new(config()).unwrap();
    for (scan, pose, _) in &run {
        fresh.insert(*pose, scan);
    }
    let walls = fresh.grid().cells().iter().filter(|c| **c == Cell::Occupied).count();
    assert!(differ(live.grid(), fresh.grid()) < walls / 20);
}

#[test]
fn every_change_of_the_grid_is_reported() {
    let run = run();
    let mut live = LiveMapper::new(config()).unwrap();
    let mut shown: Option<OccupancyGrid> = None;
    for (i, (scan, pose, drifted)) in run.iter().enumerate().take(120) {
        let revision = live.revision();
        live.insert(*drifted, scan);
        live.mark_free_disc(*drifted, 0.2);
        if i == 80 {
            live.correct(|_, old| old * Pose2::new(0.1, 0.05, 0.01));
        }
        live.work(30_000);
        let grid = live.grid().clone();
        let reported: Vec<_> = live.changes_since(revision).collect();
        if let Some(before) = shown.replace(grid.clone()) {
            let g = *grid.geometry();
            for k in 0..g.len() {
                let cell = g.cell(k);
                let changed = before.at(g.center(cell)) != grid.cells()[k];
                let is_told = reported.iter().any(|(corner, (cols, rows))| {
                    (corner.col..corner.col + cols).contains(&cell.col)
                        && (corner.row..corner.row + rows).contains(&cell.row)
                });
                assert!(!changed || is_told, "scan {i}, {pose:?}: a change that was not reported");
            }
            assert!(
                reported.len() < g.len() / 4096 || !(20..=79).contains(&i),
                "not all of the map changes with a scan"
            );
        }
    }
}

#[test]
fn standing_still_keeps_nothing() {
    let room = ring();
    let mut live = LiveMapper::new(config()).unwrap();
    let scan = laser(&room, lap()[0], 0);
    for _ in 0..200 {
        live.insert(lap()[0], &scan);
    }
    assert_eq!(live.logged_entries(), 1);
}

#[test]
fn the_log_grows_with_the_floor_and_not_with_the_time() {
    let room = ring();
    let lap: Vec<_> = lap().into_iter().enumerate().map(|(i, pose)| (laser(&room, pose, i), pose)).collect();
    let mut live = LiveMapper::new(config()).unwrap();
    let drive = |live: &mut LiveMapper, laps: usize| {
        for _ in 0..laps {
            for (scan, pose) in &lap {
                live.insert(*pose, scan);
                live.mark_free_disc(*pose, 0.2);
            }
        }
        live.logged_entries()
    };
    let once = drive(&mut live, 1);
    let laps = 4096 / once + 2;
    drive(&mut live, laps);
    assert!(
        live.logged_entries() < 4 * 1024,
        "{} of {} things kept",
        live.logged_entries(),
        once * (laps + 1)
    );
    let before = live.grid().clone();
    let shift = Pose2::new(1.0, 0.5, 0.0);
    assert_eq!(live.correct(|_, pose| shift * pose), live.logged_entries());
    while live.is_redrawing() {
        live.work(500_000);
    }
    // A metre and a half a metre are whole cells: the map that was drawn of all scans, moved.
    let g = *before.geometry();
    let moved = |k: usize| live.grid().at(g.center(g.cell(k)) + shift.position());
    let walls = before.cells().iter().filter(|cell| **cell == Cell::Occupied).count();
    let other = (0..g.len()).filter(|&k| moved(k) != before.cells()[k]).count();
    assert!(other < walls / 20, "{other} of {walls}");
}
