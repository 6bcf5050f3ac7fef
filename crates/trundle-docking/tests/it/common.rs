//! Shapes and scenes that several tests share.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::{Obstacle, ObstacleScene};

/// A point of the map frame, m.
pub fn at(x: f64, y: f64) -> Vector2 {
    Vector2::new(x, y)
}

/// A thin wall between two points.
pub fn wall(from: (f64, f64), to: (f64, f64)) -> Obstacle {
    Obstacle::Segment(at(from.0, from.1), at(to.0, to.1))
}

/// A solid box between two opposite corners.
pub fn solid(low: (f64, f64), high: (f64, f64)) -> Obstacle {
    Obstacle::Polygon(vec![at(low.0, low.1), at(high.0, low.1), at(high.0, high.1), at(low.0, high.1)])
}

/// A scene of valid obstacles.
pub fn scene(obstacles: &[Obstacle]) -> ObstacleScene {
    ObstacleScene::new(obstacles).expect("valid obstacles")
}

/// A robot of 0.6 m by 0.4 m around its axle.
pub fn robot() -> Footprint {
    let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| at(x, y));
    Footprint::polygon(corners.to_vec()).expect("convex")
}

/// A pose within `spread` (m) of the origin with any heading.
pub fn any_pose(rng: &mut ChaCha8Rng, spread: f64) -> Pose2 {
    let mut coordinate = || rng.random_range(-spread..spread);
    let (x, y) = (coordinate(), coordinate());
    Pose2::new(x, y, rng.random_range(-PI..PI))
}

/// The mirror image of a pose with respect to the x axis.
pub fn mirrored(pose: Pose2) -> Pose2 {
    Pose2::new(pose.x, -pose.y, -pose.theta)
}

/// Obstacles with every point mapped.
pub fn mapped(obstacles: &[Obstacle], point: impl Fn(Vector2) -> Vector2) -> Vec<Obstacle> {
    let one = |obstacle: &Obstacle| match obstacle {
        Obstacle::Point(p) => Obstacle::Point(point(*p)),
        Obstacle::Segment(a, b) => Obstacle::Segment(point(*a), point(*b)),
        Obstacle::Polygon(corners) => Obstacle::Polygon(corners.iter().map(|p| point(*p)).collect()),
    };
    obstacles.iter().map(one).collect()
}

/// A footprint mirrored about its x axis.
pub fn mirrored_footprint(footprint: &Footprint) -> Footprint {
    match footprint {
        Footprint::Polygon { corners } => {
            Footprint::polygon(corners.iter().map(|p| at(p.x, -p.y)).collect()).expect("convex")
        }
        Footprint::Disc { radius } => Footprint::Disc { radius: *radius },
    }
}
