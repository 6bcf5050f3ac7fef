//! Random corridor problems.

use crate::corridor::problem::Problem;
use crate::scene::obstacle_scene::{Obstacle, ObstacleScene};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use trundle_core::{Footprint, Pose2, Vector2};

/// Smallest clearance of start and goal, m. Source: ours.
const MIN_CLEARANCE_M: f64 = 0.01;

/// A random corridor problem. Walls along x around y = 0 are 0.55 to 1.10 m apart, with dead ends, boxes, and a niche behind an opening.
/// The goal is along the corridor, the start a few decimetres to its side. All obstacles are solid or walls.
pub fn generate(name: impl Into<String>, rng: &mut ChaCha8Rng) -> Problem {
    let name = name.into();
    loop {
        let footprint = footprint(rng);
        let width = rng.random_range(0.55..1.10);
        let obstacles = surroundings(width, rng);
        let Ok(scene) = ObstacleScene::new(&obstacles) else { continue };
        for _ in 0..60 {
            let (start, goal) = start_and_goal(width, rng);
            let clear = |pose| scene.clearance(&footprint, pose, MIN_CLEARANCE_M).is_none();
            if clear(&goal) && clear(&start) {
                return Problem { name, footprint, start, goal, obstacles };
            }
        }
    }
}

/// A random footprint: in most cases the box of 0.6 x 0.4 m around its axle.
fn footprint(rng: &mut ChaCha8Rng) -> Footprint {
    let rectangle =
        |front: f64, back: f64, half: f64| vec![(front, half), (-back, half), (-back, -half), (front, -half)];
    let corners = match rng.random_range(0..10) {
        0..7 => rectangle(0.3, 0.3, 0.2),
        7 => rectangle(0.42, 0.18, 0.2),
        8 => vec![(0.35, 0.1), (0.2, 0.2), (-0.25, 0.2), (-0.25, -0.2), (0.2, -0.2), (0.35, -0.1)],
        _ => return Footprint::KOBUKI,
    };
    Footprint::Polygon { corners: corners.into_iter().map(|(x, y)| Vector2::new(x, y)).collect() }
}

fn surroundings(width: f64, rng: &mut ChaCha8Rng) -> Vec<Obstacle> {
    let half = width / 2.0;
    let (left, right) = (-rng.random_range(0.6..1.8), rng.random_range(0.6..1.8));
    let mut obstacles = vec![wall(left, -half, right, -half)];
    upper_wall(left, right, half, rng, &mut obstacles);
    for x in [left, right] {
        if rng.random_bool(0.5) {
            obstacles.push(wall(x, -half, x, half));
        }
    }
    for _ in 0..rng.random_range(0..4) {
        obstacles.push(block(left, right, half, rng));
    }
    obstacles
}

/// The upper wall: whole, or with an opening that leads to a niche.
fn upper_wall(left: f64, right: f64, half: f64, rng: &mut ChaCha8Rng, obstacles: &mut Vec<Obstacle>) {
    if rng.random_bool(0.7) {
        obstacles.push(wall(left, half, right, half));
        return;
    }
    let (door, depth) = (rng.random_range(0.45..1.0), rng.random_range(0.1..0.7));
    let from = rng.random_range(left..right - door);
    let to = from + door;
    obstacles.extend([
        wall(left, half, from, half),
        wall(to, half, right, half),
        wall(from, half + depth, to, half + depth),
    ]);
    obstacles.extend([wall(from, half, from, half + depth), wall(to, half, to, half + depth)]);
}

/// A box at one of the walls, or anywhere and turned.
fn block(left: f64, right: f64, half: f64, rng: &mut ChaCha8Rng) -> Obstacle {
    let (long, deep) = (rng.random_range(0.08..0.5), rng.random_range(0.03..0.3));
    let along = rng.random_range(left..right);
    let (y, turn) = if rng.random_bool(0.75) {
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        (side * (half - deep / 2.0), 0.0)
    } else {
        (rng.random_range(-half..half), rng.random_range(-PI..PI))
    };
    let pose = Pose2::new(along, y, turn);
    let corners = [(-long, -deep), (long, -deep), (long, deep), (-long, deep)];
    Obstacle::Polygon(corners.map(|(x, y)| pose.transform(Vector2::new(x, y) / 2.0)).to_vec())
}

fn start_and_goal(width: f64, rng: &mut ChaCha8Rng) -> (Pose2, Pose2) {
    let half = width / 2.0;
    let mut heading = |spread: f64| rng.random_range(-spread..spread);
    let (goal_heading, start_heading) = (heading(0.15), heading(0.35));
    let goal = Pose2::new(rng.random_range(-0.3..0.3), rng.random_range(-half..half), goal_heading);
    let turned = if rng.random_bool(0.05) { PI } else { 0.0 };
    let (x, y) = (goal.x + rng.random_range(-0.3..0.3), goal.y + rng.random_range(-0.3..0.3));
    (Pose2::new(x, y, start_heading + turned), goal)
}

fn wall(ax: f64, ay: f64, bx: f64, by: f64) -> Obstacle {
    Obstacle::Segment(Vector2::new(ax, ay), Vector2::new(bx, by))
}
