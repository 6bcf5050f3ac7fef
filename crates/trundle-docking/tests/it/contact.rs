//! The closed forms against brute force: never unsafe, and not more than a millimetre too careful.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};
use trundle_core::{Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Vector2};
use trundle_docking::{Blocker, ContactSpace, Motion, Obstacle, ObstacleScene};

const CASES: usize = 100_000;
/// Part of the cases among the cells of a grid.
const AMONG_CELLS: f64 = 0.2;
/// Overlap up to which a motion without a margin counts as free, m: contact, and the rounding of a sharp corner.
pub const CONTACT_M: f64 = 1e-5;
/// Number of samples of a motion: no point of a robot moves more than about a centimetre between two samples, so a contact in between would
/// have to begin and end there.
const VISITS_SAMPLES: u32 = 400;

/// A convex footprint, often with the axle off its middle, sometimes with the axle outside; or a disc.
pub fn footprint(rng: &mut ChaCha8Rng) -> Footprint {
    if rng.random_bool(0.1) {
        return Footprint::disc(rng.random_range(0.05..0.5)).expect("a radius");
    }
    let (a, b) = (rng.random_range(0.1..0.5), rng.random_range(0.1..0.4));
    let shift = Vector2::new(rng.random_range(-0.4..0.4), rng.random_range(-0.2..0.2));
    let count = rng.random_range(3..8);
    let first = rng.random_range(0.0..TAU);
    let mut angles: Vec<f64> =
        (0..count).map(|i| first + (i as f64 + rng.random_range(0.0..0.8)) * TAU / count as f64).collect();
    angles.sort_by(f64::total_cmp);
    Footprint::polygon(angles.iter().map(|t| shift + Vector2::new(a * t.cos(), b * t.sin())).collect())
        .expect("convex")
}

pub fn obstacle(rng: &mut ChaCha8Rng) -> Obstacle {
    let mut point = || Vector2::new(rng.random_range(-1.2..1.2), rng.random_range(-1.2..1.2));
    let (p, q) = (point(), point());
    match rng.random_range(0..4) {
        0 => Obstacle::Point(p),
        1 => Obstacle::Segment(p, q),
        2 => Obstacle::Segment(p, p + (q - p) * 0.1),
        _ => {
            let pose =
                Pose2::new(p.x, p.y, if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-PI..PI) });
            let (w, h) = (rng.random_range(0.02..0.5), rng.random_range(0.02..0.5));
            Obstacle::Polygon(
                [(0., 0.), (w, 0.), (w, h), (0., h)]
                    .map(|(x, y)| pose.transform(Vector2::new(x, y)))
                    .to_vec(),
            )
        }
    }
}

/// A few occupied cells of a grid, as a scene and as squares.
pub fn cells(rng: &mut ChaCha8Rng) -> (ObstacleScene, Vec<Obstacle>) {
    let (side, count) = (rng.random_range(0.02..0.1), 24_usize);
    let origin = Vector2::repeat(-0.5 * side * count as f64);
    let geometry = GridGeometry::new(side, origin, count, count).expect("a geometry");
    let mut grid = vec![Cell::Free; count * count];
    for _ in 0..rng.random_range(1..5) {
        let (col, row) = (rng.random_range(0..count - 3), rng.random_range(0..count - 3));
        let (wide, high) = (rng.random_range(1..4), rng.random_range(1..4));
        (0..wide * high).for_each(|i| grid[(row + i / wide) * count + col + i % wide] = Cell::Occupied);
    }
    let square = |i: usize| {
        let low = origin + Vector2::new((i % count) as f64, (i / count) as f64) * side;
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        Obstacle::Polygon(corners.map(|(x, y)| low + Vector2::new(x, y)).to_vec())
    };
    let squares = (0..grid.len()).filter(|&i| grid[i] == Cell::Occupied).map(square).collect();
    let grid = OccupancyGrid::new(geometry, grid).expect("a grid");
    (ObstacleScene::from_grid(&grid, Vector2::zeros(), 5.0, false), squares)
}

/// Exhaustive and independent: the minimum distance of the footprint from any side; 0 if they cross or one contains the other.
pub fn distance(footprint: &Footprint, pose: &Pose2, pieces: &[(Vector2, Vector2)]) -> f64 {
    let (outline, radius) = match footprint {
        Footprint::Disc { radius } => (vec![pose.position()], *radius),
        Footprint::Polygon { corners } => (corners.iter().map(|c| pose.transform(*c)).collect(), 0.0),
    };
    let mut min = f64::INFINITY;
    for (i, &p) in outline.iter().enumerate() {
        let q = outline[(i + 1) % outline.len()];
        for &(a, b) in pieces {
            let side = |a: Vector2, b: Vector2, p: Vector2| (b - a).perp(&(p - a));
            if side(a, b, p) * side(a, b, q) < 0.0 && side(p, q, a) * side(p, q, b) < 0.0 {
                return 0.0;
            }
            let near = [to_piece(a, p, q), to_piece(b, p, q), to_piece(p, a, b), to_piece(q, a, b)];
            min = near.into_iter().fold(min, f64::min);
        }
    }
    let holds = |p: Vector2| {
        outline.len() > 2
            && (0..outline.len())
                .all(|i| (outline[(i + 1) % outline.len()] - outline[i]).perp(&(p - outline[i])) > 0.0)
    };
    if pieces.iter().any(|(a, _)| holds(*a)) { 0.0 } else { (min - radius).max(0.0) }
}

fn to_piece(p: Vector2, a: Vector2, b: Vector2) -> f64 {
    let along = b - a;
    let part =
        if along.norm() == 0.0 { 0.0 } else { ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0) };
    (a + along * part - p).norm()
}

