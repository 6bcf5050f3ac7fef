//! The fan of beams, and the beam of each pixel.

use super::pixel_rays::{LensRays, ray_through};
use nalgebra::Matrix3;
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{PinholeCamera, Pose3, Vector3, wrap_angle};

/// The fan of beams over the pixels. A pixel's bearing does not depend on its depth.
#[derive(Debug, Clone)]
pub(super) struct Fan {
    /// The beam of each pixel, row by row.
    pub(super) beam_of: Vec<u16>,
    pub(super) beams: usize,
    /// Bearing of the middle of beam 0, base frame, rad.
    pub(super) angle_min: f64,
    /// Angle between neighbouring beams, rad.
    pub(super) angle_increment: f64,
}

/// Maximum angle between neighbouring beams \[rad\]. A camera that points straight down reaches this angle. Source: ours.
const MAX_BEAM_INCREMENT_RAD: f64 = 0.035;
/// Minimum angle between neighbouring beams \[rad\]. A full circle of beams is counted in 16 bits. Source: ours.
const MIN_BEAM_INCREMENT_RAD: f64 = 1e-4;

/// Coefficients of t, t^3, t^5 and so on of the arc tangent over 0 to 1. Source: \[Abramowitz64\], equation 4.4.49.
const ATAN_COEFFICIENTS: [f64; 9] = [
    1.0,
    -0.333_331_452_8,
    0.199_935_508_5,
    -0.142_088_994_4,
    0.106_562_639_3,
    -0.075_289_640_0,
    0.042_909_613_8,
    -0.016_165_736_7,
    0.002_866_225_7,
];
/// Largest error of [`nearly_atan2`] \[rad\]. The bearing of a pixel nearer to the edge of a beam is computed exactly. Source: ours, five
/// times the 2e-8 of \[Abramowitz64\].
const MAX_NEAR_ERROR_RAD: f64 = 1e-7;

impl Fan {
    pub(super) fn new(lens: &LensRays, base_from_camera: &Pose3) -> Self {
        let forward = forward_bearing(base_from_camera);
        let rays = PixelBearings { lens, base_from_lens: base_from_camera.rotation_matrix(), forward };
        let nearly: Vec<f64> = (0..lens.len()).map(|i| rays.nearly(i)).collect();
        let (right, left) = rays.extremes(&nearly);

        let bearing_at = |x: f64, y: f64| rays.of_ray(ray_through(lens.camera(), x, y));
        let widest =
            widest_pixel(lens.camera(), bearing_at).clamp(MIN_BEAM_INCREMENT_RAD, MAX_BEAM_INCREMENT_RAD);
        let beams = (((left - right) / widest).floor() as usize).max(1);
        let angle_increment = ((left - right) / beams as f64).max(1e-5);
        let beam = |bearing: f64| (((bearing - right) / angle_increment) as usize).min(beams - 1) as u16;
        let (per_rad, margin) = (1.0 / angle_increment, MAX_NEAR_ERROR_RAD / angle_increment);
        let beam_of = |(i, &nearly): (usize, &f64)| {
            let place = (nearly - right) * per_rad;
            let from_edge = (place - place.round()).abs();
            if from_edge > margin && place > 0.0 {
                (place as usize).min(beams - 1) as u16
            } else {
                beam(rays.exactly(i))
            }
        };
        let beam_of = nearly.iter().enumerate().map(beam_of).collect();
        Self { beam_of, beams, angle_min: forward + right + angle_increment / 2.0, angle_increment }
    }
}

/// The bearings of the pixels from the forward bearing, rad.
struct PixelBearings<'a> {
    lens: &'a LensRays,
    base_from_lens: Matrix3<f64>,
    forward: f64,
}

impl PixelBearings<'_> {
    /// The bearing of a ray of the camera.
    fn of_ray(&self, ray: Vector3) -> f64 {
        let d = self.base_from_lens * ray;
        wrap_angle(d.y.atan2(d.x) - self.forward)
    }

    /// The bearing of a pixel.
    fn exactly(&self, i: usize) -> f64 {
        self.of_ray(self.lens.ray(i))
    }

    /// The bearing of a pixel to within [`MAX_NEAR_ERROR_RAD`].
    fn nearly(&self, i: usize) -> f64 {
        let d = self.base_from_lens * self.lens.ray(i);
        let near = wrap_angle(nearly_atan2(d.y, d.x) - self.forward);
        // At half a turn the error may change the sign.
        if near.abs() < PI - MAX_NEAR_ERROR_RAD { near } else { self.exactly(i) }
    }

    /// The smallest and the largest bearing, exactly.
    fn extremes(&self, nearly: &[f64]) -> (f64, f64) {
        let (low, high) = nearly.iter().fold((f64::MAX, f64::MIN), |(lo, hi), b| (lo.min(*b), hi.max(*b)));
        let (low, high) = (low + 2.0 * MAX_NEAR_ERROR_RAD, high - 2.0 * MAX_NEAR_ERROR_RAD);
        let outermost = nearly.iter().enumerate().filter(|(_, b)| **b <= low || **b >= high);
        outermost
            .map(|(i, _)| self.exactly(i))
            .fold((f64::MAX, f64::MIN), |(lo, hi), b| (lo.min(b), hi.max(b)))
    }
}

