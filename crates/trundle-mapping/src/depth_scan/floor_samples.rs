//! Fit of the floor plane to sampled pixels of a depth image.

use super::{DepthScanConfig, FloorFit, pixel_model::PixelModel, pixel_rays::LensRays};
use nalgebra::{Cholesky, Matrix3, Vector3 as Column};
use trundle_core::{DepthImage, Hypotenuse, Pose3};

/// Thinned pixels whose rays meet the floor of the mount.
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
    /// (ahead, left, 1): the product with (rise_ahead, rise_left, height) is the height of the floor at this place.
    place: Column<f64>,
    height: f64,
    sigma: f64,
}

/// Largest deviation of a floor from the mount's.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Rise, m/m.
    rise: f64,
    /// Height, m.
    height: f64,
    /// Prior sigma of the rise, m/m.
    prior_rise: f64,
}

/// Maximum number of sampled pixels of an image. More pixels are thinned evenly. Source: ours.
const MAX_SAMPLES: usize = 800;
/// Maximum range of a sampled pixel over the floor \[m\]. A farther pixel is not sampled: its height is mostly noise. Source:
/// ours.
const MAX_SAMPLE_RANGE_M: f64 = 5.0;
/// Sigma of the camera's height above the floor \[m\]. A floor beyond three sigmas is refused. Source: ours.
const CAMERA_HEIGHT_SIGMA_M: f64 = 0.012;
/// Number of planes tried through three points each. Source: ours.
const RANSAC_TRIALS: u64 = 24;
/// Minimum number of points near the expected floor. Fewer points give no fit. Source: ours.
const MIN_POINTS: usize = 60;
/// Minimum fraction of those points on the plane \[1\]. A lower fraction gives no fit. Source: ours.
const MIN_INLIER_FRACTION: f64 = 0.5;
/// Maximum distance of a point from the plane \[sigmas\]. A farther point is an outlier. Source: ours.
const MAX_RESIDUAL_SIGMAS: f64 = 4.0;
/// Standard deviation of a height in addition to the depth noise \[m\]: unevenness of the floor. Source: ours.
const HEIGHT_SIGMA_M: f64 = 0.002;
/// Unmodelled unevenness of floors and lens distortion \[m/m\], added to the bound of the rise. Source: ours.
const FLOOR_UNEVENNESS: f64 = 0.007;

impl FloorSamples {
    pub(super) fn new(lens: &LensRays, base_from_camera: &Pose3, config: &DepthScanConfig) -> Self {
        let rise = config.floor_fit_deg.to_radians().tan();
        let limits = Limits { rise, height: 3.0 * CAMERA_HEIGHT_SIGMA_M, prior_rise: rise / 2.0 };
        let (base_from_lens, camera_height) =
            (base_from_camera.rotation_matrix(), base_from_camera.translation.z);
        let pixel = |index: usize| {
            let d = base_from_lens * lens.ray(index);
            SamplePixel { index, ahead: d.x, left: d.y, rise: d.z }
        };
        let meets_floor = |p: &SamplePixel| {
            let depth = camera_height / -p.rise;
            p.rise < 0.0
                && depth >= config.min_depth
                && depth <= config.max_depth
                && depth * p.ahead.hypotenuse(p.left) <= MAX_SAMPLE_RANGE_M
        };
        let mut pixels: Vec<SamplePixel> = (0..lens.len()).map(pixel).filter(meets_floor).collect();
        // A step that shares no factor with the width spreads the samples over rows and columns.
        let step = (pixels.len() / MAX_SAMPLES).max(1) | 1;
        pixels = pixels.into_iter().step_by(step).collect();
        Self { points: Vec::with_capacity(pixels.len()), pixels, limits }
    }

