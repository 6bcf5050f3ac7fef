//! Classification of one row of pixels.

use super::pixel_model::{MIN_SURFACE_DEPTH_M, PixelModel, SURFACE_SIGMAS};

/// Classification of the pixels of a row, column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ClassifiedRow {
    /// A [`kind`], and the bins of the beam that the pixel clears: from `mark >> 8 & 255` to below `mark >> 16`.
    pub(super) marks: Vec<u32>,
    /// Range over the floor, m; of a hole, the farthest position of its edge.
    pub(super) ranges: Vec<f32>,
    /// Height above the floor, m.
    pub(super) heights: Vec<f32>,
}

/// Classes of pixels.
pub(super) mod kind {
    /// Unknown, or no depth. Source: ours.
    pub const NOTHING: u32 = 0;
    /// Class of a pixel in the height band. Source: ours.
    pub const OBSTACLE: u32 = 1;
    /// Class of a pixel in the height band with too few neighbours on its surface. Source: ours.
    pub const DOUBTFUL: u32 = 2;
    /// The floor. Source: ours.
    pub const FLOOR: u32 = 3;
    /// The ray passed through the band and ended above or behind the band. Source: ours.
    pub const PASSING: u32 = 4;
    /// Far below the floor. Source: ours.
    pub const DROP: u32 = 5;
}

/// Three rows of an image and the rays of the middle row's pixels, each as wide as the image.
#[derive(Debug, Clone, Copy)]
pub(super) struct RowInput<'a> {
    pub(super) depths: [&'a [f32]; 3],
    pub(super) u: &'a [f32],
    pub(super) v: &'a [f32],
}

impl ClassifiedRow {
    pub(super) fn resize(&mut self, width: usize) {
        self.marks.resize(width, kind::NOTHING);
        self.ranges.resize(width, 0.0);
        self.heights.resize(width, 0.0);
    }

    /// Classifies the pixels of a row except the first and the last. `PASSES`: whether rays that pass through the band get a class.
    pub(super) fn classify<const PASSES: bool>(&mut self, model: &PixelModel, input: &RowInput<'_>) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.classify_avx2::<PASSES>(model, input) };
        }
        self.classify_scalar::<PASSES>(model, input);
    }

    /// The arithmetic of [`Self::classify_scalar`] in vectors of eight.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn classify_avx2<const PASSES: bool>(&mut self, model: &PixelModel, input: &RowInput<'_>) {
        self.classify_all::<PASSES>(model, input);
    }

    fn classify_scalar<const PASSES: bool>(&mut self, model: &PixelModel, input: &RowInput<'_>) {
        self.classify_all::<PASSES>(model, input);
    }

    /// Loop without a branch, which the compiler can vectorise. No sum is reordered: vector and scalar code give the same bits.
    #[inline(always)]
    fn classify_all<const PASSES: bool>(&mut self, m: &PixelModel, input: &RowInput<'_>) {
        let inner = self.marks.len().saturating_sub(2);
        let [above, here, below] =
            input.depths.map(|row| [&row[..inner], &row[1..=inner], &row[2..inner + 2]]);
        let (u, v) = (&input.u[1..=inner], &input.v[1..=inner]);
        let marks = &mut self.marks[1..=inner];
        let (ranges, heights) = (&mut self.ranges[1..=inner], &mut self.heights[1..=inner]);
        for i in 0..inner {
            let z = here[1][i];
            let along = |form: &[f32; 3]| form[0] * u[i] + form[1] * v[i] + form[2];
            let (ahead, left, rise) = (along(&m.ray.ahead), along(&m.ray.left), along(&m.ray.rise));
            let run = (ahead * ahead + left * left).sqrt();
            let (range, height) = (run * z, m.camera_height + rise * z);
            let noise = m.noise.sigma(z);
            let edge = greater(m.floor_sigmas * rise.abs() * noise + m.tilt * range, m.low);
            let window = greater(SURFACE_SIGMAS * noise, MIN_SURFACE_DEPTH_M);
            let agrees = |other: f32| u32::from((other - z).abs() <= window);
            let support = agrees(above[0][i])
                + agrees(above[1][i])
                + agrees(above[2][i])
                + agrees(here[0][i])
                + agrees(here[2][i])
                + agrees(below[0][i])
                + agrees(below[1][i])
                + agrees(below[2][i]);
            let (hit, seen) = (support >= m.min_support.hit, support >= m.min_support.free);

            let valid = (z >= m.min_depth) & (z <= m.max_depth);
            let near = range <= m.max_range;
            let in_band = valid & near & (height > edge) & (height <= m.high);
            let floor = valid & (height <= m.low) & (height >= -edge) & seen;
            // Range at which the ray crosses the floor.
            let fall = m.camera_height - height;
            let crossing = range * m.camera_height / fall;
            // Flying pixels are between two surfaces, therefore never below the floor.
            let drop = valid & (height < -greater(edge, m.drop_depth)) & (crossing <= m.max_range) & seen;

            let mut mark = pick(in_band, pick(hit, kind::OBSTACLE, kind::DOUBTFUL), kind::NOTHING);
            let (from, to) = (range * m.floor_share(), range);
            let reach = |from: f32, to: f32| bin(from, m) << 8 | bin(to, m) << 16;
            mark = pick(floor, kind::FLOOR | reach(from, to), mark);
            if PASSES {
                let (passes, from, to) = passage(m, rise, (range, height), run);
                mark = pick(valid & passes & seen & !in_band & !floor, kind::PASSING | reach(from, to), mark);
            }
            marks[i] = pick(drop, kind::DROP, mark);
            ranges[i] = if drop { crossing } else { range };
            heights[i] = height;
        }
    }
}

