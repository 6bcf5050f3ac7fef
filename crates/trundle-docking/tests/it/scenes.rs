//! Laws of scenes: clearance against brute force, the nearest obstacle, grids as scenes.

use crate::common::{any_pose, at, mapped, mirrored, mirrored_footprint, robot, scene, solid, wall};
use crate::contact::{cells, distance, footprint, obstacle, sides};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, OccupancyGrid, Pose2, Vector2};
use trundle_docking::{BlockerKind, Obstacle, ObstacleScene};

/// Random cases of each law.
const CASES: usize = 2_000;

fn obstacles(rng: &mut ChaCha8Rng) -> Vec<Obstacle> {
    (0..rng.random_range(1..6)).map(|_| obstacle(rng)).collect()
}

/// Whether a polygon among the obstacles contains a point.
fn holds(obstacles: &[Obstacle], p: Vector2) -> bool {
    obstacles.iter().any(|obstacle| match obstacle {
        Obstacle::Polygon(corners) => (0..corners.len()).all(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            (b - a).perp(&(p - a)) >= 0.0
        }),
        _ => false,
    })
}

/// A point of the robot's outline.
fn corner(footprint: &Footprint, pose: &Pose2) -> Vector2 {
    match footprint {
        Footprint::Polygon { corners } => pose.transform(corners[0]),
        Footprint::Disc { .. } => pose.position(),
    }
}

/// Clearance within 0.8 m.
fn clearance(scene: &ObstacleScene, footprint: &Footprint, pose: &Pose2) -> f64 {
    scene.clearance(footprint, pose, 0.8).map_or(0.8, |(distance, _)| distance)
}

