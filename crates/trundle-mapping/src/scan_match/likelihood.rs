//! Likelihood of scan points in a map of tiles, and the normal equations of a pose.

use crate::particle_config::ParticleConfig;
use crate::scan_match::normal_equations::NormalEquations;
use crate::scan_match::scan_points::{LANES, PointGroup, ScanPoints};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_grid::tiles::{NearestObstacle, TileWindow};

/// Likelihood of a hit by its distance to the nearest obstacle in sigmas: a Gaussian and outliers.
///
/// p(e) = outliers + (1 - outliers) exp(-e / 2), with e the squared distance in sigmas. In unknown space the minimum is the square root of
/// the outliers' likelihood. A hit in free space contradicts the map; a hit in unknown space does not.
#[derive(Debug, Clone)]
pub(crate) struct Likelihood {
    /// ln p on free and on unknown ground, in steps of 1/16.
    log: [[f32; TABLE_STEPS]; 2],
    /// The Gaussian's part of p.
    share: [f32; TABLE_STEPS],
    /// Distance along a wall from the next obstacle point of that wall that counts as zero, cells.
    slack: f32,
}

/// Number of entries of the table: squared distances of 0 to 16 in steps of 1/16, in squared standard deviations. Source: ours.
const TABLE_STEPS: usize = 257;
/// Entries of the table per unit of the squared distance. Source: ours.
const PER_UNIT: f32 = 16.0;

/// Normal equations of a pose in a map of tiles (cells, rad), with the agreement of the hits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ScanEquations {
    pub(crate) normal: NormalEquations,
    /// Sum of the information of the explained hits, 1 / cells^2.
    pub(crate) weight: f64,
    /// Number of hits on free ground with no obstacle near.
    pub(crate) contradicted: f64,
}

/// The nearest obstacles of eight hits.
struct Residuals {
    /// Vectors from the base to the hits, map frame, cells.
    rx: [f32; LANES],
    ry: [f32; LANES],
    /// Normals, map frame.
    nx: [f32; LANES],
    ny: [f32; LANES],
    /// Vectors to the obstacles, cells.
    dx: [f32; LANES],
    dy: [f32; LANES],
    /// Table entry of the squared distance.
    step: [u32; LANES],
    /// 0 for a hit on free ground, else 1.
    ground: [u32; LANES],
}

impl Likelihood {
    pub(crate) fn new(config: &ParticleConfig) -> Self {
        let mut log = [[0.0; TABLE_STEPS]; 2];
        let mut share = [0.0; TABLE_STEPS];
        let unknown = config.outliers.sqrt();
        for i in 0..TABLE_STEPS {
            let kernel =
                if i + 1 == TABLE_STEPS { 0.0 } else { (-0.5 * i as f64 / f64::from(PER_UNIT)).exp() };
            let hit = (1.0 - config.outliers) * kernel;
            log[0][i] = (config.outliers + hit).ln() as f32;
            log[1][i] = (unknown + (1.0 - unknown) * kernel).ln() as f32;
            share[i] = (hit / (config.outliers + hit)) as f32;
        }
        Self { log, share, slack: 0.75 }
    }

    /// ln p(z | m, x) of all points at a pose (cells of the window, rad).
    pub(crate) fn log_likelihood(&self, window: &TileWindow<'_>, shape: &ScanPoints, pose: Pose2) -> f64 {
        let mut sum = 0.0_f32;
        self.evaluate_all(&mut sum, window, shape, pose);
        f64::from(sum)
    }

    /// Normal equations of the points for a step from a pose.
    pub(crate) fn equations(
        &self,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        pose: Pose2,
    ) -> ScanEquations {
        let mut sums = Sums::default();
        self.evaluate_all(&mut sums, window, shape, pose);
        sums.equations()
    }