/// Whether a ray that ended above or behind the band passed through the band, with the ranges of entry and exit.
#[inline(always)]
fn passage(m: &PixelModel, rise: f32, (range, height): (f32, f32), run: f32) -> (bool, f32, f32) {
    let headroom = m.high - m.camera_height;
    let end = if range < m.max_range { range } else { m.max_range };
    let end_height = m.camera_height + (height - m.camera_height) * end / range;
    let leaves = headroom * run / rise;
    let ended = (height > m.high) | (range > m.max_range);
    if rise > 0.0 {
        let to = if leaves < end { leaves } else { end };
        (ended & (headroom > 0.0), 0.0, to)
    } else {
        let enters = greater(leaves, 0.0);
        let enters = if headroom < 0.0 { enters } else { 0.0 };
        (ended & (end_height <= m.high) & (end_height >= -m.low), enters, end)
    }
}

/// The bin of a range, at most 127; bin 128 is for larger ranges.
#[inline(always)]
fn bin(range: f32, m: &PixelModel) -> u32 {
    // Rounds down by floating-point addition, since no instruction rounds whole vectors.
    const MAGIC: f32 = 8_388_608.0;
    let scaled = range * m.bins_per_metre - 0.5;
    let within = if scaled < 128.0 { scaled } else { 128.0 };
    let within = greater(within, 0.0);
    (within + MAGIC).to_bits() & 255
}

/// The greater of two values; the second if the first is not a number.
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn pick(condition: bool, yes: u32, no: u32) -> u32 {
    if condition { yes } else { no }
}

