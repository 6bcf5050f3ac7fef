//! The particle filter on simulated drives.

use crate::flat_room::FlatRoom;
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Beam, Cell, Pose2, Scan, Stamp, Vector2, wrap_angle};
use trundle_mapping::{
    ParticleConfig, ParticleMapper, PosePriorConfig, Processed, Refusal, ScanUpdate, propagate_trajectory,
};

/// In [-0.5, 0.5), from a hash.
fn noise(i: usize) -> f64 {
    (crate::boxes::mix(i as u64) >> 11) as f64 / 2_f64.powi(53) - 0.5
}

/// A ring of corridors 2 m wide around a block of 16 x 10 m, with niches that distinguish places.
pub fn ring() -> FlatRoom {
    FlatRoom::new(&[
        &[
            (-10.0, -7.0),
            (-3.0, -7.0),
            (-3.0, -7.6),
            (-1.5, -7.6),
            (-1.5, -7.0),
            (10.0, -7.0),
            (10.0, 1.0),
            (10.8, 1.0),
            (10.8, 2.0),
            (10.0, 2.0),
            (10.0, 7.0),
            (4.0, 7.0),
            (4.0, 7.5),
            (2.0, 7.5),
            (2.0, 7.0),
            (-10.0, 7.0),
        ],
        &[
            (-8.0, -5.0),
            (1.0, -5.0),
            (1.0, -4.6),
            (3.0, -4.6),
            (3.0, -5.0),
            (8.0, -5.0),
            (8.0, 5.0),
            (-8.0, 5.0),
        ],
    ])
}

/// Poses 0.25 m apart once around the ring and a bit on.
pub fn lap() -> Vec<Pose2> {
    let corners = [(-9.0, -6.0), (9.0, -6.0), (9.0, 6.0), (-9.0, 6.0), (-9.0, -6.0), (0.0, -6.0)];
    let mut poses: Vec<Pose2> = Vec::new();
    for pair in corners.windows(2) {
        let (a, b) = (Vector2::new(pair[0].0, pair[0].1), Vector2::new(pair[1].0, pair[1].1));
        let heading = (b.y - a.y).atan2(b.x - a.x);
        if let Some(last) = poses.last().copied() {
            let turn = wrap_angle(heading - last.theta);
            poses.extend((1..=6).map(|k| Pose2::new(a.x, a.y, last.theta + turn * f64::from(k) / 6.0)));
        }
        let steps = ((b - a).norm() / 0.25) as i32;
        poses.extend((0..steps).map(|k| {
            let p = a + (b - a) * (f64::from(k) / f64::from(steps));
            Pose2::new(p.x, p.y, heading)
        }));
    }
    poses
}

/// Odometry of the poses: 3 % too short, turning 0.6 deg/m, and noise.
pub fn odometry(poses: &[Pose2]) -> Vec<Pose2> {
    let mut odom = vec![Pose2::IDENTITY];
    for (i, pair) in poses.windows(2).enumerate() {
        let step = pair[0].inverse() * pair[1];
        let distance = step.position().norm();
        let turn = step.theta * 1.02 + 0.01 * distance + 0.01 * noise(3 * i);
        let wrong =
            Pose2::new(step.x * 0.97 + 0.02 * noise(3 * i + 1), step.y + 0.01 * noise(3 * i + 2), turn);
        odom.push(odom[i] * wrong);
    }
    odom
}

pub fn laser(room: &FlatRoom, pose: Pose2, i: usize) -> Scan {
    let beam = |k: usize| {
        let angle = -FRAC_PI_2 + k as f64 * PI / 180.0;
        match room.cast(pose.position(), pose.theta + angle) {
            Some(range) if range < 20.0 => Beam::Hit { range: range + 0.03 * noise(1_000_000 + i * 180 + k) },
            _ => Beam::Unseen,
        }
    };
    let stamp = Stamp::from_nanos(1_000_000_000 + i as i64 * 200_000_000);
    Scan::new(stamp, Vector2::zeros(), -FRAC_PI_2, PI / 180.0, (0..180).map(beam).collect()).unwrap()
}

