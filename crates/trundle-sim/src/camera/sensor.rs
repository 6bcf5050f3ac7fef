use super::depth_noise::{DepthModel, DepthTruth};
use super::{ColorNoise, DepthNoise, View};
use crate::chance::{GOLDEN, NormalTable, hash, mix};
use rayon::prelude::*;
use trundle_core::{ColorImage, DepthImage, Invalid, RgbdImage, Stamp};

/// Turns ideal images into what the camera delivers. Noise is a hash of (seed, frame, pixel): the same on any number of
/// threads.
#[derive(Debug, Clone)]
pub struct RgbdSensor {
    depth: DepthModel,
    color: ColorNoise,
    seed: u64,
}

impl RgbdSensor {
    /// A sensor with this noise.
    ///
    /// # Errors
    /// When a parameter is outside its range.
    pub fn new(depth: DepthNoise, color: ColorNoise, seed: u64) -> Result<Self, Invalid> {
        Ok(Self { depth: DepthModel::new(depth.validated()?), color: color.validated()?, seed })
    }

    /// What the camera delivers at `stamp` as its image number `frame` when `view` is before it.
    ///
    /// # Errors
    /// When the view's planes differ in size.
    pub fn expose(&self, view: &View, stamp: Stamp, frame: u64) -> Result<RgbdImage, Invalid> {
        let (width, height) = (view.width, view.height);
        let key = hash(self.seed, frame);
        let mut depth = vec![0.0; width * height];
        let mut color = vec![[0; 3]; width * height];
        depth.par_chunks_mut(width).zip(color.par_chunks_mut(width)).enumerate().for_each(
            |(y, (depth, color))| {
                self.expose_row(view, y, key, depth, color);
            },
        );
        let color = ColorImage::new(width, height, color)?;
        RgbdImage::new(stamp, color, DepthImage::new(width, height, depth)?)
    }

    fn expose_row(&self, view: &View, y: usize, key: u64, depth: &mut [f32], color: &mut [[u8; 3]]) {
        let normals = NormalTable::shared();
        let step = self.depth.edge_step();
        for x in 0..view.width {
            let at = y * view.width + x;
            let bits = mix(key.wrapping_add((at as u64).wrapping_mul(GOLDEN)));
            let truth = DepthTruth {
                depth: view.depth[at],
                beyond: beyond_edge(view, (x, y), step),
                cosine: view.cosine[at],
                luminance: luminance(view.color[at]),
            };
            depth[x] = self.depth.measure(truth, bits, normals);
            color[x] = self.color.measure(view.color[at], bits, normals);
        }
    }
}

/// 0 to 1.
fn luminance([r, g, b]: [u8; 3]) -> f32 {
    (0.299 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b)) / 255.0
}

/// Stands for the depth of "nothing there", m.
const FAR: f32 = 1e6;

/// The depth on the other side of an edge that the pixel lies at, m; 0 when there is no edge of at least `step` m.
///
/// Inverse depth is an affine function of the pixel on any plane, so its second difference vanishes there, however steep
/// the plane; what is left is the step.
fn beyond_edge(view: &View, (x, y): (usize, usize), step: f32) -> f32 {
    let at = y * view.width + x;
    let z = view.depth[at];
    let mut beyond = 0.0;
    if z > 0.0 && y > 0 && y + 1 < view.height {
        beyond = step_to(view.depth[at - view.width], z, view.depth[at + view.width], step);
    }
    if z > 0.0 && beyond == 0.0 && x > 0 && x + 1 < view.width {
        beyond = step_to(view.depth[at - 1], z, view.depth[at + 1], step);
    }
    beyond
}

/// Which of a pixel's two neighbours lies beyond an edge, its depth; 0 when neither does.
fn step_to(before: f32, z: f32, after: f32, step: f32) -> f32 {
    let a = if before > 0.0 { before } else { FAR };
    let b = if after > 0.0 { after } else { FAR };
    // z |z/a + z/b - 2| > step, without divisions.
    let product = a * b;
    if z * (z * (a + b) - 2.0 * product).abs() <= step * product {
        0.0
    } else if (z - a).abs() * b > (z - b).abs() * a {
        a
    } else {
        b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(depth: impl Fn(usize, usize) -> f32) -> View {
        let (width, height) = (16, 8);
        let depth = (0..width * height).map(|i| depth(i % width, i / width)).collect();
        View {
            width,
            height,
            depth,
            color: vec![[128; 3]; width * height],
            cosine: vec![1.0; width * height],
        }
    }

    #[test]
    fn a_slanted_plane_has_no_edge_and_a_step_has_two_columns_of_it() {
        let floor = view(|x, y| 1.0 / (0.05 + 0.01 * x as f32 + 0.03 * y as f32));
        let step = view(|x, _| if x < 7 { 2.0 } else { 3.0 });
        for (x, y) in (0..8).flat_map(|y| (0..16).map(move |x| (x, y))) {
            assert_eq!(beyond_edge(&floor, (x, y), 0.05), 0.0);
            let expected = match x {
                6 => 3.0,
                7 => 2.0,
                _ => 0.0,
            };
            assert_eq!(beyond_edge(&step, (x, y), 0.05), expected, "{x} {y}");
        }
    }

    #[test]
    fn without_noise_the_image_is_the_view() {
        let sensor = RgbdSensor::new(DepthNoise::none(), ColorNoise::none(), 1).unwrap();
        let step = view(|x, _| if x < 7 { 2.0 } else { 3.0 });
        let image = sensor.expose(&step, Stamp::default(), 0).unwrap();
        assert!(image.depth().data().iter().zip(&step.depth).all(|(a, b)| (a - b).abs() < 1e-6));
        assert_eq!(image.color().data(), step.color);
    }
}
