//! Depth pixels projected into the output camera.

use super::footprints::{Footprint, Footprints};
use trundle_core::{DepthImage, Distortion, PinholeCamera, Pose3, Vector2};

/// Nearest depth in front of the output camera that is projected \[m\]. Source: ours; no depth camera measures nearer.
const MIN_OUTPUT_DEPTH_M: f32 = 0.01;
/// Largest distance of a point outside the output image before distortion, in image sides. A polynomial lens folds far outside its image,
/// so a more distant point could appear inside. Source: ours.
const MAX_OUTSIDE_SIDES: f32 = 0.25;

/// Rays of the depth camera in the frame of the output camera.
#[derive(Debug, Clone)]
pub(super) struct Projection {
    depth_camera: PinholeCamera,
    output: PinholeCamera,
    has_distortion: bool,
    /// For each depth pixel: the ray to depth 1, rotated into the output frame.
    rays: Vec<[f32; 3]>,
    /// Place of the depth camera in the output frame \[m\].
    translation: [f32; 3],
    /// Half the side of a depth pixel in output pixels at equal depth, across and down \[px\].
    half_pixel: [f32; 2],
}

impl Projection {
    pub(super) fn new(depth: &PinholeCamera, output_from_depth: Pose3, output: PinholeCamera) -> Self {
        let ray = |(x, y): (usize, usize)| {
            let pixel = depth.undistort(Vector2::new(x as f64, y as f64));
            let ray = output_from_depth.rotate(depth.unproject(pixel, 1.0));
            [ray.x as f32, ray.y as f32, ray.z as f32]
        };
        let pixels = (0..depth.height()).flat_map(|y| (0..depth.width()).map(move |x| (x, y)));
        let place = output_from_depth.translation;
        Self {
            depth_camera: *depth,
            output,
            has_distortion: output.distortion() != Distortion::default(),
            rays: pixels.map(ray).collect(),
            translation: [place.x as f32, place.y as f32, place.z as f32],
            half_pixel: [0.5 * (output.fx() / depth.fx()) as f32, 0.5 * (output.fy() / depth.fy()) as f32],
        }
    }

    pub(super) fn depth_camera(&self) -> &PinholeCamera {
        &self.depth_camera
    }

    /// The footprint of each depth pixel without its neighbours.
    pub(super) fn project(&self, depth: &DepthImage, footprints: &mut Footprints) {
        let pixels = depth.data().iter().zip(&self.rays);
        for (footprint, (depth, ray)) in footprints.all_mut().iter_mut().zip(pixels) {
            *footprint = self.footprint(*depth, ray).unwrap_or(Footprint::NONE);
        }
    }

    fn footprint(&self, depth: f32, ray: &[f32; 3]) -> Option<Footprint> {
        let z = depth * ray[2] + self.translation[2];
        if !(depth > 0.0 && z > MIN_OUTPUT_DEPTH_M) {
            return None;
        }
        let (x, y) = (depth * ray[0] + self.translation[0], depth * ray[1] + self.translation[1]);
        let [x, y] = self.pixel(x / z, y / z)?;
        let scale = depth / z;
        Some(Footprint { x, y, z, half_x: self.half_pixel[0] * scale, half_y: self.half_pixel[1] * scale })
    }

    /// The output pixel of a point at (x, y) and depth 1.
    fn pixel(&self, x: f32, y: f32) -> Option<[f32; 2]> {
        let c = &self.output;
        let (x, y) = (x * c.fx() as f32 + c.cx() as f32, y * c.fy() as f32 + c.cy() as f32);
        let is_near = |value: f32, side: usize| {
            let side = side as f32;
            value > -MAX_OUTSIDE_SIDES * side && value < (1.0 + MAX_OUTSIDE_SIDES) * side
        };
        if !(is_near(x, c.width()) && is_near(y, c.height())) {
            return None;
        }
        if !self.has_distortion {
            return Some([x, y]);
        }
        let pixel = c.distort(Vector2::new(x as f64, y as f64));
        Some([pixel.x as f32, pixel.y as f32])
    }
}
