//! The built-in scenes: free and reachable goals.

mod files;
mod office;
mod reachable_floor;

use reachable_floor::ReachableFloor;
use trundle_core::{Cell, Footprint, Pose2, Vector2};
use trundle_sim::{HeightBand, Scene};

/// Obstacles for a Kobuki.
fn band() -> HeightBand {
    HeightBand::new(0.012, 0.6).unwrap()
}

fn clearance(scene: &Scene, robot: &Footprint, pose: Pose2) -> f64 {
    scene.world.clearance(robot, pose, band()).unwrap()
}

/// Properties of every seed of a scene.
struct Promise {
    name: &'static str,
    seeds: u64,
    /// Free around a Kobuki at start and goal, m.
    clearance: f64,
    /// Half of the width of the narrowest passage, m.
    length: f64,
    /// Resolution of the true grid, m.
    resolution: f64,
    /// Reachable places near the goal.
    places: &'static [[f64; 2]],
}

const PROMISES: [Promise; 10] = [
    Promise { name: "demo", seeds: 30, clearance: 0.35, length: 0.40, resolution: 0.02, places: &[] },
    Promise { name: "obstacles", seeds: 30, clearance: 0.35, length: 0.40, resolution: 0.02, places: &[] },
    Promise {
        name: "room",
        seeds: 10,
        clearance: 0.40,
        length: 0.55,
        resolution: 0.02,
        places: &STABILISATION,
    },
    Promise { name: "corridor-a", seeds: 10, clearance: 0.12, length: 0.18, resolution: 0.02, places: &[] },
    Promise { name: "corridor-b", seeds: 10, clearance: 0.12, length: 0.18, resolution: 0.02, places: &[] },
    Promise { name: "corridor-c", seeds: 10, clearance: 0.12, length: 0.18, resolution: 0.02, places: &[] },
    Promise { name: "corridor-d", seeds: 10, clearance: 0.12, length: 0.18, resolution: 0.02, places: &[] },
    Promise {
        name: "office",
        seeds: 12,
        clearance: 0.3,
        length: 0.40,
        resolution: 0.04,
        // Inside of each of the six rooms.
        places: &[[3.5, 2.4], [8.7, 3.0], [13.5, 2.4], [3.75, 15.0], [8.75, 15.0], [13.6, 15.6]],
    },
    Promise {
        name: "house",
        seeds: 12,
        clearance: 0.3,
        length: 0.40,
        resolution: 0.025,
        // Bedroom, bath, study, hall, living room, kitchen.
        places: &[[4.2, 1.9], [1.3, 6.0], [4.3, 5.8], [4.0, 4.3], [8.4, 1.0], [7.6, 6.6]],
    },
    Promise {
        name: "warehouse",
        seeds: 12,
        clearance: 0.35,
        length: 0.40,
        resolution: 0.06,
        // Every aisle, the open area.
        places: &[[1.6, 15.0], [7.3, 15.0], [12.7, 15.0], [18.1, 15.0], [26.5, 14.5]],
    },
];

/// The start poses of \[Li18\], section 5.
const STABILISATION: [[f64; 2]; 8] =
    [[0.0, 2.4], [2.4, 2.4], [2.4, 0.0], [2.4, -2.4], [0.0, -2.4], [-2.4, -2.4], [-2.4, 0.0], [-2.4, 2.4]];

fn check(promise: &Promise, seed: u64) {
    let name = promise.name;
    let scene = Scene::by_name(name, seed).unwrap();
    for pose in [scene.start, scene.goal] {
        let free = clearance(&scene, &Footprint::KOBUKI, pose);
        assert!(free >= promise.clearance, "{name} {seed}: {free} m at {pose:?}");
    }
    let grid = scene.world.true_grid(promise.resolution, band()).unwrap();
    let reachable = ReachableFloor::new(&grid, promise.length, scene.start.position());
    let places = promise.places.iter().map(|[x, y]| Vector2::new(*x, *y));
    for place in places.chain([scene.goal.position()]) {
        assert!(reachable.reaches(place), "{name} {seed}: {place} on ways of {} m", 2.0 * promise.length);
    }
}

#[test]
fn every_seeds_goal_and_every_room_is_free_and_reachable() {
    for promise in PROMISES {
        for seed in 0..promise.seeds {
            check(&promise, seed);
        }
    }
    let promised = PROMISES.map(|promise| promise.name);
    assert!(Scene::NAMES.iter().all(|name| promised.contains(name)));
}

fn is_straight_way_blocked(scene: &Scene) -> bool {
    let robot = Footprint::disc(0.05).unwrap();
    (0..=200).any(|i| {
        let pose = scene.start.interpolate(&scene.goal, f64::from(i) / 200.0);
        clearance(scene, &robot, pose) <= 0.0
    })
}

