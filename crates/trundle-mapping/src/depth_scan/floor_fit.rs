//! Plane of the floor fitted to a depth image.

use super::{DepthScanConfig, pixel_model::SortModel, pixel_rays::LensRays};
use nalgebra::{Cholesky, Matrix3, Vector3 as Column};
use trundle_core::{DepthImage, Pose3};

/// Where the floor lies by an image, against where the mount says (base frame, about the camera's place on the floor).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorFit {
    /// Rise toward the base's x, m/m: about the error of the camera's tilt, rad.
    pub rise_ahead: f64,
    /// Rise toward the base's y, m/m.
    pub rise_left: f64,
    /// Height under the camera, m.
    pub height: f64,
    /// What the rise may still be wrong by, m/m: three sigmas, and what floors are uneven by.
    pub rise_error: f64,
    /// Part of the sampled points about the expected floor that lie on it, 0 to 1.
    pub share: f64,
}

/// The pixels that look at the floor when the mount is as believed, thinned.
#[derive(Debug, Clone)]
pub(super) struct FloorSamples {
    pixels: Vec<SamplePixel>,
    points: Vec<FloorPoint>,
    limits: Limits,
}

#[derive(Debug, Clone, Copy)]
struct SamplePixel {
    index: usize,
    ahead: f64,
    left: f64,
    rise: f64,
}

/// A measured point near the expected floor.
#[derive(Debug, Clone, Copy)]
struct FloorPoint {
    /// (ahead, left, 1): the height of a floor there is its product with (rise_ahead, rise_left, height).
    place: Column<f64>,
    height: f64,
    sigma: f64,
}

/// How far the floor may be from where the mount says.
#[derive(Debug, Clone, Copy)]
struct Limits {
    rise: f64,
    height: f64,
    /// One sigma of the rise before anything is seen.
    prior_rise: f64,
}

/// So many samples an image at most.
const SAMPLES: usize = 800;
/// Floor farther than this says little, m.
const FARTHEST: f64 = 5.0;
/// The camera's height is right to so much, m: one sigma; three are the limit.
const HEIGHT_SIGMA: f64 = 0.012;
/// Planes tried through three points.
const TRIES: u64 = 24;
/// Least points, and least part of them on the plane.
const LEAST_POINTS: usize = 60;
const LEAST_SHARE: f64 = 0.5;
/// A point that is farther from the plane, in sigmas, is none of it.
const GATE: f64 = 4.0;
/// Floors are uneven, and lenses bent, by so much, m/m.
const UNEVEN: f64 = 0.007;

impl FloorSamples {
    pub(super) fn new(lens: &LensRays, base_from_camera: &Pose3, config: &DepthScanConfig) -> Self {
        let rise = config.floor_fit_deg.to_radians().tan();
        let limits = Limits { rise, height: 3.0 * HEIGHT_SIGMA, prior_rise: rise / 2.0 };
        let (base_from_lens, camera_height) =
            (base_from_camera.rotation_matrix(), base_from_camera.translation.z);
        let pixel = |index: usize| {
            let d = base_from_lens * lens.ray(index);
            SamplePixel { index, ahead: d.x, left: d.y, rise: d.z }
        };
        let looks_at_floor = |p: &SamplePixel| {
            let depth = camera_height / -p.rise;
            p.rise < 0.0
                && depth >= config.min_depth
                && depth <= config.max_depth
                && depth * p.ahead.hypot(p.left) <= FARTHEST
        };
        let mut pixels: Vec<SamplePixel> = (0..lens.len()).map(pixel).filter(looks_at_floor).collect();
        // A step that shares no factor with the width spreads the samples over rows and columns.
        let step = (pixels.len() / SAMPLES).max(1) | 1;
        pixels = pixels.into_iter().step_by(step).collect();
        Self { points: Vec::with_capacity(pixels.len()), pixels, limits }
    }

