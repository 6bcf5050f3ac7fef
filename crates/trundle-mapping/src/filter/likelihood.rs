use super::{ParticleConfig, ScanShape};
use crate::tiles::{Nearest, TileWindow};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// How well a hit agrees with the map, by its distance to the nearest obstacle in sigmas: a Gaussian and outliers.
///
/// p(e) = outliers + (1 - outliers) exp(-e / 2) with e the squared distance in sigmas; where the map is unknown the
/// floor is the square root of the outliers': a hit in free space contradicts the map, one in the unknown does not.
#[derive(Debug, Clone)]
pub(crate) struct Likelihood {
    /// ln p on free and on unknown ground, in steps of 1/16.
    log: [[f32; STEPS]; 2],
    /// The Gaussian's part of p.
    share: [f32; STEPS],
    /// Hits may lie this far along a wall from the next obstacle point of it, cells.
    slack: f32,
}

const STEPS: usize = 257;
const PER_UNIT: f32 = 16.0;

/// What all hits say at a pose: information (1 / cells^2, 1 / cells, 1), pull and log-likelihood.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vote {
    pub(crate) information: Matrix3<f64>,
    pub(crate) pull: Vector3<f64>,
    /// How many hits the map explains.
    pub(crate) explained: f64,
    /// Their information.
    pub(crate) weight: f64,
}

/// The nearest obstacle of a hit.
struct Residual {
    /// To the obstacle, cells.
    dx: f32,
    dy: f32,
    /// Squared distance, sigmas.
    squared: f32,
}

impl Likelihood {
    pub(crate) fn new(config: &ParticleConfig) -> Self {
        let mut log = [[0.0; STEPS]; 2];
        let mut share = [0.0; STEPS];
        let unknown = config.outliers.sqrt();
        for i in 0..STEPS {
            let kernel = if i + 1 == STEPS { 0.0 } else { (-0.5 * i as f64 / f64::from(PER_UNIT)).exp() };
            let hit = (1.0 - config.outliers) * kernel;
            log[0][i] = (config.outliers + hit).ln() as f32;
            log[1][i] = (unknown + (1.0 - unknown) * kernel).ln() as f32;
            share[i] = (hit / (config.outliers + hit)) as f32;
        }
        Self { log, share, slack: 0.75 }
    }

    /// ln p(z | m, x) of all points at a pose (cells of the window, rad).
    pub(crate) fn log_likelihood(&self, window: &TileWindow<'_>, shape: &ScanShape, pose: Pose2) -> f64 {
        let place = Placed::new(pose);
        let mut sum = 0.0_f32;
        for point in &shape.points {
            let (rx, ry) = place.rotate(point.x, point.y);
            let (x, y) = (rx + place.x, ry + place.y);
            let (free, residual) =
                self.look(window, (x, y), place.rotate(point.normal.0, point.normal.1), point.information);
            let step = residual.map_or(STEPS - 1, |r| step(r.squared));
            sum += self.log[usize::from(!free)][step];
        }
        f64::from(sum)
    }

    /// What the points say about where to go from a pose.
    pub(crate) fn vote(&self, window: &TileWindow<'_>, shape: &ScanShape, pose: Pose2) -> Vote {
        let place = Placed::new(pose);
        // Upper triangle of the information, pull.
        let mut a = [0.0_f32; 6];
        let mut b = [0.0_f32; 3];
        let (mut explained, mut weight) = (0.0_f32, 0.0_f32);
        for point in &shape.points {
            let (rx, ry) = place.rotate(point.x, point.y);
            let normal = place.rotate(point.normal.0, point.normal.1);
            let (_, Some(r)) = self.look(window, (rx + place.x, ry + place.y), normal, point.information)
            else {
                continue;
            };
            let share = self.share[step(r.squared)];
            explained += share;
            let w = share * point.information;
            weight += w;
            let mut row = |nx: f32, ny: f32| {
                let (turn, off) = (ny * rx - nx * ry, nx * r.dx + ny * r.dy);
                a[0] += w * nx * nx;
                a[1] += w * nx * ny;
                a[2] += w * nx * turn;
                a[3] += w * ny * ny;
                a[4] += w * ny * turn;
                a[5] += w * turn * turn;
                b[0] += w * nx * off;
                b[1] += w * ny * off;
                b[2] += w * turn * off;
            };
            if point.normal == (0.0, 0.0) {
                row(1.0, 0.0);
                row(0.0, 1.0);
            } else {
                row(normal.0, normal.1);
            }
        }
        let a = a.map(f64::from);
        Vote {
            information: Matrix3::new(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]),
            pull: Vector3::new(f64::from(b[0]), f64::from(b[1]), f64::from(b[2])),
            explained: f64::from(explained),
            weight: f64::from(weight),
        }
    }

    /// Whether a hit lies on free ground, and the way to the nearest obstacle.
    #[inline]
    fn look(
        &self,
        window: &TileWindow<'_>,
        (x, y): (f32, f32),
        normal: (f32, f32),
        information: f32,
    ) -> (bool, Option<Residual>) {
        let (cx, cy) = (floor(x), floor(y));
        let Some((tile, place)) = window.at(cx, cy) else { return (false, None) };
        let free = tile.log_odds[place] < 0;
        let nearest = tile.nearest[place];
        if nearest.is_none() {
            return (free, None);
        }
        const CELL: f32 = 1.0 / Nearest::PER_CELL as f32;
        let dx = cx as f32 + 0.5 + f32::from(nearest.x) * CELL - x;
        let dy = cy as f32 + 0.5 + f32::from(nearest.y) * CELL - y;
        let across = normal.0 * dx + normal.1 * dy;
        let along = (normal.0 * dy - normal.1 * dx).abs();
        let over = (along - self.slack).max(0.0);
        let on_wall = normal.0 != 0.0 || normal.1 != 0.0;
        let square = if on_wall { across * across + over * over } else { dx * dx + dy * dy };
        (free, Some(Residual { dx, dy, squared: square * information }))
    }
}

#[inline]
fn step(squared: f32) -> usize {
    ((squared * PER_UNIT) as usize).min(STEPS - 1)
}

/// Rounding down of what is not far below 0.
#[inline]
fn floor(v: f32) -> i32 {
    let cut = v as i32;
    cut - i32::from((cut as f32) > v)
}

/// A pose with its sine and cosine.
pub(crate) struct Placed {
    pub(crate) x: f32,
    pub(crate) y: f32,
    s: f32,
    c: f32,
}

impl Placed {
    pub(crate) fn new(pose: Pose2) -> Self {
        let (s, c) = pose.theta.sin_cos();
        Self { x: pose.x as f32, y: pose.y as f32, s: s as f32, c: c as f32 }
    }

    #[inline]
    pub(crate) fn rotate(&self, x: f32, y: f32) -> (f32, f32) {
        (self.c * x - self.s * y, self.s * x + self.c * y)
    }
}