#[test]
fn goals_to_drive_to_are_far_and_hidden() {
    for (name, seed) in ["demo", "obstacles", "office", "house", "warehouse"]
        .into_iter()
        .flat_map(|name| (0..30).map(move |seed| (name, seed)))
    {
        let scene = Scene::by_name(name, seed).unwrap();
        assert!(scene.start.distance(&scene.goal) >= 5.0, "{name} {seed}");
        assert!(is_straight_way_blocked(&scene), "{name} {seed}");
    }
}

#[test]
fn the_room_is_the_stage_of_the_papers_stabilisation() {
    let scene = Scene::by_name("room", 3).unwrap();
    assert_eq!(scene.start.theta, 0.0);
    assert!(STABILISATION.contains(&[scene.start.x, scene.start.y]), "one of the eight");
    assert_eq!(scene.goal, Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
    for [x, y] in STABILISATION {
        assert!(clearance(&scene, &Footprint::KOBUKI, Pose2::new(x, y, 0.0)) > 0.42);
    }
    let (low, high) = scene.world.bounds();
    assert!((low + high).xy().norm() < 1e-12, "its middle is the origin");
}

/// The corridors are those of [Hong24]: position of the goal, and free space around the paper's robot.
#[test]
fn the_corridors_are_free_and_blocked_where_the_paper_says() {
    let corner = |x: f64, y: f64| Vector2::new(x, y);
    let robot =
        Footprint::polygon(vec![corner(0.3, 0.2), corner(-0.3, 0.2), corner(-0.3, -0.2), corner(0.3, -0.2)])
            .unwrap();
    // Whether 0.3 m ahead is free on the left, at the robot's position, and on the right, at the goal.
    for (name, left, right, behind) in [
        ("corridor-a", true, true, 0.0),
        ("corridor-b", false, false, 0.0),
        ("corridor-c", false, true, 0.0),
        ("corridor-d", true, false, 0.5),
    ] {
        for seed in 0..10 {
            let scene = Scene::by_name(name, seed).unwrap();
            let goal = scene.start_from_goal();
            assert!((goal.x + behind).abs() < 1e-9 && goal.y < -0.3 && goal.theta == 0.0, "{name}: {goal:?}");
            for pose in [scene.start, scene.goal] {
                assert!(clearance(&scene, &robot, pose) > 0.08, "{name} {seed}");
            }
            let ahead = |aside: f64| scene.start * Pose2::new(0.3, aside, 0.0);
            assert_eq!(clearance(&scene, &robot, ahead(0.0)) > 0.0, left, "{name} {seed}");
            assert_eq!(clearance(&scene, &robot, ahead(goal.y)) > 0.0, right, "{name} {seed}");
        }
    }
}

#[test]
fn seeds_vary_scenes_and_scenes_stay_themselves() {
    for name in Scene::NAMES {
        let solids = |seed| Scene::by_name(name, seed).unwrap().world.solids().to_vec();
        assert_eq!(solids(4), solids(4), "{name}");
        assert!((5..9).any(|seed| solids(4) != solids(seed)), "{name}");
    }
    assert!(Scene::by_name("moon", 1).unwrap_err().to_string().contains("warehouse"));
}

#[test]
fn low_tables_stop_the_robot_and_high_ones_do_not() {
    let scene = Scene::by_name("demo", 1).unwrap();
    let touches = |x, y| scene.world.collides(&Footprint::KOBUKI, Pose2::new(x, y, 0.0), band()).unwrap();
    assert!(touches(2.3, 2.75), "low table, 0.45 m");
    assert!(!touches(3.2, 5.3), "high table, 0.72 m");
    assert!(!touches(4.4, 3.9), "door");
}

#[test]
fn the_true_grid_and_contact_agree() {
    let scene = Scene::by_name("demo", 7).unwrap();
    let grid = scene.world.true_grid(0.05, band()).unwrap();
    let geometry = grid.geometry();
    let resolution = geometry.resolution;
    let (inner, outer) =
        (Footprint::disc(resolution * 0.49).unwrap(), Footprint::disc(resolution * 0.72).unwrap());
    for at in (0..geometry.len()).step_by(37) {
        let center = geometry.center(geometry.cell(at));
        let touches =
            |robot| scene.world.collides(robot, Pose2::new(center.x, center.y, 0.0), band()).unwrap();
        match grid.cells()[at] {
            Cell::Occupied => assert!(touches(&outer), "{center}"),
            _ => assert!(!touches(&inner), "{center}"),
        }
    }
}