pub fn config(particles: usize) -> ParticleConfig {
    let mut config = ParticleConfig::default();
    config.particles = particles;
    config
}

fn run(
    room: &FlatRoom,
    poses: &[Pose2],
    odom: &[Pose2],
    config: ParticleConfig,
    seed: u64,
) -> (ParticleMapper, Vec<Processed>) {
    let mut mapper = ParticleMapper::new(config, seed).unwrap();
    let mut done = Vec::new();
    for (i, (pose, odom)) in poses.iter().zip(odom).enumerate() {
        if let ScanUpdate::Processed(p) = mapper.update(*odom, &laser(room, *pose, i)) {
            done.push(p);
        }
    }
    (mapper, done)
}

#[test]
fn a_lap_of_corridors_ends_where_it_began() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let led_astray = (poses[0].inverse() * *poses.last().unwrap()).distance(odom.last().unwrap());
    assert!(led_astray > 2.0, "the odometry alone ends {led_astray} m off");
    for seed in 1..=3 {
        let (mapper, _) = run(&room, &poses, &odom, config(10), seed);
        let stamps: Vec<_> = (0..poses.len()).map(|i| (laser(&room, poses[0], i).stamp(), odom[i])).collect();
        let found = propagate_trajectory(&mapper.trajectory(), &stamps);
        assert_eq!(found.len(), poses.len());
        let mut worst = 0.0_f64;
        for ((_, pose), truth) in found.iter().zip(&poses) {
            worst = worst.max(pose.distance(&(poses[0].inverse() * *truth)));
        }
        // One per cent of the path before the loop closes.
        assert!(worst < 0.6, "seed {seed}: {worst} m off at worst");
        let end = found.last().unwrap().1.distance(&(poses[0].inverse() * *poses.last().unwrap()));
        assert!(end < 0.25, "seed {seed}: {end} m off at the end");
    }
}

/// Once around, each pose up to 1 cm off for itself: as the poses of a SLAM that has closed its loops are.
#[test]
fn poses_that_do_not_drift_are_believed_as_poses() {
    let (room, poses) = (ring(), lap());
    let shake = |i: usize| {
        Pose2::new(
            0.02 * noise(7 * i),
            0.02 * noise(7 * i + 1),
            if i == 0 { 0.0 } else { 0.004 * noise(7 * i + 2) },
        )
    };
    let prior: Vec<Pose2> = poses.iter().enumerate().map(|(i, pose)| *pose * shake(i)).collect();
    let worst = |pose_prior: Option<PosePriorConfig>| {
        let mut config = config(10);
        config.pose_prior = pose_prior;
        let (mapper, _) = run(&room, &poses, &prior, config, 1);
        let mut worst = 0.0_f64;
        for (stamp, pose) in mapper.trajectory() {
            let i = ((stamp - Stamp::from_nanos(1_000_000_000)) / 0.2).round() as usize;
            worst = worst.max(pose.distance(&(prior[0].inverse() * poses[i])));
        }
        worst
    };
    let (believed, dead_reckoned) = (worst(Some(PosePriorConfig::default())), worst(None));
    assert!(believed < 0.04, "{believed} m off at worst");
    assert!(dead_reckoned > 2.0 * believed, "{dead_reckoned} m off by the steps alone");
}

/// A new filter that accepts poses, and the first `count` scans of the lap at poses that are right.
fn believing(count: usize) -> (ParticleMapper, FlatRoom, Vec<Pose2>) {
    let mut config = config(3);
    config.pose_prior = Some(PosePriorConfig::default());
    let (mut mapper, room, poses) = (ParticleMapper::new(config, 1).unwrap(), ring(), lap());
    for (i, pose) in poses.iter().enumerate().take(count) {
        mapper.update(*pose, &laser(&room, *pose, i));
    }
    (mapper, room, poses)
}