    /// Passes all points to a sink, eight at a time.
    fn evaluate_all<L: PointSink>(
        &self,
        to: &mut L,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        pose: Pose2,
    ) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.evaluate_by_avx2(to, window, shape, pose) };
        }
        self.evaluate_portably(to, window, shape, pose);
    }

    /// The same arithmetic in vectors of eight, with the order of all sums: the same bits.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn evaluate_by_avx2<L: PointSink>(
        &self,
        to: &mut L,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        pose: Pose2,
    ) {
        self.evaluate_each(to, window, shape, pose);
    }

    fn evaluate_portably<L: PointSink>(
        &self,
        to: &mut L,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        pose: Pose2,
    ) {
        self.evaluate_each(to, window, shape, pose);
    }

    #[inline(always)]
    fn evaluate_each<L: PointSink>(
        &self,
        to: &mut L,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        pose: Pose2,
    ) {
        let place = RotatedPose::new(pose);
        for group in &shape.groups {
            to.take(self, group, &self.residuals(window, group, &place));
        }
    }

    /// Evaluates eight hits: arithmetic lane by lane, which the compiler turns into vector code, and one load for each.
    #[inline(always)]
    fn residuals(&self, window: &TileWindow<'_>, group: &PointGroup, place: &RotatedPose) -> Residuals {
        let mut r = Residuals {
            rx: [0.0; LANES],
            ry: [0.0; LANES],
            nx: [0.0; LANES],
            ny: [0.0; LANES],
            dx: [0.0; LANES],
            dy: [0.0; LANES],
            step: [0; LANES],
            ground: [1; LANES],
        };
        let (mut cell_x, mut cell_y) = ([0_i32; LANES], [0_i32; LANES]);
        for k in 0..LANES {
            (r.rx[k], r.ry[k]) = place.rotate(group.x[k], group.y[k]);
            (r.nx[k], r.ny[k]) = place.rotate(group.normal_x[k], group.normal_y[k]);
            cell_x[k] = floor(r.rx[k] + place.x);
            cell_y[k] = floor(r.ry[k] + place.y);
        }
        let mut near = [0_i32; LANES];
        for k in 0..LANES {
            let (tile, place) = window.at(cell_x[k], cell_y[k]);
            near[k] = i32::from(tile.nearest[place].packed());
            r.ground[k] = u32::from(tile.log_odds[place] >= 0);
        }
        let (mut near_x, mut near_y) = ([0_i32; LANES], [0_i32; LANES]);
        for k in 0..LANES {
            (near_x[k], near_y[k]) = ((near[k] << 24) >> 24, near[k] >> 8);
        }
        const CELL: f32 = 1.0 / NearestObstacle::PER_CELL as f32;
        for k in 0..LANES {
            let dx = cell_x[k] as f32 + 0.5 + near_x[k] as f32 * CELL - (r.rx[k] + place.x);
            let dy = cell_y[k] as f32 + 0.5 + near_y[k] as f32 * CELL - (r.ry[k] + place.y);
            let across = r.nx[k] * dx + r.ny[k] * dy;
            let beyond = (r.nx[k] * dy - r.ny[k] * dx).abs() - self.slack;
            let over = if beyond > 0.0 { beyond } else { 0.0 };
            let on_wall = across * across + over * over;
            let square = on_wall * group.wall[k] + (dx * dx + dy * dy) * (1.0 - group.wall[k]);
            // No obstacle within reach: -128 sixteenths.
            let none = if near_x[k] == i32::from(i8::MIN) { LAST_TABLE_STEP } else { 0.0 };
            let steps = square * group.information[k] * PER_UNIT + none;
            let steps = if steps < LAST_TABLE_STEP { steps } else { LAST_TABLE_STEP };
            (r.dx[k], r.dy[k], r.step[k]) = (dx, dy, floor(steps) as u32);
        }
        r
    }
}

/// The last entry of the tables.
const LAST_TABLE_STEP: f32 = (TABLE_STEPS - 1) as f32;

/// Receiver of the evaluated hits.
trait PointSink {
    fn take(&mut self, likelihood: &Likelihood, group: &PointGroup, found: &Residuals);
}

/// Sum of the points' ln p.
impl PointSink for f32 {
    #[inline(always)]
    fn take(&mut self, likelihood: &Likelihood, group: &PointGroup, found: &Residuals) {
        for k in 0..group.count {
            *self += likelihood.log[found.ground[k] as usize][found.step[k] as usize];
        }
    }
}

/// Sums of the points' gradients.
impl PointSink for Sums {
    #[inline(always)]
    fn take(&mut self, likelihood: &Likelihood, group: &PointGroup, r: &Residuals) {
        for k in 0..group.count {
            let share = likelihood.share[r.step[k] as usize];
            if share < 0.1 && r.ground[k] == 0 {
                self.contradicted += 1;
            }
            if share == 0.0 {
                continue;
            }
            let w = share * group.information[k];
            self.explained += share;
            self.weight += w;
            let (arm, to) = ((r.rx[k], r.ry[k]), (r.dx[k], r.dy[k]));
            if group.wall[k] == 0.0 {
                self.add(w, (1.0, 0.0), arm, to);
                self.add(w, (0.0, 1.0), arm, to);
            } else {
                self.add(w, (r.nx[k], r.ny[k]), arm, to);
            }
        }
    }
}

