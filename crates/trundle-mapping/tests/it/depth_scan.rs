//! Scans from depth images.

use crate::boxes::{Solid, add_noise, depth_of, mount, mounted, rgbd};
use proptest::prelude::*;
use trundle_core::{Beam, DepthImage, Distortion, ObstacleKind, PinholeCamera, Pose2, Pose3, Scan, Vector2};
use trundle_mapping::{DepthScanConfig, DepthScanner, ScanFusion, ScanFusionConfig};

fn small_camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view((128, 106), (1.232, 1.047)).unwrap()
}

fn scan_of(camera: PinholeCamera, base_from_camera: Pose3, depth: DepthImage) -> Scan {
    let mut scanner = DepthScanner::new(camera, base_from_camera, DepthScanConfig::default()).unwrap();
    scanner.scan(&rgbd(depth))
}

fn scan(base_from_camera: Pose3, solids: &[Solid]) -> Scan {
    let camera = small_camera();
    scan_of(camera, base_from_camera, depth_of(&camera, &base_from_camera, solids, true))
}

fn ahead(scan: &Scan) -> Beam {
    let i = (0..scan.beams().len()).min_by(|&a, &b| scan.angle(a).abs().total_cmp(&scan.angle(b).abs()));
    scan.beams()[i.unwrap()]
}

fn share(scan: &Scan, kind: fn(&Beam) -> bool) -> f64 {
    scan.beams().iter().filter(|b| kind(b)).count() as f64 / scan.beams().len() as f64
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_depth_and_mount_makes_a_scan(
        height in 0.2..1.5_f64, yaw in -180.0..180.0_f64, tilt in -89.9..89.9_f64, roll in -180.0..180.0_f64, depth in 0.3..66.0_f32,
    ) {
        let pose = mounted([0.0, 0.0, height], yaw, tilt, roll);
        if let Ok(mut scanner) = DepthScanner::new(small_camera(), pose, DepthScanConfig::default()) {
            let scan = scanner.scan(&rgbd(DepthImage::filled(128, 106, depth)));
            prop_assert!((0..scan.beams().len()).all(|i| scan.sigma(i).is_none_or(f64::is_finite)));
        }
    }

    #[test]
    fn a_wall_is_where_it_is(
        distance in 1.0..5.0_f64, height in 0.2..1.0_f64, tilt in 0.0..20.0_f64, yaw in -30.0..30.0_f64,
        roll in -15.0..15.0_f64, wall in 1.0..2.5_f64,
    ) {
        let base_from_camera = mounted([0.1, -0.05, height], yaw, tilt, roll);
        let scan = scan(base_from_camera, &[Solid::wall(distance, wall)]);
        prop_assert_eq!(scan.origin(), Vector2::new(0.1, -0.05));
        let mut hits = 0;
        for point in scan.hits() {
            hits += 1;
            // A beam is 0.6 deg wide here: across it the slanted wall's range changes by range * tan(slant) * width.
            let slant = (point - scan.origin()).y.atan2((point - scan.origin()).x).tan().abs();
            prop_assert!((point.x - distance).abs() < 0.002 + 0.006 * distance * slant, "{} {}", point, distance);
        }
        let seen_low_enough = height - distance * ((30.0 + tilt - roll.abs()).to_radians()).tan() < 0.5;
        let seen_high_enough = height + distance * ((29.0 - tilt - roll.abs()).to_radians()).tan() > 0.3;
        let near = distance / (35.0 + yaw.abs()).to_radians().cos() < 5.9;
        if seen_low_enough && seen_high_enough && near {
            // The outermost bearings are seen by the lowest pixels alone.
            prop_assert!(hits as f64 > 0.8 * scan.beams().len() as f64, "{} of {}", hits, scan.beams().len());
        }
    }

    #[test]
    fn the_floor_is_never_an_obstacle(
        height in 0.2..1.0_f64, tilt in 0.0..20.0_f64, roll in -5.0..5.0_f64, tilt_error in -0.9..0.9_f64, seed: u64,
    ) {
        let camera = small_camera();
        let truth = mounted([0.05, 0.0, height], 0.0, tilt + tilt_error, roll);
        let mut depth = depth_of(&camera, &truth, &[], true);
        add_noise(&mut depth, seed);
        let believed = mounted([0.05, 0.0, height], 0.0, tilt, roll);
        let scan = scan_of(camera, believed, depth);
        prop_assert_eq!(scan.hits().count(), 0);
        let free = share(&scan, |b| matches!(b, Beam::Free { .. }));
        prop_assert!(free > 0.9, "{} free", free);
    }
}