#[test]
fn clearance_is_the_distance_by_brute_force() {
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    for case in 0..CASES {
        let (footprint, obstacles, pose) =
            (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let inside = holds(&obstacles, corner(&footprint, &pose));
        let brute = if inside { 0.0 } else { distance(&footprint, &pose, &sides(&obstacles)) };
        let expected = brute.clamp(0.0, 0.8);
        let found = clearance(&scene(&obstacles), &footprint, &pose);
        assert!((found - expected).abs() < 1e-9, "case {case}: {found} instead of {expected}");
    }
}

#[test]
fn the_obstacle_that_is_named_is_the_nearest_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(52);
    for case in 0..CASES {
        let (footprint, obstacles, pose) =
            (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let Some((nearest, by)) = scene(&obstacles).clearance(&footprint, &pose, 0.8) else { continue };
        let BlockerKind::Listed(number) = by.thing else { panic!("case {case}: {by:?}") };
        let alone = clearance(&scene(&obstacles[number as usize..=number as usize]), &footprint, &pose);
        assert!(
            (alone - nearest).abs() < 1e-12,
            "case {case}: obstacle {number} is {alone} m away, not {nearest}"
        );
    }
}

#[test]
fn one_more_obstacle_never_increases_the_clearance() {
    let mut rng = ChaCha8Rng::seed_from_u64(53);
    for _ in 0..CASES {
        let (footprint, mut list, pose) = (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let before = clearance(&scene(&list), &footprint, &pose);
        list.push(obstacle(&mut rng));
        assert!(clearance(&scene(&list), &footprint, &pose) <= before);
    }
}

#[test]
fn the_order_of_obstacles_does_not_matter() {
    let mut rng = ChaCha8Rng::seed_from_u64(54);
    for _ in 0..CASES {
        let (footprint, mut list, pose) = (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let before = clearance(&scene(&list), &footprint, &pose);
        list.reverse();
        assert_eq!(clearance(&scene(&list), &footprint, &pose), before);
    }
}

#[test]
fn clearance_is_the_same_in_every_frame_and_in_the_mirror() {
    let mut rng = ChaCha8Rng::seed_from_u64(55);
    for _ in 0..CASES {
        let (footprint, list, pose) = (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let before = clearance(&scene(&list), &footprint, &pose);
        let frame = any_pose(&mut rng, 5.0);
        let moved = scene(&mapped(&list, |p| frame.transform(p)));
        assert!((clearance(&moved, &footprint, &(frame * pose)) - before).abs() < 1e-9);
        let flipped = scene(&mapped(&list, |p| at(p.x, -p.y)));
        let image = clearance(&flipped, &mirrored_footprint(&footprint), &mirrored(pose));
        assert!((image - before).abs() < 1e-9);
    }
}

#[test]
fn moving_by_a_distance_changes_the_clearance_by_at_most_that() {
    let mut rng = ChaCha8Rng::seed_from_u64(56);
    for _ in 0..CASES {
        let (footprint, list, pose) = (footprint(&mut rng), obstacles(&mut rng), any_pose(&mut rng, 1.0));
        let scene = scene(&list);
        let step = any_pose(&mut rng, 0.05).position();
        let moved = Pose2 { x: pose.x + step.x, y: pose.y + step.y, ..pose };
        let change = clearance(&scene, &footprint, &moved) - clearance(&scene, &footprint, &pose);
        // A thin wall may enter a solid, where the clearance drops to zero.
        let near = clearance(&scene, &footprint, &pose).min(clearance(&scene, &footprint, &moved));
        assert!(change.abs() <= step.norm() + 1e-9 || near == 0.0, "{change} by {}", step.norm());
    }
}

#[test]
fn the_cells_of_a_grid_are_as_near_as_their_squares() {
    let mut rng = ChaCha8Rng::seed_from_u64(57);
    for case in 0..CASES / 2 {
        let (grid, squares) = cells(&mut rng);
        let (footprint, pose) = (footprint(&mut rng), any_pose(&mut rng, 1.0));
        let (found, expected) =
            (clearance(&grid, &footprint, &pose), clearance(&scene(&squares), &footprint, &pose));
        assert!((found - expected).abs() < 1e-9, "case {case}: {found} instead of {expected}");
    }
}

#[test]
fn nothing_at_or_beyond_the_reach_is_reported() {
    let disc = Footprint::disc(0.2).unwrap();
    let scene = scene(&[Obstacle::Point(at(1.0, 0.0))]);
    let found = |reach: f64| scene.clearance(&disc, &Pose2::IDENTITY, reach).is_some();
    let gap = 0.8;
    assert!(found(gap + 1e-9) && !found(gap - 1e-9) && !found(0.0));
}

#[test]
fn a_box_is_visited_by_everything_that_crosses_it() {
    let mut rng = ChaCha8Rng::seed_from_u64(58);
    for _ in 0..200 {
        let mut list: Vec<Obstacle> = (0..30).map(|_| obstacle(&mut rng)).collect();
        list.extend((0..300).map(|_| Obstacle::Point(any_pose(&mut rng, 1.0).position())));
        let (center, half) = (any_pose(&mut rng, 0.5).position(), rng.random_range(0.05..0.5));
        let mut visited = vec![0; list.len()];
        scene(&list).visit(center, half, |_, number| visited[number as usize] += 1);
        for (number, obstacle) in list.iter().enumerate() {
            let is_in_box = |p: &Vector2| (p - center).amax() <= half;
            let expected = match obstacle {
                Obstacle::Point(p) => is_in_box(p),
                Obstacle::Segment(a, b) => is_in_box(a) || is_in_box(b),
                Obstacle::Polygon(corners) => corners.iter().any(is_in_box),
            };
            assert!(!expected || visited[number] > 0, "{obstacle:?} is not visited");
        }
    }
}

#[test]
fn a_scene_counts_its_points_and_pieces() {
    let list = [Obstacle::Point(at(0.0, 0.0)), wall((0.0, 1.0), (1.0, 1.0)), solid((2.0, 2.0), (3.0, 3.0))];
    let whole = scene(&list);
    assert_eq!((whole.len(), whole.pieces().len(), whole.points().len()), (6, 5, 1));
    assert!(!whole.is_empty() && scene(&[]).is_empty());
    assert_eq!(scene(&[]).clearance(&robot(), &Pose2::IDENTITY, 100.0), None);
}

#[test]
fn a_solid_is_solid_whichever_way_its_corners_run() {
    let Obstacle::Polygon(mut corners) = solid((-3.0, -3.0), (3.0, 3.0)) else { panic!("a box") };
    corners.reverse();
    let reversed = scene(&[Obstacle::Polygon(corners)]);
    assert_eq!(reversed.clearance(&robot(), &Pose2::IDENTITY, 1.0).map(|(distance, _)| distance), Some(0.0));
    assert_eq!(reversed.clearance(&robot(), &Pose2::new(9.0, 0.0, 0.0), 1.0), None);
}

#[test]
fn unknown_cells_block_only_where_they_are_asked_to() {
    let grid = OccupancyGrid::from_ascii(0.5, "..??\n..??\n..??\n..??").unwrap();
    let pose = Pose2::new(1.5, 1.0, 0.0);
    let seen = |unknown_blocks: bool| {
        let scene = ObstacleScene::from_grid(&grid, at(1.0, 1.0), 3.0, unknown_blocks);
        scene.clearance(&Footprint::KOBUKI, &pose, 0.05).map(|(distance, _)| distance)
    };
    assert_eq!((seen(true), seen(false)), (Some(0.0), None));
}

#[test]
fn a_blocker_is_printed_with_its_kind_and_its_place_in_metres() {
    let point = scene(&[wall((5.0, 5.0), (6.0, 6.0)), Obstacle::Point(at(0.3, -0.1))]);
    let (_, by) = point.clearance(&Footprint::KOBUKI, &Pose2::IDENTITY, 1.0).unwrap();
    assert_eq!(by.to_string(), "obstacle 1 at (0.300, -0.100) m");
    for (thing, text) in [
        (BlockerKind::Occupied, "the occupied cell at (0.300, -0.100) m"),
        (BlockerKind::Unknown, "the unknown cell at (0.300, -0.100) m"),
        (BlockerKind::OffMap, "the end of the map at (0.300, -0.100) m"),
    ] {
        assert_eq!(trundle_docking::Blocker { thing, ..by }.to_string(), text);
    }
}
