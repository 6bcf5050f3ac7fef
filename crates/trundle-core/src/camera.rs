//! The pinhole camera model: intrinsics, Brown-Conrady distortion, rolling-shutter readout, and presets.

use crate::{DepthImage, Invalid, Vector2, Vector3, require_finite, require_in, require_positive};
use serde::{Deserialize, Serialize};

/// Lens distortion of Brown and Conrady, in the order of OpenCV.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Distortion {
    /// Radial coefficient of r^2, in the order of OpenCV, any finite number. Default 0: a rectified image.
    pub k1: f64,
    /// Radial coefficient of r^4, any finite number. Default 0: a rectified image.
    pub k2: f64,
    /// First tangential coefficient, any finite number. Default 0: a rectified image.
    pub p1: f64,
    /// Second tangential coefficient, any finite number. Default 0: a rectified image.
    pub p2: f64,
    /// Radial coefficient of r^6, any finite number. Default 0: a rectified image.
    pub k3: f64,
}

/// Smallest and largest plausible focal length of a pinhole camera, as a multiple of the image's side \[1\]: fields of view of 160 and 3 degrees.
/// Source: ours.
pub const FOCAL_LENGTH_PER_SIDE: (f64, f64) = (0.09, 20.0);

/// A pinhole camera with Brown-Conrady distortion and a rolling shutter. Pixel (0, 0) is the centre of the top-left pixel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct PinholeCamera {
    /// Width of the image, px, 1 to 16384. Without the table 512: the depth camera of a Kinect V2 \[Li18\].
    width: usize,
    /// Height of the image, px, 1 to 16384. Without the table 424: the depth camera of a Kinect V2 \[Li18\].
    height: usize,
    /// Focal length along x, px, above 0. A wrong value distorts distances and turns; `trundle calibrate camera` measures it. Without the
    /// table 361.56: a field of view of 70.6 deg \[Li18\].
    fx: f64,
    /// Focal length along y, px, above 0. Without the table 367.19: a field of view of 60 deg \[Li18\].
    fy: f64,
    /// Principal point along x, px, from the centre of the left column, in a robot file 0 to width - 1. Without the table 255.5: the middle
    /// of the image.
    cx: f64,
    /// Principal point along y, px, from the centre of the top row, in a robot file 0 to height - 1. Without the table 211.5: the middle of
    /// the image.
    cy: f64,
    /// Lens distortion.
    distortion: Distortion,
    /// Readout time of the rolling shutter from the first to the last row, s, 0 or more. Default 0: a global shutter.
    #[serde(skip_serializing_if = "is_zero")]
    readout: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Unchecked camera fields of a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    #[serde(default)]
    distortion: Distortion,
    #[serde(default)]
    readout: f64,
}

impl TryFrom<Unchecked> for PinholeCamera {
    type Error = Invalid;

    fn try_from(c: Unchecked) -> Result<Self, Invalid> {
        Self::new((c.width, c.height), (c.fx, c.fy), (c.cx, c.cy), c.distortion)?.with_readout(c.readout)
    }
}

/// Largest number of columns or rows. Larger numbers are refused as typing errors. Source: ours.
const MAX_PIXELS: usize = 16_384;

/// Longest readout time of a camera: 0.05 s. A longer one is refused: no colour camera of a robot takes longer. Source: ours.
const MAX_READOUT_S: f64 = 0.05;

impl PinholeCamera {
    /// A camera of `width` x `height` px, focal lengths and principal point in px.
    ///
    /// # Errors
    /// When a side is zero or above 16384 px, a focal length is not positive, or any number is not finite.
    pub fn new(
        (width, height): (usize, usize),
        (fx, fy): (f64, f64),
        (cx, cy): (f64, f64),
        distortion: Distortion,
    ) -> Result<Self, Invalid> {
        let is_a_side = |pixels: usize| (1..=MAX_PIXELS).contains(&pixels);
        if !is_a_side(width) || !is_a_side(height) {
            let size = format!("{width} x {height}");
            return Err(Invalid::new("camera size", size, "px", "1 x 1 to 16384 x 16384"));
        }
        require_positive("fx", fx, "px")?;
        require_positive("fy", fy, "px")?;
        require_finite("cx", cx, "px")?;
        require_finite("cy", cy, "px")?;
        let Distortion { k1, k2, p1, p2, k3 } = distortion;
        for (name, value) in [("k1", k1), ("k2", k2), ("p1", p1), ("p2", p2), ("k3", k3)] {
            require_finite(name, value, "")?;
        }
        Ok(Self { width, height, fx, fy, cx, cy, distortion, readout: 0.0 })
    }

