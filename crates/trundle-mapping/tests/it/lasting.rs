//! Maps that are saved, extended by another run, and used for localization.

use crate::filter::{config, lap, laser, odometry, ring};
use crate::flat_room::FlatRoom;
use trundle_core::{Pose2, Vector2};
use trundle_mapping::{FilterFileError, Localized, Lost, MapLocalizer, ParticleMapper, ScanUpdate};

/// A room of 20 x 20 m with walls and boxes that differ.
pub fn hall() -> FlatRoom {
    FlatRoom::new(&[
        &[(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)],
        &[(-6.0, -7.0), (-4.5, -7.0), (-4.5, -5.0), (-6.0, -5.0)],
        &[(3.0, -8.0), (3.4, -8.0), (3.4, -2.0), (3.0, -2.0)],
        &[(-8.0, 2.0), (-3.0, 2.0), (-3.0, 2.4), (-8.0, 2.4)],
        &[(5.0, 4.0), (7.0, 5.0), (6.5, 6.5), (4.8, 6.0)],
        &[(-1.0, 6.0), (0.5, 7.0), (-1.2, 8.0)],
    ])
}

/// A room with rotational symmetry: it looks the same after half a turn.
fn twins() -> FlatRoom {
    FlatRoom::new(&[
        &[(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)],
        &[(-6.0, -7.0), (-4.0, -7.0), (-4.0, -6.0), (-6.0, -6.0)],
        &[(6.0, 7.0), (4.0, 7.0), (4.0, 6.0), (6.0, 6.0)],
    ])
}

/// A mapped room, its map's origin at `poses[0]`.
pub fn mapped(room: &FlatRoom, poses: &[Pose2]) -> ParticleMapper {
    let mut mapper = ParticleMapper::new(config(5), 1).unwrap();
    for (i, pose) in poses.iter().enumerate() {
        mapper.update(poses[0].inverse() * *pose, &laser(room, *pose, i));
    }
    mapper
}

/// Around in the room with looks to all sides.
pub fn round() -> Vec<Pose2> {
    let corners = [
        (-8.0, -8.5),
        (0.5, -8.5),
        (0.5, 0.0),
        (8.0, 0.0),
        (8.0, 8.0),
        (-2.5, 4.0),
        (-8.5, 8.0),
        (-8.5, -3.0),
    ];
    let mut poses: Vec<Pose2> = Vec::new();
    for pair in corners.windows(2) {
        let (a, b) = (Vector2::new(pair[0].0, pair[0].1), Vector2::new(pair[1].0, pair[1].1));
        let heading = (b.y - a.y).atan2(b.x - a.x);
        poses.extend((0..8).map(|k| Pose2::new(a.x, a.y, heading + f64::from(k) * 0.785)));
        let steps = ((b - a).norm() / 0.35) as i32;
        poses.extend((0..steps).map(|k| {
            let p = a + (b - a) * (f64::from(k) / f64::from(steps));
            Pose2::new(p.x, p.y, heading)
        }));
    }
    poses
}

#[test]
fn a_filter_that_was_saved_goes_on_as_if_it_had_not_been() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let mut through = ParticleMapper::new(config(7), 5).unwrap();
    let mut first = ParticleMapper::new(config(7), 5).unwrap();
    for i in 0..90 {
        through.update(odom[i], &laser(&room, poses[i], i));
        first.update(odom[i], &laser(&room, poses[i], i));
    }
    let bytes = first.save();
    let mut second = ParticleMapper::load(&bytes, config(7)).unwrap();
    assert_eq!(second.save(), bytes);
    for i in 90..150 {
        assert_eq!(
            through.update(odom[i], &laser(&room, poses[i], i)),
            second.update(odom[i], &laser(&room, poses[i], i))
        );
    }
    assert_eq!(through.trajectory(), second.trajectory());
    let (a, b) = (through.grid().clone(), second.grid().clone());
    for k in 0..b.geometry().len() {
        let p = b.geometry().center(b.geometry().cell(k));
        assert_eq!(a.at(p), b.at(p));
    }
}

#[test]
fn bytes_that_are_not_a_map_are_refused_with_the_reason() {
    let (room, poses) = (ring(), lap());
    let bytes = mapped(&room, &poses[..30]).save();
    let load = |bytes: &[u8]| ParticleMapper::load(bytes, config(5)).unwrap_err();
    assert_eq!(load(b"P5 100 100 255"), FilterFileError::Foreign);
    let mut other = bytes.clone();
    other[7] = 9;
    assert_eq!(load(&other).to_string(), "map of version 9, expected 4");
    for at in (16..bytes.len()).step_by(bytes.len() / 60) {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        assert_eq!(load(&flipped), FilterFileError::Checksum, "byte {at}");
    }
    for end in (0..bytes.len()).step_by(bytes.len() / 60) {
        assert!(ParticleMapper::load(&bytes[..end], config(5)).is_err());
    }
    let mut other = config(5);
    other.map.resolution = 0.1;
    assert_eq!(
        ParticleMapper::load(&bytes, other).unwrap_err().to_string(),
        "the map was made with map.resolution 0.05, not 0.1"
    );
}