#[test]
fn noise_does_not_pull_a_wall_nearer() {
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    for distance in [1.0, 2.0, 4.0] {
        let mut depth = depth_of(&camera, &base_from_camera, &[Solid::wall(distance, 2.0)], true);
        add_noise(&mut depth, 5);
        let scan = scan_of(camera, base_from_camera, depth);
        let errors: Vec<f64> = scan.hits().map(|p| p.x - distance).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(errors.len() > 90 && mean.abs() < 0.01, "{distance} m: {mean} m off");
        assert!(errors.iter().all(|e| e.abs() < 0.06), "{distance} m: {errors:?}");
    }
}

#[test]
fn a_table_top_is_found_though_the_floor_goes_on_under_it() {
    let top = Solid::new([2.0, -0.5, 0.40], [3.0, 0.5, 0.44]);
    let scan = scan(mount(0.6, 10.0), &[top, Solid::wall(5.0, 2.0)]);
    let Beam::Hit { range } = ahead(&scan) else { panic!("{:?}", ahead(&scan)) };
    assert!((range - 1.95).abs() < 0.03, "{range}");
}

#[test]
fn objects_that_the_robot_passes_under_or_over_are_not_obstacles() {
    let shelf = Solid::new([2.0, -9.0, 0.7], [3.0, 9.0, 0.8]);
    let carpet = Solid::new([1.5, -9.0, 0.0], [2.5, 9.0, 0.02]);
    let scan = scan(mount(0.45, 8.0), &[shelf, carpet, Solid::wall(4.0, 2.0)]);
    let Beam::Hit { range } = ahead(&scan) else { panic!("{:?}", ahead(&scan)) };
    assert!((range - 3.95).abs() < 0.01, "{range}");
}

#[test]
fn without_depth_nothing_is_known() {
    for black in [0.0, f32::NAN, f32::INFINITY, -1.0] {
        let scan = scan_of(small_camera(), mount(0.45, 8.0), DepthImage::filled(128, 106, black));
        assert!(scan.beams().iter().all(|b| *b == Beam::Unseen));
    }
    let wrong_size = scan_of(small_camera(), mount(0.45, 8.0), DepthImage::filled(10, 10, 2.0));
    assert!(wrong_size.beams().len() > 90 && wrong_size.beams().iter().all(|b| *b == Beam::Unseen));
}

#[test]
fn free_reaches_as_far_as_the_floor_was_seen_and_no_farther() {
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    let mut depth = depth_of(&camera, &base_from_camera, &[], true);
    for z in depth.data_mut().iter_mut().filter(|z| **z > 2.5) {
        *z = 0.0;
    }
    let scan = scan_of(camera, base_from_camera, depth);
    // The outermost bearings are seen by the lowest pixels alone.
    for (i, beam) in scan.beams().iter().enumerate().skip(8).take(scan.beams().len() - 16) {
        let Beam::Free { range } = *beam else { panic!("beam {i}: {beam:?}") };
        // A row of floor is up to 0.15 m deep here.
        let farthest = 2.5 / (scan.angle(i)).cos() / 8.0_f64.to_radians().cos();
        assert!(range < farthest && range > 0.8 * farthest - 0.15, "beam {i}: {range} of {farthest}");
    }
}

#[test]
fn flying_pixels_are_not_obstacles() {
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    let mut depth = depth_of(&camera, &base_from_camera, &[Solid::wall(4.0, 2.0)], true);
    for i in (0..depth.data().len()).step_by(37) {
        depth.data_mut()[i] = 1.0 + (i % 100) as f32 * 0.02;
    }
    let clean = scan(base_from_camera, &[Solid::wall(4.0, 2.0)]);
    let speckled = scan_of(camera, base_from_camera, depth);
    for (a, b) in clean.hits().zip(speckled.hits()) {
        assert!((a - b).norm() < 0.02);
    }
    assert_eq!(clean.hits().count(), speckled.hits().count());
}