    /// The same camera with a rolling shutter: `readout` is the time from the first to the last row of an image, s. 0, the value of
    /// [`PinholeCamera::new`], is a global shutter.
    ///
    /// # Errors
    /// When the time is outside 0 to 0.05 s.
    pub fn with_readout(self, readout: f64) -> Result<Self, Invalid> {
        require_in("readout", readout, "s", 0.0, MAX_READOUT_S)?;
        Ok(Self { readout, ..self })
    }

    /// A camera without distortion from its fields of view (rad), principal point in the middle.
    ///
    /// # Errors
    /// When a side is zero or a field of view is outside (0, pi).
    pub fn from_field_of_view(
        (width, height): (usize, usize),
        (horizontal, vertical): (f64, f64),
    ) -> Result<Self, Invalid> {
        let focal = |name: &str, size: usize, fov: f64| {
            if fov > 0.0 && fov < std::f64::consts::PI {
                Ok(size as f64 / 2.0 / (fov / 2.0).tan())
            } else {
                Err(Invalid::new(name, fov, "rad", "0 to pi, exclusive"))
            }
        };
        let fx = focal("horizontal field of view", width, horizontal)?;
        let fy = focal("vertical field of view", height, vertical)?;
        let centre = ((width as f64 - 1.0) / 2.0, (height as f64 - 1.0) / 2.0);
        Self::new((width, height), (fx, fy), centre, Distortion::default())
    }

    /// Kinect V2 depth camera with colour registered to it: 512 x 424, 70.6 x 60 deg \[Li18\], rectified.
    pub fn kinect_v2() -> Self {
        Self::from_field_of_view((512, 424), (70.6_f64.to_radians(), 60.0_f64.to_radians()))
            .expect("invariant: the preset is valid")
    }

    /// Kinect v1 with the intrinsics that the TUM RGB-D benchmark recommends for registered depth: 640 x 480,
    /// focal length 525 px, principal point (319.5, 239.5) \[Sturm12\].
    pub fn kinect_v1() -> Self {
        Self::new((640, 480), (525.0, 525.0), (319.5, 239.5), Distortion::default())
            .expect("invariant: the preset is valid")
    }

    /// Time from the first to the last row of an image, s: a rolling shutter; 0 if all rows are taken simultaneously.
    pub fn readout(&self) -> f64 {
        self.readout
    }

    /// Columns, px.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, px.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Focal length across, px.
    pub fn fx(&self) -> f64 {
        self.fx
    }

    /// Focal length down, px.
    pub fn fy(&self) -> f64 {
        self.fy
    }

    /// Principal point, column, px.
    pub fn cx(&self) -> f64 {
        self.cx
    }

    /// Principal point, row, px.
    pub fn cy(&self) -> f64 {
        self.cy
    }

    /// Lens distortion.
    pub fn distortion(&self) -> Distortion {
        self.distortion
    }

    /// Position of a point in the camera frame (m) in a rectified image, px; `None` behind the camera.
    pub fn project(&self, p_camera: Vector3) -> Option<Vector2> {
        (p_camera.z > 0.0).then(|| {
            let inverse = 1.0 / p_camera.z;
            Vector2::new(self.fx * p_camera.x * inverse + self.cx, self.fy * p_camera.y * inverse + self.cy)
        })
    }

    /// The point (camera frame, m) seen at a rectified pixel with `depth` m along the optical axis.
    pub fn unproject(&self, pixel: Vector2, depth: f64) -> Vector3 {
        Vector3::new((pixel.x - self.cx) / self.fx * depth, (pixel.y - self.cy) / self.fy * depth, depth)
    }