#[test]
fn a_wild_pose_is_refused_and_the_next_one_is_not() {
    let (mut mapper, room, poses) = believing(20);
    for (i, x) in [(20, 300.0), (21, -1e5), (22, 1e200), (23, f64::MAX)] {
        let reported = mapper.update(Pose2 { x, ..poses[i] }, &laser(&room, poses[i], i));
        assert_eq!(reported, ScanUpdate::Refused(Refusal::OutOfReach), "{x}");
    }
    assert!(matches!(mapper.update(poses[24], &laser(&room, poses[24], 24)), ScanUpdate::Processed(_)));
    assert!(mapper.pose().distance(&(poses[0].inverse() * poses[24])) < 0.05);
    // At 5 m/s the robot may have reached this pose during the gap.
    let late = laser(&room, poses[60], 60 + 100);
    assert!(matches!(mapper.update(poses[60], &late), ScanUpdate::Processed(done) if done.jumped));
    assert!(mapper.pose().distance(&(poses[0].inverse() * poses[60])) < 0.05);
}

#[test]
fn wild_poses_that_agree_five_times_are_believed() {
    let (mut mapper, room, poses) = believing(20);
    let update = |mapper: &mut ParticleMapper, i: usize, off: f64| {
        mapper.update(Pose2 { x: poses[i].x + off, ..poses[i] }, &laser(&room, poses[i], i))
    };
    let is_refused = |reported: ScanUpdate| reported == ScanUpdate::Refused(Refusal::OutOfReach);
    assert!((20..24).all(|i| is_refused(update(&mut mapper, i, 300.0))));
    assert!(is_refused(update(&mut mapper, 24, -300.0)), "these are others");
    assert!((25..29).all(|i| is_refused(update(&mut mapper, i, 300.0))));
    assert!(matches!(update(&mut mapper, 29, 300.0), ScanUpdate::Processed(done) if done.jumped));
    let distance = mapper.pose().distance(&(poses[0].inverse() * poses[29]));
    assert!((distance - 300.0).abs() < 0.05, "{distance} m");
    // A jump in the odometry is reported explicitly; afterwards the scans determine the pose.
    mapper.kidnapped();
    assert!(!is_refused(update(&mut mapper, 30, 0.0)));
}

#[test]
fn a_saved_filter_goes_on_believing_poses() {
    let (mut whole, room, poses) = believing(40);
    let mut config = config(3);
    config.pose_prior = Some(PosePriorConfig::default());
    let mut again = ParticleMapper::load(&whole.save(), config).unwrap();
    for (i, pose) in poses.iter().enumerate().skip(40).take(40) {
        let scan = laser(&room, *pose, i);
        assert_eq!(whole.update(*pose, &scan), again.update(*pose, &scan));
    }
    assert!(whole.save() == again.save(), "to the byte");
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut mapper, done) = run(&room, &poses[..120], &odom[..120], config(7), 5);
            (mapper.trajectory(), done, mapper.grid().clone())
        })
    };
    let one = on(1);
    assert!(one.1.len() > 60);
    for threads in [2, 5] {
        let other = on(threads);
        assert_eq!(one.0, other.0);
        assert_eq!(one.1, other.1);
        assert_eq!(one.2, other.2);
    }
}

#[test]
fn a_bare_corridor_is_left_to_the_odometry() {
    let room = FlatRoom::corridor();
    let poses: Vec<_> = (0..40).map(|i| Pose2::new(0.25 * f64::from(i) - 8.0, 0.0, 0.0)).collect();
    let odom: Vec<_> = poses.iter().map(|p| Pose2::new(p.x * 1.02, 0.01 * p.x, 0.001 * p.x)).collect();
    let mut near = config(5);
    near.map.max_range = 6.0;
    let (mapper, done) = run(&room, &poses, &odom, near, 1);
    assert!(done[1..].iter().all(|p| p.degenerate == 1), "{done:?}");
    let along = mapper.pose().x - (odom.last().unwrap().x - odom[0].x);
    assert!(along.abs() < 0.6, "the path is that of the odometry: {along} m");
    assert!(mapper.pose().y.abs() < 0.06, "across is the walls': {} m", mapper.pose().y);
    let sigma = done.last().unwrap().covariance[(0, 0)].sqrt();
    assert!(sigma > 0.03 && done.last().unwrap().covariance[(1, 1)].sqrt() < 0.03, "{sigma}");
}