#[test]
fn lens_distortion_is_undone() {
    let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
    let camera = PinholeCamera::new((160, 120), (129.3, 129.1), (79.7, 63.8), lens).unwrap();
    let base_from_camera = mount(0.45, 8.0);
    let depth = depth_of(&camera, &base_from_camera, &[Solid::wall(3.0, 2.0)], true);
    let scan = scan_of(camera, base_from_camera, depth);
    assert!(share(&scan, |b| matches!(b, Beam::Hit { .. })) > 0.95);
    assert!(scan.hits().all(|p| (p.x - 3.0).abs() < 0.02));
}

#[test]
fn the_blind_range_is_where_the_view_begins() {
    let at = |height: f64, tilt: f64| {
        DepthScanner::new(PinholeCamera::kinect_v2(), mount(height, tilt), DepthScanConfig::default())
            .unwrap()
            .blind_range()
    };
    assert!((at(0.45, 8.0) - 0.65).abs() < 0.02, "{}", at(0.45, 8.0));
    assert!(at(1.0, 0.0) > 1.6 && at(1.0, 0.0) < 2.1);
    assert!(at(1.0, 30.0) < at(1.0, 10.0));
    assert_eq!(at(0.45, -40.0), 6.0, "it never sees low enough");
}

#[test]
fn a_camera_that_looks_straight_down_still_scans() {
    let base_from_camera = mount(1.5, 90.0);
    let post = Solid::new([0.45, -0.05, 0.0], [0.55, 0.05, 0.5]);
    let scan = scan(base_from_camera, &[post]);
    let nearest = scan.hits().map(|p| p.x).fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.45).abs() < 0.05, "{nearest}");
    assert!(share(&scan, |b| matches!(b, Beam::Free { .. })) > 0.8);
}

#[test]
fn bad_mounts_are_refused_by_name() {
    let refuse =
        |pose| DepthScanner::new(small_camera(), pose, DepthScanConfig::default()).unwrap_err().field;
    assert_eq!(refuse(mount(0.0, 0.0)), "camera height above the floor");
    assert_eq!(refuse(mount(f64::NAN, 0.0)), "base_from_camera");
    let mut config = DepthScanConfig::default();
    config.band_high = 0.01;
    assert_eq!(DepthScanner::new(small_camera(), mount(0.4, 0.0), config).unwrap_err().field, "band_high");
}

#[test]
fn a_remounted_scanner_is_a_new_one() {
    let mut scanner =
        DepthScanner::new(small_camera(), mount(0.45, 8.0), DepthScanConfig::default()).unwrap();
    let there = mounted([0.2, 0.1, 0.9], 20.0, 25.0, 3.0);
    assert!(scanner.remount(mount(-1.0, 0.0)).is_err());
    scanner.remount(there).unwrap();
    let depth = depth_of(&small_camera(), &there, &[Solid::wall(2.5, 2.0)], true);
    assert_eq!(scanner.scan(&rgbd(depth.clone())), scan_of(small_camera(), there, depth));
}

/// The free spans of the beam straight ahead.
fn spans_ahead(scan: &Scan) -> Vec<(f64, f64)> {
    scan.free_spans(index_ahead(scan)).collect()
}

fn index_ahead(scan: &Scan) -> usize {
    (0..scan.beams().len()).min_by(|&a, &b| scan.angle(a).abs().total_cmp(&scan.angle(b).abs())).unwrap()
}

#[test]
fn an_object_without_depth_is_not_cleared_though_the_wall_behind_it_is_seen() {
    // A black box, 0.3 m high: it gives no depth and hides the floor behind it up to 2.35 / (1 - 0.3 / 0.45) m.
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    let black = Solid::new([1.0, -0.3, 0.0], [1.2, 0.3, 0.3]);
    let wall = Solid::wall(5.0, 2.0);
    let mut depth = depth_of(&camera, &base_from_camera, &[black, wall], true);
    let behind = depth_of(&camera, &base_from_camera, &[wall], true);
    for (z, through) in depth.data_mut().iter_mut().zip(behind.data()) {
        *z = if *z < through - 1e-4 { 0.0 } else { *z };
    }
    let scan = scan_of(camera, base_from_camera, depth);
    let Beam::Hit { range } = ahead(&scan) else { panic!("{:?}", ahead(&scan)) };
    assert!((range - 4.95).abs() < 0.01, "{range}");
    // The camera is 0.05 m ahead of the base: the box begins at 0.95 m and hides the floor up to 3 x 1.15 m.
    let spans = spans_ahead(&scan);
    assert_eq!(spans.len(), 2, "{spans:?}");
    assert!(spans[0].0 == 0.0 && (0.8..=0.96).contains(&spans[0].1), "{spans:?}");
    // An object in the gap behind the box, higher than 0.05 m, would be visible from 8/9 of the gap's end on.
    assert!((2.95..3.6).contains(&spans[1].0) && spans[1].1 == range, "{spans:?}");
}