    /// Floor of an image: RANSAC \[Fischler81\] with fixed draws, then least squares with Tukey's weights and the mount as prior. `None` if
    /// too few points are near the floor, or the plane exceeds its limits.
    pub(super) fn fit(&mut self, depth: &DepthImage, model: &PixelModel) -> Option<FloorFit> {
        if self.limits.rise <= 0.0 {
            return None;
        }
        self.measure(depth, model);
        if self.points.len() < MIN_POINTS {
            return None;
        }
        let (mut plane, mut information) = (self.best_initial_plane(), Matrix3::zeros());
        for _ in 0..4 {
            (plane, information) = self.refine(plane)?;
        }
        let inliers = self.points.iter().filter(|p| p.residual_sigmas(&plane) <= MAX_RESIDUAL_SIGMAS).count();
        let share = inliers as f64 / self.points.len() as f64;
        let covariance = information.try_inverse()?;
        let sigma = covariance[(0, 0)].max(covariance[(1, 1)]).sqrt();
        let found = FloorFit {
            rise_ahead: plane.x,
            rise_left: plane.y,
            height: plane.z,
            rise_error: 3.0 * sigma + FLOOR_UNEVENNESS,
            share,
        };
        (share >= MIN_INLIER_FRACTION && self.limits.allow(&plane)).then_some(found)
    }

    /// Measures the sampled pixels and keeps the points near the expected floor.
    fn measure(&mut self, depth: &DepthImage, model: &PixelModel) {
        let Self { pixels, points, limits } = self;
        points.clear();
        for pixel in pixels.iter() {
            let z = depth.data()[pixel.index];
            if !(z >= model.min_depth && z <= model.max_depth) {
                continue;
            }
            let noise = f64::from(model.noise.sigma(z));
            let z = f64::from(z);
            let place = Column::new(pixel.ahead * z, pixel.left * z, 1.0);
            let height = f64::from(model.camera_height) + pixel.rise * z;
            let sigma = pixel.rise.abs() * noise + HEIGHT_SIGMA_M;
            let far = limits.height + limits.rise * place.xy().norm() + MAX_RESIDUAL_SIGMAS * sigma;
            if height.abs() <= far {
                points.push(FloorPoint { place, height, sigma });
            }
        }
    }

    /// Plane with the highest score among the mount's floor and planes through three points.
    fn best_initial_plane(&self) -> Column<f64> {
        let score = |plane: &Column<f64>| -> f64 {
            let near =
                |p: &FloorPoint| (1.0 - (p.residual_sigmas(plane) / MAX_RESIDUAL_SIGMAS).powi(2)).max(0.0);
            self.points.iter().step_by(3).map(near).sum()
        };
        let mut best = (score(&Column::zeros()), Column::zeros());
        let mut state = 0x2545_F491_4F6C_DD1D_u64;
        for _ in 0..RANSAC_TRIALS {
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

    /// One step of weighted least squares: the new plane and its information.
    fn refine(&self, plane: Column<f64>) -> Option<(Column<f64>, Matrix3<f64>)> {
        let prior = |sigma: f64| 1.0 / (sigma * sigma);
        let rise = prior(self.limits.prior_rise);
        let mut information = Matrix3::from_diagonal(&Column::new(rise, rise, prior(CAMERA_HEIGHT_SIGMA_M)));
        let mut rhs = Column::zeros();
        for point in &self.points {
            let scaled = point.residual_sigmas(&plane) / MAX_RESIDUAL_SIGMAS;
            if scaled < 1.0 {
                let weight = ((1.0 - scaled * scaled) / point.sigma).powi(2);
                information += point.place * point.place.transpose() * weight;
                rhs += point.place * (point.height * weight);
            }
        }
        Some((Cholesky::new(information)?.solve(&rhs), information))
    }
}

impl FloorPoint {
    /// Distance from a plane, in sigmas.
    fn residual_sigmas(&self, plane: &Column<f64>) -> f64 {
        (self.height - self.place.dot(plane)).abs() / self.sigma
    }
}

impl Limits {
    fn allow(&self, plane: &Column<f64>) -> bool {
        plane.xy().norm() <= self.rise && plane.z.abs() <= self.height
    }
}