    /// The floor of an image: RANSAC \[Fischler81\] with fixed draws, then least squares with Tukey's weights about what the
    /// mount says; `None` where too little of it is seen, or it lies farther off than it may.
    pub(super) fn fit(&mut self, depth: &DepthImage, model: &SortModel) -> Option<FloorFit> {
        if self.limits.rise <= 0.0 {
            return None;
        }
        self.measure(depth, model);
        if self.points.len() < LEAST_POINTS {
            return None;
        }
        let (mut plane, mut information) = (self.best_guess(), Matrix3::zeros());
        for _ in 0..4 {
            (plane, information) = self.refine(plane)?;
        }
        let on_it = self.points.iter().filter(|p| p.off(&plane) <= GATE).count();
        let share = on_it as f64 / self.points.len() as f64;
        let covariance = information.try_inverse()?;
        let sigma = covariance[(0, 0)].max(covariance[(1, 1)]).sqrt();
        let found = FloorFit {
            rise_ahead: plane.x,
            rise_left: plane.y,
            height: plane.z,
            rise_error: 3.0 * sigma + UNEVEN,
            share,
        };
        (share >= LEAST_SHARE && self.limits.allow(&plane)).then_some(found)
    }

    /// The samples that lie near the expected floor.
    fn measure(&mut self, depth: &DepthImage, model: &SortModel) {
        let Self { pixels, points, limits } = self;
        points.clear();
        for pixel in pixels.iter() {
            let z = depth.data()[pixel.index];
            if !(z >= model.min_depth && z <= model.max_depth) {
                continue;
            }
            let noise = f64::from(model.noise(z));
            let z = f64::from(z);
            let place = Column::new(pixel.ahead * z, pixel.left * z, 1.0);
            let height = f64::from(model.camera_height) + pixel.rise * z;
            let sigma = pixel.rise.abs() * noise + 0.002;
            let far = limits.height + limits.rise * place.xy().norm() + GATE * sigma;
            if height.abs() <= far {
                points.push(FloorPoint { place, height, sigma });
            }
        }
    }

    /// Of the mount's own floor and planes through three points, the one that most points lie on.
    fn best_guess(&self) -> Column<f64> {
        let score = |plane: &Column<f64>| -> f64 {
            let near = |p: &FloorPoint| (1.0 - (p.off(plane) / GATE).powi(2)).max(0.0);
            self.points.iter().step_by(3).map(near).sum()
        };
        let mut best = (score(&Column::zeros()), Column::zeros());
        let mut state = 0x2545_F491_4F6C_DD1D_u64;
        for _ in 0..TRIES {
            let rows = [0; 3].map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                &self.points[(state >> 33) as usize % self.points.len()]
            });
            let places = Matrix3::from_rows(&rows.map(|p| p.place.transpose()));
            let heights = Column::from(rows.map(|p| p.height));
            let plane = places.try_inverse().map(|inverse| inverse * heights);
            let Some(plane) = plane.filter(|plane| self.limits.allow(plane)) else { continue };
            let score = score(&plane);
            if score > best.0 {
                best = (score, plane);
            }
        }
        best.1
    }

    /// A step of weighted least squares: the new plane and its information.
    fn refine(&self, plane: Column<f64>) -> Option<(Column<f64>, Matrix3<f64>)> {
        let prior = |sigma: f64| 1.0 / (sigma * sigma);
        let rise = prior(self.limits.prior_rise);
        let mut information = Matrix3::from_diagonal(&Column::new(rise, rise, prior(HEIGHT_SIGMA)));
        let mut pull = Column::zeros();
        for point in &self.points {
            let off = point.off(&plane) / GATE;
            if off < 1.0 {
                let weight = ((1.0 - off * off) / point.sigma).powi(2);
                information += point.place * point.place.transpose() * weight;
                pull += point.place * (point.height * weight);
            }
        }
        Some((Cholesky::new(information)?.solve(&pull), information))
    }
}

impl FloorPoint {
    /// How far it is from a plane, in sigmas.
    fn off(&self, plane: &Column<f64>) -> f64 {
        (self.height - self.place.dot(plane)).abs() / self.sigma
    }
}

impl Limits {
    fn allow(&self, plane: &Column<f64>) -> bool {
        plane.xy().norm() <= self.rise && plane.z.abs() <= self.height
    }
}