#[test]
fn particles_share_their_maps() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let alone = run(&room, &poses, &odom, config(1), 1).0.bytes();
    let (many, done) = run(&room, &poses, &odom, config(30), 1);
    assert!(done.iter().any(|p| p.resampled));
    assert!(many.bytes() < 20 * alone, "{} of {alone} bytes", many.bytes());
}

#[test]
fn the_live_grid_is_the_best_particles_map_and_says_what_changed() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let mut live = ParticleMapper::new(config(6), 3).unwrap();
    let mut last = None;
    for i in 0..150 {
        live.update(odom[i], &laser(&room, poses[i], i));
        let before = live.revision();
        let grid = live.grid().clone();
        if let Some(old) = last.replace(grid.clone()) {
            let changed: Vec<_> = live.changes_since(before).collect();
            let at = |grid: &trundle_core::OccupancyGrid, p| grid.at(p);
            let geometry = *grid.geometry();
            for k in (0..geometry.len()).step_by(7) {
                let (cell, p) = (geometry.cell(k), geometry.center(geometry.cell(k)));
                let prior = changed.iter().any(|(corner, (cols, rows))| {
                    (corner.col..corner.col + cols).contains(&cell.col)
                        && (corner.row..corner.row + rows).contains(&cell.row)
                });
                assert!(prior || at(&grid, p) == at(&old, p), "a change that was not reported");
            }
        }
    }
    let mut fresh = run(&room, &poses[..150], &odom[..150], config(6), 3).0;
    let (at_once, geometry) = (fresh.grid().clone(), *fresh.grid().geometry());
    for k in 0..geometry.len() {
        let p = geometry.center(geometry.cell(k));
        assert_eq!(at_once.at(p), live.grid().at(p));
    }
    assert!(at_once.cells().iter().filter(|c| **c == Cell::Occupied).count() > 300);
}

#[test]
fn bad_input_is_refused_by_name() {
    let room = ring();
    let scan = |i| laser(&room, lap()[0], i);
    let mut mapper = ParticleMapper::new(config(3), 1).unwrap();
    assert!(matches!(mapper.update(Pose2::IDENTITY, &scan(5)), ScanUpdate::Processed(_)));
    assert_eq!(
        mapper.update(Pose2 { x: f64::NAN, ..Pose2::IDENTITY }, &scan(6)),
        ScanUpdate::Refused(Refusal::NotFinite)
    );
    assert_eq!(
        mapper.update(Pose2::new(1.0, 0.0, 0.0), &scan(4)),
        ScanUpdate::Refused(Refusal::TimeGoesBack)
    );
    assert_eq!(mapper.update(Pose2::new(0.01, 0.0, 0.0), &scan(6)), ScanUpdate::Still);
    // The odometry jumps by 50 m: the pose remains where the scan fits.
    let ScanUpdate::Processed(done) = mapper.update(Pose2::new(50.0, 0.0, 0.0), &scan(7)) else {
        panic!("not processed")
    };
    assert!(done.jumped && mapper.pose().position().norm() < 0.1, "{:?}", mapper.pose());
    // No returns, and another number of beams.
    let blind = Scan::new(scan(8).stamp(), Vector2::zeros(), 0.0, 0.1, vec![Beam::Unseen; 3]).unwrap();
    let ScanUpdate::Processed(done) = mapper.update(Pose2::new(50.5, 0.0, 0.0), &blind) else {
        panic!("not processed")
    };
    assert_eq!(done.degenerate, 3, "no overlap");
    assert_eq!(ParticleMapper::new(config(0), 1).unwrap_err().field, "particles");
}