pub fn sides(obstacles: &[Obstacle]) -> Vec<(Vector2, Vector2)> {
    let of = |obstacle: &Obstacle| match obstacle {
        Obstacle::Point(p) => vec![(*p, *p)],
        Obstacle::Segment(a, b) => vec![(*a, *b)],
        Obstacle::Polygon(corners) => {
            (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()])).collect()
        }
    };
    obstacles.iter().flat_map(of).collect()
}

/// One motion from each free start: its sampled poses are free, and a motion that ends by contact leaves at most a millimetre.
#[test]
fn motions_are_safe_and_not_too_careful() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let (mut cases, mut stopped) = (0, 0);
    while cases < CASES {
        let footprint = footprint(&mut rng);
        let margin: f64 = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.0..0.1) };
        let (scene, obstacles) = if rng.random_bool(AMONG_CELLS) {
            cells(&mut rng)
        } else {
            let list: Vec<Obstacle> = (0..rng.random_range(1..4)).map(|_| obstacle(&mut rng)).collect();
            (ObstacleScene::new(&list).unwrap(), list)
        };
        let start =
            Pose2::new(rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5), rng.random_range(-PI..PI));
        let pieces = sides(&obstacles);
        let distance = |pose: &Pose2| distance(&footprint, pose, &pieces);
        let kept = if margin > 0.0 { margin } else { -CONTACT_M };
        if distance(&start) <= kept + 1e-4 {
            continue;
        }
        let mut space = ContactSpace::new(&footprint, margin, &scene);
        let (turn, drive) = (space.turn(&start), space.drive(&start, 1.0));
        let bound = |room: f64| room.min(TAU);
        let motions: [(Motion, Option<Blocker>); 4] = [
            (Motion::Turn(bound(turn.left)), turn.left_by),
            (Motion::Turn(-bound(turn.right)), turn.right_by),
            (Motion::Drive(drive.ahead), drive.ahead_by),
            (Motion::Drive(-drive.behind), drive.behind_by),
        ];
        for (motion, by) in motions {
            cases += 1;
            // No point of the robot moves farther than this from a sample to the next.
            let arm = if matches!(motion, Motion::Turn(_)) { footprint.circumscribed_radius() } else { 1.0 };
            let moves = arm * motion.amount().abs() / f64::from(VISITS_SAMPLES);
            let mut i = 0;
            while i <= VISITS_SAMPLES {
                let pose = motion.after(start, motion.amount() * f64::from(i) / f64::from(VISITS_SAMPLES));
                let left = distance(&pose) - kept;
                assert!(
                    left >= -1e-9,
                    "{footprint:?} {obstacles:?} {start:?} {motion:?} margin {margin} at sample {i}: {left}"
                );
                // The clearance of this sample proves the next ones free.
                i += 1 + (left / moves.max(1e-9)).max(0.0) as u32;
            }
            if by.is_some() {
                stopped += 1;
                let end = motion.after(start, motion.amount());
                assert!(
                    distance(&end) <= kept + 1e-3,
                    "{footprint:?} {obstacles:?} {start:?} {motion:?} margin {margin}: {} left",
                    distance(&end)
                );
            }
        }
    }
    assert!(stopped > cases / 5, "only {stopped} of {cases} motions met something");
}

/// Among many points the answers come from a tree; they equal those of all points, queried in small groups.
#[test]
fn many_points_answer_as_all_of_them() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    for _ in 0..300 {
        let footprint = footprint(&mut rng);
        let margin: f64 = rng.random_range(0.0..0.1);
        let count = rng.random_range(300..3000);
        let hole = rng.random_range(0.2..0.7);
        let mut points = Vec::new();
        while points.len() < count {
            let p = Vector2::new(rng.random_range(-1.2..1.2), rng.random_range(-1.2..1.2));
            if p.norm() > hole {
                points.push(Obstacle::Point(p));
            }
        }
        let all = ObstacleScene::new(&points).unwrap();
        let groups: Vec<ObstacleScene> =
            points.chunks(150).map(|group| ObstacleScene::new(group).unwrap()).collect();
        for _ in 0..10 {
            let at = |rng: &mut ChaCha8Rng| rng.random_range(-0.3..0.3);
            let pose = Pose2::new(at(&mut rng), at(&mut rng), rng.random_range(-PI..PI));
            let clearance =
                |scene: &ObstacleScene| scene.clearance(&footprint, &pose, 0.3).map_or(0.3, |(d, _)| d);
            let min = groups.iter().map(clearance).fold(0.3, f64::min);
            assert_eq!(clearance(&all), min, "{footprint:?} {pose:?}");
            if min <= margin + 1e-4 {
                continue;
            }
            let mut space = ContactSpace::new(&footprint, margin, &all);
            let (turn, drive) = (space.turn(&pose), space.drive(&pose, 1.0));
            let (mut room, mut length) = ((f64::INFINITY, f64::INFINITY), (1.0_f64, 1.0_f64));
            for group in &groups {
                let mut space = ContactSpace::new(&footprint, margin, group);
                let (turn, drive) = (space.turn(&pose), space.drive(&pose, 1.0));
                room = (room.0.min(turn.left), room.1.min(turn.right));
                length = (length.0.min(drive.ahead), length.1.min(drive.behind));
            }
            assert_eq!((turn.left, turn.right), room, "{footprint:?} {margin} {pose:?}");
            assert_eq!((drive.ahead, drive.behind), length, "{footprint:?} {margin} {pose:?}");
        }
    }
}