#[test]
fn a_hole_in_the_floor_is_an_obstacle_of_its_own_kind() {
    // The floor ends 2 m ahead of the base and continues 0.5 m lower.
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    let mut depth = depth_of(&camera, &base_from_camera, &[], true);
    let lower = mount(0.95, 8.0);
    let cellar = depth_of(&camera, &lower, &[], true);
    for (i, z) in depth.data_mut().iter_mut().enumerate() {
        let pixel = Vector2::new((i % 128) as f64, (i / 128) as f64);
        let ray = base_from_camera.rotate(camera.unproject(pixel, 1.0));
        let x = 0.05 + f64::from(*z) * ray.x;
        *z = if *z == 0.0 || x > 2.0 { cellar.data()[i] } else { *z };
    }
    let scan = scan_of(camera, base_from_camera, depth);
    let Beam::Hit { range } = ahead(&scan) else { panic!("{:?}", ahead(&scan)) };
    assert_eq!(scan.obstacle(index_ahead(&scan)), Some(ObstacleKind::Drop));
    // A row of floor has a depth of 0.1 m at this range.
    assert!((1.94..2.1).contains(&range), "{range}");
    assert!(spans_ahead(&scan).iter().all(|span| span.1 <= range + 1e-9));
    let drops = (0..scan.beams().len()).filter(|&i| scan.obstacle(i) == Some(ObstacleKind::Drop)).count();
    assert!(drops > 80, "{drops} of {} beams", scan.beams().len());
}

#[test]
fn hanging_obstacles_are_distinguished_from_standing_ones() {
    let top = Solid::new([2.0, -0.5, 0.35], [2.6, 0.5, 0.39]);
    let hanging = scan(mount(0.45, 8.0), &[top, Solid::wall(5.0, 2.0)]);
    assert_eq!(hanging.obstacle(index_ahead(&hanging)), Some(ObstacleKind::Overhang));
    let standing = Solid::new([2.0, -0.5, 0.0], [2.6, 0.5, 0.39]);
    let standing = scan(mount(0.45, 8.0), &[standing, Solid::wall(5.0, 2.0)]);
    assert_eq!(standing.obstacle(index_ahead(&standing)), Some(ObstacleKind::Standing));
    let far = scan(mount(0.45, 8.0), &[Solid::wall(5.0, 2.0)]);
    assert!((0..far.beams().len()).all(|i| far.obstacle(i) != Some(ObstacleKind::Overhang)));
}

#[test]
fn the_noise_of_a_beam_grows_with_the_square_of_its_depth() {
    let sigma = |distance: f64| {
        let scan = scan(mount(0.45, 0.0), &[Solid::wall(distance, 2.0)]);
        scan.sigma(index_ahead(&scan)).unwrap()
    };
    for distance in [1.0, 2.0, 4.0] {
        let z = distance - 0.05;
        assert!(
            (sigma(distance) / (0.003 + 0.0015 * z * z) - 1.0).abs() < 0.1,
            "{} at {z} m",
            sigma(distance)
        );
    }
}