#[test]
fn a_kidnapped_robot_finds_itself_and_the_map_stays_as_it_was() {
    let (room, poses) = (hall(), round());
    let mapper = mapped(&room, &poses);
    let bytes = mapper.save();
    let origin = poses[0].inverse();
    for (i, pose) in [Pose2::new(-7.0, -2.0, 1.0), Pose2::new(6.0, -6.0, 2.5), Pose2::new(1.0, 3.0, -2.0)]
        .into_iter()
        .enumerate()
    {
        let mut localizer = MapLocalizer::load(&bytes, config(10), 3).unwrap();
        // The robot turns on the spot; its odometry begins at any pose.
        let mut known = None;
        for k in 0..10 {
            let turned = pose * Pose2::new(0.0, 0.0, 0.5 * f64::from(k));
            let odom = Pose2::new(3.0, 1.0, 0.2 + 0.5 * f64::from(k));
            if let Localized::Known { map_from_base, .. } =
                localizer.update(odom, &laser(&room, turned, 5000 * i + k as usize))
            {
                known = Some((map_from_base, origin * turned));
            }
        }
        let (found, truth) = known.expect("found");
        assert!(found.distance(&truth) < 0.05, "{found:?} {truth:?}");
        assert!((found.inverse() * truth).theta.abs() < 0.02, "{found:?} {truth:?}");
    }
    assert_eq!(mapper.save(), bytes);
}

#[test]
fn look_alike_places_are_not_distinguished_by_chance() {
    let (room, poses) = (twins(), round());
    let mapper = mapped(&room, &poses);
    let mut localizer = MapLocalizer::of(&mapper, 1);
    let mut reported = Vec::new();
    for k in 0..12 {
        let pose = Pose2::new(-2.0, -2.0, 0.5 * f64::from(k));
        reported.push(
            localizer.update(Pose2::new(0.0, 0.0, 0.5 * f64::from(k)), &laser(&room, pose, k as usize)),
        );
    }
    assert!(reported.iter().all(|s| matches!(s, Localized::Lost(_))), "{reported:?}");
    assert_eq!(reported.last(), Some(&Localized::Lost(Lost::SeveralPlaces)));
}

#[test]
fn in_a_map_of_another_building_nothing_is_found() {
    let filter = mapped(&hall(), &round());
    let mut localizer = MapLocalizer::of(&filter, 3);
    let elsewhere = FlatRoom::new(&[
        &[(-3.0, -2.5), (4.0, -2.5), (4.0, 1.0), (6.0, 1.0), (6.0, 4.0), (-3.0, 4.0)],
        &[(0.5, 1.0), (1.5, 1.2), (1.2, 2.2)],
        &[(-1.5, -1.5), (-0.9, -1.5), (-0.9, -0.6), (-1.5, -0.6)],
    ]);
    for i in 0..12_u32 {
        let pose = Pose2::new(-2.0 + 0.25 * f64::from(i), 0.2, 0.5 * f64::from(i));
        let found = localizer.update(pose, &laser(&elsewhere, pose, i as usize));
        assert!(!matches!(found, Localized::Known { .. }), "{i}: {found:?}");
    }
}

#[test]
fn another_run_goes_on_with_an_old_map() {
    let (room, poses) = (hall(), round());
    let half = poses.len() / 2;
    let bytes = mapped(&room, &poses[..half]).save();
    let mut mapper = ParticleMapper::load(&bytes, config(5)).unwrap();
    mapper.kidnapped();
    let before = mapper.grid().clone();
    // The second run starts at a place of the first run, with its own odometry.
    let start = half - 20;
    let odom_from_world = Pose2::new(7.0, -3.0, 1.3) * poses[start].inverse();
    let mut found = 0;
    for i in start..poses.len() {
        match mapper.update(odom_from_world * poses[i], &laser(&room, poses[i], 9000 + i)) {
            ScanUpdate::Found(pose) => {
                found += 1;
                assert!(pose.distance(&(poses[0].inverse() * poses[i])) < 0.1, "{pose:?}");
                assert_eq!(mapper.grid().cells(), before.cells(), "nothing was drawn while lost");
            }
            ScanUpdate::Processed(_) | ScanUpdate::Still => {}
            ScanUpdate::Lost(_) => assert_eq!(found, 0),
            ScanUpdate::Paused(pause) => panic!("{pause:?}"),
            ScanUpdate::Refused(refusal) => panic!("{refusal:?}"),
        }
    }
    assert_eq!(found, 1);
    let truth = poses[0].inverse() * *poses.last().unwrap();
    assert!(mapper.pose().distance(&truth) < 0.15, "{:?} {truth:?}", mapper.pose());
    let known = |grid: &trundle_core::OccupancyGrid| {
        grid.cells().iter().filter(|c| **c != trundle_core::Cell::Unknown).count()
    };
    assert!(known(mapper.grid()) > known(&before) + 1000, "the new part was added");
    assert_eq!(mapper.trajectory().first().unwrap().0, {
        let first = mapper.trajectory();
        first[0].0
    });
}

#[test]
fn the_store_of_scans_stays_within_its_bounds() {
    let (room, poses) = (ring(), lap());
    let odom = odometry(&poses);
    let mut small = config(4);
    small.max_scans = 100;
    let mut mapper = ParticleMapper::new(small, 1).unwrap();
    for i in 0..poses.len() {
        mapper.update(odom[i], &laser(&room, poses[i], i));
    }
    let path = mapper.trajectory();
    assert!(path.len() <= 101, "{}", path.len());
    assert!(path.windows(2).all(|pair| pair[0].0 < pair[1].0));
    let end = mapper.pose().distance(&(poses[0].inverse() * *poses.last().unwrap()));
    assert!(end < 0.3, "{end} m off");
}
