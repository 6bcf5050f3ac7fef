//! Runs in a given map that the scans contradict: carried robots, changed rooms, and robots without odometry.

use crate::filter::{config, laser};
use crate::flat_room::FlatRoom;
use crate::lasting::{hall, mapped, round};
use trundle_core::{Cell, OccupancyGrid, Pose2, Vector2};
use trundle_mapping::{MappingPause, ParticleMapper, ScanUpdate};

/// Reports of a run in a given map.
#[derive(Default)]
struct Reports {
    pauses: Vec<MappingPause>,
    found: Vec<Pose2>,
    lost: usize,
}

/// A run of true poses in a map, with odometry that goes on over jumps of the truth at `carried`.
fn go_on(room: &FlatRoom, mapper: &mut ParticleMapper, poses: &[Pose2], carried: &[usize]) -> Reports {
    let (mut reported, mut odom) = (Reports::default(), Pose2::new(3.0, -1.0, 0.7));
    for (i, pose) in poses.iter().enumerate() {
        if i > 0 && !carried.contains(&i) {
            odom = odom * (poses[i - 1].inverse() * *pose);
        }
        match mapper.update(odom, &laser(room, *pose, 20_000 + i)) {
            ScanUpdate::Paused(pause) => reported.pauses.push(pause),
            ScanUpdate::Found(pose) => reported.found.push(pose),
            ScanUpdate::Lost(_) => reported.lost += 1,
            _ => {}
        }
    }
    reported
}

/// Share of the free cells of `before` that are occupied in `after`.
fn drawn_over(before: &OccupancyGrid, after: &OccupancyGrid) -> f64 {
    let (mut free, mut occupied) = (0, 0);
    for k in 0..before.geometry().len() {
        if before.cells()[k] == Cell::Free {
            free += 1;
            let at = before.geometry().center(before.geometry().cell(k));
            occupied += usize::from(after.at(at) == Cell::Occupied);
        }
    }
    f64::from(occupied as u32) / f64::from(free)
}

fn given(room: &FlatRoom) -> (ParticleMapper, OccupancyGrid) {
    let mut mapper = mapped(room, &round());
    mapper.kidnapped();
    let grid = mapper.grid().clone();
    (mapper, grid)
}

#[test]
fn a_carried_robot_draws_nothing_over_the_map_and_is_found_again() {
    let (room, poses) = (hall(), round());
    let (mut mapper, before) = given(&room);
    // The first stretch, then the robot is carried to the last one.
    let (first, last) = (&poses[..60], &poses[poses.len() - 80..]);
    let path: Vec<Pose2> = first.iter().chain(last).copied().collect();
    let reported = go_on(&room, &mut mapper, &path, &[first.len()]);
    assert_eq!(
        (reported.pauses.len(), reported.found.len()),
        (1, 2),
        "{:?} {:?} {}",
        reported.pauses,
        reported.found,
        reported.lost
    );
    let (pause, found) = (reported.pauses[0], reported.found[1]);
    let carried_at = laser(&room, path[60], 20_060).stamp();
    assert!(pause.since >= carried_at && pause.since - carried_at < 2.0, "{pause:?} after {carried_at}");
    assert!(pause.removed_scans >= 4 && reported.lost < 20, "{} {}", pause.removed_scans, reported.lost);
    let truth = |pose: &Pose2| poses[0].inverse() * *pose;
    assert!(path[60..].iter().any(|pose| truth(pose).distance(&found) < 0.1), "{found:?}");
    assert!(mapper.pose().distance(&truth(path.last().unwrap())) < 0.15, "{:?}", mapper.pose());
    let over = drawn_over(&before, mapper.grid());
    assert!(over < 0.002, "{over} of the free cells");
    // The trajectory lacks the scans that were taken out, and has those before and after.
    let trajectory = mapper.trajectory();
    assert!(trajectory.iter().all(|(stamp, pose)| {
        let i = ((stamp.as_secs() - 1.0) / 0.2).round() as usize - 20_000;
        truth(&path[i]).distance(pose) < 0.2
    }));
}

#[test]
fn changed_furniture_is_drawn_and_pauses_nothing() {
    let (room, poses) = (hall(), round());
    let (mut mapper, _) = given(&room);

    let changed = FlatRoom::new(&[
        &[(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)],
        &[(-6.0, -7.0), (-4.5, -7.0), (-4.5, -5.0), (-6.0, -5.0)],
        &[(3.0, -8.0), (3.4, -8.0), (3.4, -2.0), (3.0, -2.0)],
        &[(-8.0, 2.0), (-3.0, 2.0), (-3.0, 2.4), (-8.0, 2.4)],
        // Moved by a metre, and a new cupboard.
        &[(5.0, 3.0), (7.0, 4.0), (6.5, 5.5), (4.8, 5.0)],
        &[(-1.0, 6.0), (0.5, 7.0), (-1.2, 8.0)],
        &[(8.8, -6.0), (10.0, -6.0), (10.0, -3.0), (8.8, -3.0)],
    ]);
    let reported = go_on(&changed, &mut mapper, &poses, &[]);
    assert_eq!((reported.pauses.len(), reported.found.len()), (0, 1), "{:?}", reported.pauses);
    let truth = poses[0].inverse() * *poses.last().unwrap();
    assert!(mapper.pose().distance(&truth) < 0.15, "{:?} {truth:?}", mapper.pose());
    let front = poses[0].inverse();
    let grid = mapper.grid();
    let is_drawn = |y: f64| grid.at(front.transform(Vector2::new(9.2, y))) == Cell::Occupied;
    assert!((0..5).any(|k| is_drawn(-3.1 + 0.05 * f64::from(k))), "the cupboard");
}

#[test]
fn a_robot_without_odometry_is_mapped_by_its_scans() {
    let (room, poses) = (hall(), round());
    let mut mapper = ParticleMapper::new(config(10), 1).unwrap();
    // Between the poses of `round` the robot moves on evenly: up to 0.12 m and 8 deg a scan, at 5 Hz.
    let path: Vec<Pose2> = poses
        .windows(2)
        .take(120)
        .flat_map(|pair| {
            (0..6).map(|k| pair[0].interpolate(&pair[1], f64::from(k) / 6.0)).collect::<Vec<_>>()
        })
        .collect();
    let mut processed = 0;
    for (i, pose) in path.iter().enumerate() {
        let update = mapper.update(Pose2::IDENTITY, &laser(&room, *pose, i));
        processed += usize::from(matches!(update, ScanUpdate::Processed(_)));
    }
    assert!(processed > path.len() / 6, "{processed} of {}", path.len());
    let (stamp, last) = *mapper.trajectory().last().unwrap();
    let i = ((stamp.as_secs() - 1.0) / 0.2).round() as usize;
    let off = (path[0].inverse() * path[i]).distance(&last);
    assert!(off < 0.25, "{off} m off");
}