#[cfg(test)]
mod tests {
    use super::super::DepthScanConfig;
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Pose3, Vector3};

    /// A level camera at this height that points ahead; v is the descent of a ray per metre of depth.
    fn model(height: f64) -> PixelModel {
        let ahead = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        PixelModel::new(
            &DepthScanConfig::default(),
            &Pose3::from_matrix(ahead, Vector3::new(0.0, 0.0, height)),
        )
    }

    /// Class of a pixel among equal neighbours, its range, and the bins that it shows free.
    fn classified(height: f64, rise: f32, z: f32) -> (u32, f32, (u32, u32)) {
        let mut row = ClassifiedRow::default();
        row.resize(3);
        let (depths, u, v) = ([z; 3], [0.0; 3], [-rise; 3]);
        let input = RowInput { depths: [&depths; 3], u: &u, v: &v };
        row.classify::<true>(&model(height), &input);
        let mark = row.marks[1];
        (mark & 255, row.ranges[1], (mark >> 8 & 255, mark >> 16))
    }

    /// The bin at a range of m.
    fn at(range: f32) -> u32 {
        (range * 128.0 / 6.0) as u32
    }

    #[test]
    fn the_band_is_an_obstacle_and_the_floor_is_not() {
        assert_eq!(classified(0.4, 0.0, 2.0).0, kind::OBSTACLE);
        // The floor: an object of 0.05 m height hides this point from 7/8 of its range on.
        assert_eq!(classified(0.4, -0.2, 2.0), (kind::FLOOR, 2.0, (at(1.75), at(2.0))));
        let (kind, range, _) = classified(0.4, -0.4, 2.0);
        assert_eq!((kind, range), (kind::DROP, 1.0), "a hole 0.4 m deep, from 1 m on at the latest");
        assert_eq!(classified(0.4, -0.24, 2.0).0, kind::NOTHING, "neither floor nor hole");
    }

    #[test]
    fn far_floor_that_rises_within_the_tilt_error_is_neither() {
        assert_eq!(classified(0.4, -0.4 / 5.0 + 0.0145, 5.0).0, kind::NOTHING);
    }

    #[test]
    fn rays_that_leave_the_band_clear_what_they_crossed() {
        assert_eq!(classified(0.4, 0.1, 4.0).0, kind::PASSING);
        assert_eq!(classified(0.4, 0.1, 4.0).2, (0, at(2.49)));
        assert_eq!(classified(0.4, 0.1, 1.0).0, kind::OBSTACLE);
        assert_eq!(classified(0.4, 0.0, 7.0).2, (0, 128), "beyond the greatest range");
        assert_eq!(classified(1.0, 0.1, 4.0).0, kind::NOTHING, "over the band");
        assert_eq!(classified(1.0, -0.1, 3.0).0, kind::NOTHING, "a table top higher than the robot");
        assert_eq!(classified(1.0, -0.1, 7.0).2, (at(3.5), 128), "into the band at 3.5 m");
    }

    #[test]
    fn no_depth_says_nothing() {
        for z in [0.0, f32::NAN, f32::INFINITY, -1.0, 0.2, 8.1] {
            assert_eq!(classified(0.4, -0.1, z).0, kind::NOTHING, "{z} m");
        }
    }

    proptest! {
        #[test]
        fn vectors_and_single_pixels_give_the_same_bits(
            pixels in prop::collection::vec((prop_oneof![0.2f32..9.0, Just(0.0), Just(f32::NAN)], -0.9f32..0.9, -0.9f32..0.9), 9..70),
            height in 0.1..2.0,
        ) {
            let z: Vec<f32> = pixels.iter().map(|p| p.0).collect();
            let near: Vec<f32> = z.iter().map(|z| z + 0.01).collect();
            let (u, v): (Vec<f32>, Vec<f32>) = pixels.iter().map(|p| (p.1, p.2)).unzip();
            let input = RowInput { depths: [&near, &z, &z], u: &u, v: &v };
            let (mut one, mut other) = (ClassifiedRow::default(), ClassifiedRow::default());
            one.resize(z.len());
            other.resize(z.len());
            one.classify::<true>(&model(height), &input);
            other.classify_scalar::<true>(&model(height), &input);
            let bits = |row: &ClassifiedRow| {
                let bits = |v: &[f32]| v.iter().map(|f| f.to_bits()).collect::<Vec<_>>();
                (row.marks.clone(), bits(&row.ranges), bits(&row.heights))
            };
            prop_assert_eq!(bits(&one), bits(&other));
            one.classify::<false>(&model(height), &input);
            other.classify_scalar::<false>(&model(height), &input);
            prop_assert_eq!(bits(&one), bits(&other));
        }
    }
}