/// Sums over the hits: upper triangle of the information, pull.
#[derive(Default)]
struct Sums {
    a: [f32; 6],
    b: [f32; 3],
    explained: f32,
    weight: f32,
    contradicted: u32,
}

impl Sums {
    /// Adds a hit `arm` away from the base with the residual `to` along `normal`.
    #[inline(always)]
    fn add(&mut self, w: f32, normal: (f32, f32), arm: (f32, f32), to: (f32, f32)) {
        let (nx, ny) = normal;
        let (turn, off) = (ny * arm.0 - nx * arm.1, nx * to.0 + ny * to.1);
        let (wx, wy, wt) = (w * nx, w * ny, w * turn);
        for (sum, part) in self.a.iter_mut().zip([wx * nx, wx * ny, wx * turn, wy * ny, wy * turn, wt * turn])
        {
            *sum += part;
        }
        for (sum, part) in self.b.iter_mut().zip([wx * off, wy * off, wt * off]) {
            *sum += part;
        }
    }

    fn equations(&self) -> ScanEquations {
        let (a, b) = (self.a.map(f64::from), self.b.map(f64::from));
        ScanEquations {
            normal: NormalEquations {
                information: Matrix3::new(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]),
                rhs: Vector3::from(b),
                explained: f64::from(self.explained),
            },
            weight: f64::from(self.weight),
            contradicted: f64::from(self.contradicted),
        }
    }
}

/// Rounds down numbers below 2^22 by floating-point addition; the result for a whole number may be one less.
#[inline(always)]
pub(crate) fn floor(v: f32) -> i32 {
    const MAGIC: f32 = 12_582_912.0;
    ((v - 0.5 + MAGIC).to_bits() as i32).wrapping_sub(MAGIC.to_bits() as i32)
}

/// A pose with its sine and cosine.
pub(crate) struct RotatedPose {
    pub(crate) x: f32,
    pub(crate) y: f32,
    s: f32,
    c: f32,
}

impl RotatedPose {
    pub(crate) fn new(pose: Pose2) -> Self {
        let (s, c) = pose.theta.sin_cos();
        Self { x: pose.x as f32, y: pose.y as f32, s: s as f32, c: c as f32 }
    }

    #[inline(always)]
    pub(crate) fn rotate(&self, x: f32, y: f32) -> (f32, f32) {
        (self.c * x - self.s * y, self.s * x + self.c * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Beam, Scan, Stamp, Vector2};
    use trundle_grid::tiles::{NearestField, TileMap};

    proptest! {
        #[test]
        fn vector_code_gives_the_bits_of_plain_code(
            ranges in prop::collection::vec(0.3..4.0_f64, 40..100), x in 70.0..90.0_f64, theta in -3.0..3.0_f64,
        ) {
            let config = ParticleConfig::default();
            let (mut map, model) = (TileMap::default(), NearestField::new(4, 2.0));
            for k in 0..160 {
                model.insert(&mut map, (k, 40 + k / 7), NearestObstacle::own(k % 7, -k % 5));
            }
            let beams = ranges.iter().map(|&range| Beam::Hit { range }).collect();
            let scan = Scan::new(Stamp::default(), Vector2::zeros(), -1.5, 0.03, beams).unwrap();
            let (mut shape, likelihood) = (ScanPoints::default(), Likelihood::new(&config));
            shape.set(&config, &scan);
            let (window, pose) = (TileWindow::new(&map, (0, 0), (191, 127)), Pose2::new(x, 60.0, theta));
            let (mut sum, mut sums) = (0.0_f32, Sums::default());
            likelihood.evaluate_portably(&mut sum, &window, &shape, pose);
            likelihood.evaluate_portably(&mut sums, &window, &shape, pose);
            prop_assert_eq!(likelihood.log_likelihood(&window, &shape, pose).to_bits(), f64::from(sum).to_bits());
            prop_assert_eq!(likelihood.equations(&window, &shape, pose), sums.equations());
        }
    }
}