#[test]
fn a_camera_that_never_sees_the_floor_clears_what_its_rays_pass() {
    let scan = scan(mount(0.3, -35.0), &[Solid::wall(4.0, 3.0)]);
    let Beam::Free { range } = ahead(&scan) else { panic!("{:?}", ahead(&scan)) };
    // The lowest ray climbs at 5 deg: it leaves the band, 0.35 m higher, at 4 m.
    assert!(range > 2.5 && range < 4.0, "{range}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_mount_that_is_wrong_by_two_degrees_is_found_and_undone(
        tilt_error in -2.0..2.0_f64, roll_error in -1.5..1.5_f64, height_error in -0.015..0.015_f64, seed: u64,
    ) {
        let camera = small_camera();
        let truth = mounted([0.05, 0.0, 0.45 + height_error], 0.0, 8.0 + tilt_error, roll_error);
        let mut depth = depth_of(&camera, &truth, &[Solid::wall(4.5, 2.0)], true);
        add_noise(&mut depth, seed);
        let mut scanner = DepthScanner::new(camera, mount(0.45, 8.0), DepthScanConfig::default()).unwrap();
        let scan = scanner.scan(&rgbd(depth));
        let floor = scanner.floor().unwrap();
        // With a camera pitched lower than estimated, the floor appears nearer and therefore rising.
        prop_assert!((floor.rise_ahead.atan().to_degrees() - tilt_error).abs() < 0.3, "{:?}", floor);
        prop_assert!((floor.height + height_error).abs() < 0.01, "{:?} {}", floor, height_error);
        for point in scan.hits() {
            prop_assert!((point.x - 4.5).abs() < 0.25, "{} is not on the wall", point);
        }
    }
}

#[test]
fn a_platform_in_front_is_not_taken_for_the_floor() {
    let pallet = Solid::new([0.4, -3.0, 0.0], [2.5, 3.0, 0.14]);
    let found = scan(mount(0.45, 8.0), &[pallet, Solid::wall(5.0, 2.0)]);
    let Beam::Hit { range } = ahead(&found) else { panic!("{:?}", ahead(&found)) };
    assert!(range < 1.0, "{range}");
}

#[test]
fn two_cameras_make_one_scan() {
    let left = mounted([0.05, 0.1, 0.45], 50.0, 8.0, 0.0);
    let right = mounted([0.05, -0.1, 0.45], -50.0, 8.0, 0.0);
    let solids = [Solid::wall(2.0, 2.0), Solid::new([0.8, 0.7, 0.0], [1.0, 0.9, 0.5])];
    let scans = [scan(left, &solids), scan(right, &solids)];
    let mut config = ScanFusionConfig::default();
    config.beams = 360;
    let mut fusion = ScanFusion::new(config).unwrap();
    let fused = fusion.fuse(scans.iter().map(|scan| (Pose2::IDENTITY, scan)));
    assert_eq!((fused.beams().len(), fused.origin()), (360, Vector2::zeros()));
    let seen: Vec<Vector2> = fused.hits().collect();
    let on = |p: &Vector2| {
        let wall = (p.x - 2.0).abs() < 0.06;
        let block = p.x > 0.75 && p.x < 1.05 && p.y > 0.65 && p.y < 0.95;
        wall || block
    };
    assert!(seen.len() > 60 && seen.iter().all(on), "{seen:?}");
    assert!(seen.iter().any(|p| p.y > 0.7 && p.x < 1.1) && seen.iter().any(|p| p.y < -1.0));
    // Floor is free if a sensor observed it: 1 m ahead to the left and right, but not behind the robot or the block.
    let free_at = |p: Vector2| {
        let i = (0..360).min_by(|&a, &b| {
            let off = |i: usize| trundle_core::wrap_angle(fused.angle(i) - p.y.atan2(p.x)).abs();
            off(a).total_cmp(&off(b))
        });
        fused.free_spans(i.unwrap()).any(|(from, to)| (from..=to).contains(&p.norm()))
    };
    assert!(free_at(Vector2::new(0.8, -0.8)) && free_at(Vector2::new(1.5, 0.9)));
    assert!(!free_at(Vector2::new(-1.0, 0.0)) && !free_at(Vector2::new(1.35, 1.2)));
    let mut config = ScanFusionConfig::default();
    config.beams = 3;
    assert_eq!(ScanFusion::new(config).unwrap_err().field, "beams");
    assert!(fusion.fuse([]).beams().iter().all(|beam| *beam == Beam::Unseen));
}

#[test]
fn a_scan_is_written_over_without_another() {
    let (camera, base_from_camera) = (small_camera(), mount(0.45, 8.0));
    let mut scanner = DepthScanner::new(camera, base_from_camera, DepthScanConfig::default()).unwrap();
    let image = |x: f64| rgbd(depth_of(&camera, &base_from_camera, &[Solid::wall(x, 2.0)], true));
    let mut scan = scanner.scan(&image(2.0));
    scanner.scan_into(&image(3.0), &mut scan);
    assert_eq!(scan, scanner.scan(&image(3.0)));
}