/// The angle of (x, y) within [`MAX_NEAR_ERROR_RAD`], at a fifth of the cost of `atan2`: a polynomial over an eighth of a turn
/// \[Abramowitz64, 4.4.49\].
fn nearly_atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    let (small, large) = (ax.min(ay), ax.max(ay));
    let t = if large > 0.0 { small / large } else { 0.0 };
    let t2 = t * t;
    let polynomial = ATAN_COEFFICIENTS.iter().rev().fold(0.0, |sum, coefficient| sum * t2 + coefficient);
    let eighth = t * polynomial;
    let quarter = if ay > ax { FRAC_PI_2 - eighth } else { eighth };
    let half = if x < 0.0 { PI - quarter } else { quarter };
    half.copysign(y)
}

/// The largest difference of bearing between neighbouring pixels, rad, in the middle of the image and of its sides. A finer beam would fall
/// between the columns.
fn widest_pixel(camera: &PinholeCamera, bearing: impl Fn(f64, f64) -> f64) -> f64 {
    let (right, bottom) = (camera.width() as f64 - 1.0, camera.height() as f64 - 1.0);
    let (cx, cy) = (right / 2.0, bottom / 2.0);
    let width_at = |(x, y): (f64, f64)| {
        let here = bearing(x, y);
        let step = |x, y| wrap_angle(bearing(x, y) - here).abs();
        step(x + 1.0, y).max(step(x, y + 1.0))
    };
    [(cx, cy), (cx, 0.0), (cx, bottom), (0.0, cy), (right, cy)].into_iter().map(width_at).fold(0.0, f64::max)
}

/// Bearing of the optical axis, base frame, rad; bearing of the image's top if the camera points straight up or down.
fn forward_bearing(base_from_camera: &Pose3) -> f64 {
    let axis = base_from_camera.rotate(Vector3::z());
    let top = base_from_camera.rotate(-Vector3::y());
    let along = if axis.xy().norm() > 1e-3 { axis } else { top };
    along.y.atan2(along.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    #[test]
    fn the_near_angle_is_within_its_error_all_around() {
        for i in 0..100_000 {
            let angle = f64::from(i) * 1e-4 - 5.0;
            let (y, x) = angle.sin_cos();
            let error = (nearly_atan2(y, x) - y.atan2(x)).abs();
            assert!(error < MAX_NEAR_ERROR_RAD / 2.0, "{angle}: {error}");
        }
        assert_eq!(nearly_atan2(0.0, 0.0), 0.0);
    }

    /// The fan by the definition: every bearing exactly.
    fn by_definition(lens: &LensRays, pose: &Pose3) -> (Vec<u16>, f64, f64) {
        let forward = forward_bearing(pose);
        let rays = PixelBearings { lens, base_from_lens: pose.rotation_matrix(), forward };
        let bearings: Vec<f64> = (0..lens.len()).map(|i| rays.exactly(i)).collect();
        let (right, left) =
            bearings.iter().fold((f64::MAX, f64::MIN), |(lo, hi), b| (lo.min(*b), hi.max(*b)));
        let fan = Fan::new(lens, pose);
        let increment = ((left - right) / fan.beams as f64).max(1e-5);
        let beam = |b: &f64| (((b - right) / increment) as usize).min(fan.beams - 1) as u16;
        (bearings.iter().map(beam).collect(), forward + right + increment / 2.0, increment)
    }

    #[test]
    fn every_pixel_falls_into_the_beam_of_its_exact_bearing() {
        let lens = LensRays::new(PinholeCamera::kinect_v1());
        for (tilt, roll, yaw) in
            [(0.0, 0.0, 0.0), (0.5, 0.2, 1.0), (1.2, -0.4, 3.1), (1.57, 0.0, -2.0), (-0.3, 3.0, 0.7)]
        {
            let level = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
            let turn = *Rotation3::from_euler_angles(roll, tilt, yaw).matrix();
            let turned = Pose3::from_matrix(turn * level, Vector3::zeros());
            let fan = Fan::new(&lens, &turned);
            let (beam_of, angle_min, increment) = by_definition(&lens, &turned);
            assert!(fan.beam_of == beam_of, "tilt {tilt}, roll {roll}, yaw {yaw}");
            assert_eq!((fan.angle_min, fan.angle_increment), (angle_min, increment));
        }
    }
}
