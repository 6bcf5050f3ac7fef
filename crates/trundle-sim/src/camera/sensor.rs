//! The RGB-D sensor: ideal images to noisy images.

use super::depth_model::{DepthModel, DepthTruth};
use super::exposure::ExposureMeter;
use super::tone::Tone;
use super::{ColorNoise, DepthNoise, View, multi_path, shadow};
use crate::rng::{GOLDEN_RATIO_STEP, NormalTable, hash, mix};
use rayon::prelude::*;
use trundle_core::{ColorImage, DepthImage, Invalid, RgbdImage, Stamp};

/// Converts ideal images to the camera's output. Noise is a hash of (seed, frame, pixel): the same on any number of threads.
#[derive(Debug, Clone)]
pub struct RgbdSensor {
    depth: DepthModel,
    color: ColorNoise,
    meter: ExposureMeter,
    tone: Tone,
    seed: u64,
}

/// Buffers of a thread for a row.
#[derive(Debug, Default)]
struct Scratch {
    /// Depths beyond edges.
    beyond: Vec<f32>,
    /// Depths with multi-path.
    lengthened: Vec<f32>,
}

impl RgbdSensor {
    /// A sensor with this noise.
    ///
    /// # Errors
    /// When a parameter is outside its range.
    pub fn new(depth: DepthNoise, color: ColorNoise, seed: u64) -> Result<Self, Invalid> {
        let color = color.validated()?;
        let meter = ExposureMeter::new(color.exposure.clone());
        let tone = Tone::new(&color, meter.gain());
        Ok(Self { depth: DepthModel::new(&depth.validated()?), color, meter, tone, seed })
    }

    /// Adapts auto exposure to the view at `stamp`; the images after it have its gain. No effect with a fixed
    /// gain.
    pub fn adapt(&mut self, view: &View, stamp: Stamp) {
        let before = self.meter.gain();
        self.meter.measure(view, stamp);
        if self.meter.gain() != before {
            self.tone = Tone::new(&self.color, self.meter.gain());
        }
    }

    /// The gain on linear light.
    pub fn gain(&self) -> f64 {
        self.meter.gain()
    }

    /// Image number `frame` of the camera at `stamp` for a view.
    ///
    /// # Errors
    /// When the view's planes differ in size.
    pub fn expose(&self, view: &View, stamp: Stamp, frame: u64) -> Result<RgbdImage, Invalid> {
        let (width, height) = (view.width, view.height);
        let key = hash(self.seed, frame);
        let mut depth = vec![0.0; width * height];
        let mut color = vec![[0; 3]; width * height];
        let rows = depth.par_chunks_mut(width).zip(color.par_chunks_mut(width)).enumerate();
        rows.for_each_init(Scratch::default, |scratch, (y, (depth, color))| {
            scratch.beyond.resize(width, 0.0);
            find_edges(view, y, self.depth.edge_step(), &mut scratch.beyond);
            self.expose_row(view, y, key, scratch, depth, color);
        });
        let color = ColorImage::new(width, height, color)?;
        RgbdImage::new(stamp, color, DepthImage::new(width, height, depth)?)
    }

    fn expose_row(
        &self,
        view: &View,
        y: usize,
        key: u64,
        scratch: &mut Scratch,
        depth: &mut [f32],
        color: &mut [[u8; 3]],
    ) {
        let normals = NormalTable::shared();
        let row = y * view.width..(y + 1) * view.width;
        let mut truth = &view.depth[row.clone()];
        if self.depth.multi_path() > 0.0 {
            multi_path::lengthen(view, y, self.depth.multi_path(), &mut scratch.lengthened);
            truth = &scratch.lengthened;
        }
        // Slices of one length: no bounds are checked within the loop.
        let n = view.width;
        let (truth, beyond) = (&truth[..n], &scratch.beyond[..n]);
        let (colors, cosines) = (&view.color[row.clone()][..n], &view.cosine[row.clone()][..n]);
        let (depth, color) = (&mut depth[..n], &mut color[..n]);
        for x in 0..n {
            let bits = mix(key.wrapping_add(((row.start + x) as u64).wrapping_mul(GOLDEN_RATIO_STEP)));
            let luminance = luminance(colors[x]);
            let truth = DepthTruth { depth: truth[x], beyond: beyond[x], cosine: cosines[x], luminance };
            depth[x] = self.depth.measure(truth, bits, normals);
            color[x] = self.tone.measure(colors[x], bits, normals);
        }
        if self.depth.shadow_px_m() != 0.0 {
            shadow::cast_shadow(&view.depth[row], self.depth.shadow_px_m(), depth);
        }
    }
}

/// 0 to 1.
fn luminance([r, g, b]: [u8; 3]) -> f32 {
    // 0.299, 0.587 and 0.114 of 1024.
    (i32::from(r) * 306 + i32::from(g) * 601 + i32::from(b) * 117) as f32 * (1.0 / (255.0 * 1024.0))
}

/// Depth of a pixel without a surface, m. Source: ours.
const NO_SURFACE_DEPTH_M: f32 = 1e6;

/// For every pixel of row `y` the depth on the other side of its edge, m; 0 without an edge of at least `step` m.
///
/// Inverse depth is an affine function of the pixel on any plane, so its second difference is zero there for any slope; the remainder is
/// the step.
fn find_edges(view: &View, y: usize, step: f32, beyond: &mut [f32]) {
    let row = |y: usize| &view.depth[y * view.width..(y + 1) * view.width];
    let here = row(y);
    beyond.fill(0.0);
    if y > 0 && y + 1 < view.height {
        for (((beyond, &above), &z), &below) in beyond.iter_mut().zip(row(y - 1)).zip(here).zip(row(y + 1)) {
            *beyond = step_to(above, z, below, step);
        }
    }
    for (beyond, near) in beyond[1..].iter_mut().zip(here.windows(3)) {
        let aside = step_to(near[0], near[1], near[2], step);
        *beyond = if *beyond == 0.0 { aside } else { *beyond };
    }
}

/// Depth of the neighbour on the other side of an edge; 0 if neither is. Without branch and division: a row of pixels is SIMD.
fn step_to(before: f32, z: f32, after: f32, step: f32) -> f32 {
    let a = if before > 0.0 { before } else { NO_SURFACE_DEPTH_M };
    let b = if after > 0.0 { after } else { NO_SURFACE_DEPTH_M };
    // z |z/a + z/b - 2| > step
    let product = a * b;
    let is_edge = (z > 0.0) & (z * (z * (a + b) - 2.0 * product).abs() > step * product);
    let other = if (z - a).abs() * b > (z - b).abs() * a { a } else { b };
    if is_edge { other } else { 0.0 }
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
        let mut beyond = [0.0; 16];
        for y in 0..8 {
            find_edges(&floor, y, 0.05, &mut beyond);
            assert_eq!(beyond, [0.0; 16]);
            find_edges(&step, y, 0.05, &mut beyond);
            assert_eq!((beyond[5], beyond[6], beyond[7], beyond[8]), (0.0, 3.0, 2.0, 0.0));
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
