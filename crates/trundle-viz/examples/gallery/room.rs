//! A made-up room of 8 m by 6 m, and a drive through it.

use trundle_core::{Beam, Cell, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Vector2, Vector3};

/// Boxes: x, y, width, depth, m. Source: ours.
const FURNITURE: [[f64; 4]; 6] = [
    [2.1, 2.2, 1.3, 0.8],
    [4.6, 0.1, 0.5, 2.1],
    [5.8, 3.4, 1.2, 0.7],
    [0.1, 4.6, 1.4, 1.3],
    [3.6, 4.4, 0.4, 0.4],
    [6.9, 0.1, 1.0, 0.5],
];

pub fn grid() -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::new(-1.0, -1.0), 240, 190).expect("a good geometry");
    let mut noise = Noise(7);
    let cells = (0..geometry.len()).map(|i| cell(geometry.center(geometry.cell(i)), &mut noise)).collect();
    OccupancyGrid::new(geometry, cells).expect("as many cells as the geometry has")
}

fn cell(p: Vector2, noise: &mut Noise) -> Cell {
    let inside = p.x > 0.0 && p.y > 0.0 && p.x < 8.0 && p.y < 6.0;
    let depth = FURNITURE.iter().map(|b| depth_in_box(p, b)).fold(f64::MIN, f64::max);
    let door = p.x > 7.9 && (4.6..5.5).contains(&p.y);
    let edge = p.x.min(p.y).min(8.0 - p.x).min(6.0 - p.y);
    match () {
        () if door && p.x < 9.4 && noise.next() < 0.93 => Cell::Free,
        () if !inside && edge > -0.06 && !door => Cell::Occupied,
        () if !inside || depth > 0.06 || (p.x < 0.8 && p.y < 0.7) => Cell::Unknown,
        () if depth > 0.0 => Cell::Occupied,
        () if noise.next() < 0.004 => Cell::Unknown,
        () => Cell::Free,
    }
}

fn depth_in_box(p: Vector2, [x, y, w, d]: &[f64; 4]) -> f64 {
    (p.x - x).min(x + w - p.x).min(p.y - y).min(y + d - p.y)
}

pub fn curve() -> Vec<Vector2> {
    let at = |i: i32| {
        let t = f64::from(i) / 160.0;
        Vector2::new(0.9 + 5.9 * t, 1.3 + 3.3 * t - 0.2 * (std::f64::consts::TAU * t).sin())
    };
    (0..=160).map(at).map(|p| p + Vector2::new(0.0, 0.55 * ((p.x - 4.1) * -1.4).tanh() + 0.55)).collect()
}

/// Estimate of the robot, and truth.
pub fn paths() -> (Vec<Pose2>, Vec<Pose2>) {
    let points = curve();
    let pose = |i: usize| {
        let next = points[(i + 1).min(points.len() - 1)];
        let last = points[i.saturating_sub(1)];
        Pose2::new(points[i].x, points[i].y, (next.y - last.y).atan2(next.x - last.x))
    };
    let truth: Vec<Pose2> = (0..points.len()).map(pose).collect();
    let drift = |(i, p): (usize, &Pose2)| {
        let error = 0.05 * (i as f64 * 0.04).sin();
        Pose2::new(p.x + 0.4 * error, p.y + error, p.theta + 0.3 * error)
    };
    (truth.iter().enumerate().map(drift).collect(), truth)
}

pub fn landmarks() -> Vec<Vector3> {
    let mut noise = Noise(3);
    let walls = (0..2600).map(|i| {
        let (along, height) = (noise.next(), 0.2 + 1.8 * noise.next());
        let off = 0.05 * (noise.next() + noise.next() - 1.0);
        match i % 4 {
            0 => Vector3::new(8.0 * along, off, height),
            1 => Vector3::new(8.0 * along, 6.0 + off, height),
            2 => Vector3::new(off, 6.0 * along, height),
            _ => Vector3::new(8.0 + off, 6.0 * along, height),
        }
    });
    let mut all: Vec<Vector3> = walls.collect();
    for [x, y, w, d] in FURNITURE {
        all.extend(
            (0..260).map(|_| Vector3::new(x + w * noise.next(), y + d * noise.next(), 0.7 * noise.next())),
        );
    }
    all
}

/// A scan against the made-up map.
pub fn scan(pose: Pose2) -> Scan {
    let grid = grid();
    let step = 1.2 / 180.0;
    let beam = |i: i32| {
        let angle = -0.6 + f64::from(i) * step;
        let point = |range: f64| pose.transform(Vector2::new(angle.cos(), angle.sin()) * range);
        let ranges = (10..800).map(|k| f64::from(k) * 0.01);
        match ranges.into_iter().find(|&range| grid.at(point(range)) == Cell::Occupied) {
            Some(range) if range > 0.5 => Beam::Hit { range },
            Some(_) => Beam::Unseen,
            None => Beam::Free { range: 1.5 },
        }
    };
    let beams = (0..180).map(beam).collect();
    Scan::new(Stamp::default(), Vector2::zeros(), -0.6, step, beams).expect("a good scan")
}

/// A small generator with a fixed seed, which gives the same gallery each time (Knuth's MMIX constants).
pub struct Noise(pub u64);

impl Noise {
    /// A number in 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