    /// Points (camera frame, m) of a raw depth image of this camera, at every `step`-th pixel of every `step`-th row that has depth.
    pub fn points<'a>(&'a self, depth: &'a DepthImage, step: usize) -> impl Iterator<Item = Vector3> + 'a {
        let pixels = (0..depth.height())
            .step_by(step)
            .flat_map(move |y| (0..depth.width()).step_by(step).map(move |x| (x, y)));
        pixels.filter(|&pixel| depth[pixel] > 0.0).map(|(x, y)| {
            let rectified = self.undistort(Vector2::new(x as f64, y as f64));
            self.unproject(rectified, f64::from(depth[(x, y)]))
        })
    }

    /// Whether a pixel position is inside the image (pixel centres at whole numbers).
    pub fn contains(&self, pixel: Vector2) -> bool {
        pixel.x >= -0.5
            && pixel.y >= -0.5
            && pixel.x < self.width as f64 - 0.5
            && pixel.y < self.height as f64 - 0.5
    }

    /// Position of a rectified pixel in the raw image.
    pub fn distort(&self, pixel: Vector2) -> Vector2 {
        let n = Vector2::new((pixel.x - self.cx) / self.fx, (pixel.y - self.cy) / self.fy);
        let d = self.distort_normalized(n);
        Vector2::new(d.x * self.fx + self.cx, d.y * self.fy + self.cy)
    }

    /// Position of a raw pixel in the rectified image: the inverse of [`PinholeCamera::distort`] by 20 fixed-point steps. The error is
    /// below 1e-6 px for lenses like the Kinect's within the image.
    pub fn undistort(&self, pixel: Vector2) -> Vector2 {
        if self.distortion == Distortion::default() {
            return pixel;
        }
        let raw = Vector2::new((pixel.x - self.cx) / self.fx, (pixel.y - self.cy) / self.fy);
        let mut n = raw;
        for _ in 0..20 {
            n += raw - self.distort_normalized(n);
        }
        Vector2::new(n.x * self.fx + self.cx, n.y * self.fy + self.cy)
    }

    fn distort_normalized(&self, n: Vector2) -> Vector2 {
        let Distortion { k1, k2, p1, p2, k3 } = self.distortion;
        let r2 = n.norm_squared();
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        Vector2::new(
            n.x * radial + 2.0 * p1 * n.x * n.y + p2 * (r2 + 2.0 * n.x * n.x),
            n.y * radial + p1 * (r2 + 2.0 * n.y * n.y) + 2.0 * p2 * n.x * n.y,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn freiburg1() -> PinholeCamera {
        let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
        PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap()
    }

    proptest! {
        #[test]
        fn undistort_inverts_distort(x in 0.0..640.0, y in 0.0..480.0) {
            let camera = freiburg1();
            let raw = Vector2::new(x, y);
            prop_assert!((camera.distort(camera.undistort(raw)) - raw).norm() < 1e-4);
        }

        #[test]
        fn project_inverts_unproject(x in 0.0..640.0, y in 0.0..480.0, z in 0.3..8.0) {
            let camera = freiburg1();
            let pixel = Vector2::new(x, y);
            prop_assert!((camera.project(camera.unproject(pixel, z)).unwrap() - pixel).norm() < 1e-9);
        }
    }

    #[test]
    fn the_kinect_sees_its_field_of_view() {
        let camera = PinholeCamera::kinect_v2();
        let edge = camera.unproject(Vector2::new(-0.5, 211.5), 1.0);
        assert!((edge.x.atan().to_degrees() + 35.3).abs() < 1e-9);
    }

    #[test]
    fn a_rolling_shutter_is_part_of_the_camera() {
        let camera = freiburg1().with_readout(0.026).unwrap();
        assert_eq!((camera.readout(), freiburg1().readout()), (0.026, 0.0));
        for readout in [-0.001, 0.051, f64::NAN] {
            assert_eq!(freiburg1().with_readout(readout).unwrap_err().field, "readout");
        }
    }

    #[test]
    fn broken_cameras_are_refused_by_name() {
        let error =
            PinholeCamera::new((640, 480), (-1.0, 500.0), (320.0, 240.0), Distortion::default()).unwrap_err();
        assert_eq!(error.field, "fx");
        for size in [(0, 480), (5_120_000_000, 424)] {
            let camera = PinholeCamera::new(size, (500.0, 500.0), (320.0, 240.0), Distortion::default());
            assert_eq!(camera.unwrap_err().field, "camera size", "{size:?}");
        }
    }
}
