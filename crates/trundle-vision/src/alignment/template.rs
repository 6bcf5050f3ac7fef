//! Finds a template in a patch, to a fraction of a pixel.

use super::patch::{ImagePatch, PATCH_RADIUS_PX};
use nalgebra::{Matrix2, Vector2};
use trundle_core::Hypotenuse;

/// Number of pixels from the middle of a template to its border: 5. Source: ours.
const TEMPLATE_RADIUS_PX: usize = 5;
/// Side of a template, px.
const TEMPLATE_SIDE_PX: usize = 2 * TEMPLATE_RADIUS_PX + 1;
/// Pixels of a template, padded with zeros to whole registers.
const PADDED_LENGTH: usize = (TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX).next_multiple_of(LANES);
/// Number of parallel sums on every processor: 8. Sums of floats depend on their order. Source: ours.
const LANES: usize = 8;
/// Side of a template with a border of one pixel for the gradients, px.
const WARPED_SIDE_PX: usize = TEMPLATE_SIDE_PX + 2;
/// Maximum number of steps of an alignment: 10. After this number the alignment ends with its present state. Source: ours.
const MAX_STEPS: usize = 10;
/// Step that ends an alignment: 0.02 px. Source: ours.
const CONVERGED_STEP_PX: f32 = 0.02;
/// Largest fraction of the contrast in view that the template may leave unexplained: 0.3. Above it the alignment fails. Source: ours.
const MAX_RESIDUAL_RATIO: f32 = 0.3;
/// Largest ratio of the contrasts of image and template, or its inverse: 2. Above it the alignment fails. Source: ours.
const MAX_CONTRAST_RATIO: f32 = 2.0;
/// Parameters that are fitted: position (two), brightness, contrast. Source: ours.
const FITTED_PARAMETERS: usize = 4;

type Pixels = [f32; PADDED_LENGTH];

/// A patch warped to the view of another image.
#[derive(Debug, Clone)]
pub struct Template {
    /// Grey values minus their mean.
    values: Pixels,
    /// Gradients without the effect of a change of brightness or contrast.
    right: Pixels,
    down: Pixels,
    /// Sum of the squared values.
    contrast: f32,
    /// Inverse of the sums of the gradients' products.
    inverse: Matrix2<f32>,
}

/// Position at which a template was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchAlignment {
    /// Position, px of the patch's level right and down of the patch's own feature.
    pub offset: Vector2<f32>,
    /// Standard deviation of the position in its least certain direction, from the remaining differences, px of the level.
    pub sigma: f32,
}

impl Template {
    /// The template of `patch` for a view; `there_from_here` maps an offset in that view to one in the patch, px. `None` if the patch is
    /// too small, or similar to itself at a small offset.
    pub fn new(patch: &ImagePatch, there_from_here: Matrix2<f32>) -> Option<Self> {
        let warped = warp(patch, there_from_here.try_inverse()?)?;
        let mut template = Self::gradients(&warped);
        let mean = sum(&template.values) / (TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX) as f32;
        template.values[..TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX].iter_mut().for_each(|v| *v -= mean);
        template.contrast = dot(&template.values, &template.values);
        for gradient in [&mut template.right, &mut template.down] {
            let (mean, share) = (
                sum(gradient) / (TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX) as f32,
                dot(gradient, &template.values) / template.contrast,
            );
            for (g, v) in gradient.iter_mut().zip(&template.values).take(TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX)
            {
                *g -= mean + share * v;
            }
        }
        let (right, down) = (&template.right, &template.down);
        let across = dot(right, down);
        template.inverse = Matrix2::new(dot(right, right), across, across, dot(down, down)).try_inverse()?;
        (template.contrast > 0.0 && template.inverse.iter().all(|v| v.is_finite())).then_some(template)
    }

    /// Original values, and their gradients.
    fn gradients(warped: &[[f32; WARPED_SIDE_PX]; WARPED_SIDE_PX]) -> Self {
        let mut template = Self {
            values: [0.0; PADDED_LENGTH],
            right: [0.0; PADDED_LENGTH],
            down: [0.0; PADDED_LENGTH],
            contrast: 0.0,
            inverse: Matrix2::zeros(),
        };
        for (i, (y, x)) in
            (1..=TEMPLATE_SIDE_PX).flat_map(|y| (1..=TEMPLATE_SIDE_PX).map(move |x| (y, x))).enumerate()
        {
            template.values[i] = warped[y][x];
            template.right[i] = (warped[y][x + 1] - warped[y][x - 1]) / 2.0;
            template.down[i] = (warped[y + 1][x] - warped[y - 1][x]) / 2.0;
        }
        template
    }

    /// Position in `patch`, searched from `start`, px of the patch's level right and down of the patch's own feature; `None` without a
    /// similar position.
    pub fn find(&self, patch: &ImagePatch, start: Vector2<f32>) -> Option<PatchAlignment> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.find_by_avx2(patch, start) };
        }
        self.find_plainly(patch, start)
    }

    /// The same as [`Template::find_plainly`], more numbers per instruction.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn find_by_avx2(&self, patch: &ImagePatch, start: Vector2<f32>) -> Option<PatchAlignment> {
        self.find_plainly(patch, start)
    }

    #[inline(always)]
    fn find_plainly(&self, patch: &ImagePatch, start: Vector2<f32>) -> Option<PatchAlignment> {
        let feature = Vector2::from(patch.feature());
        let mut at = feature + start;
        let mut seen = [0.0; PADDED_LENGTH];
        for _ in 0..MAX_STEPS {
            sample(patch, at, &mut seen)?;
            let gain = dot(&self.values, &seen) / self.contrast;
            let step = self.inverse * Vector2::new(dot(&self.right, &seen), dot(&self.down, &seen))
                / gain.clamp(1.0 / MAX_CONTRAST_RATIO, MAX_CONTRAST_RATIO);
            at -= step;
            if step.norm() <= CONVERGED_STEP_PX {
                return self.judged(&seen, gain, at - feature);
            }
        }
        None
    }

    /// The position, unless the pixels `seen` at it differ too much.
    #[inline(always)]
    fn judged(&self, seen: &Pixels, gain: f32, offset: Vector2<f32>) -> Option<PatchAlignment> {
        let count = (TEMPLATE_SIDE_PX * TEMPLATE_SIDE_PX) as f32;
        let mean = sum(seen) / count;
        let contrast = dot(seen, seen) - count * mean * mean;
        let unlike = (contrast - gain * gain * self.contrast).max(0.0);
        let variance = unlike / (count - FITTED_PARAMETERS as f32) / (gain * gain);
        let half = (self.inverse.m11 + self.inverse.m22) / 2.0;
        let widest = half + ((self.inverse.m11 - self.inverse.m22) / 2.0).hypotenuse(self.inverse.m12);
        let sigma = (variance * widest).sqrt();
        let is_like = unlike <= MAX_RESIDUAL_RATIO * contrast
            && (1.0 / MAX_CONTRAST_RATIO..=MAX_CONTRAST_RATIO).contains(&gain);
        is_like.then_some(PatchAlignment { offset, sigma })
    }
}

/// The patch around its feature, warped by `here_from_there`; `None` if the patch is too small.
fn warp(
    patch: &ImagePatch,
    here_from_there: Matrix2<f32>,
) -> Option<[[f32; WARPED_SIDE_PX]; WARPED_SIDE_PX]> {
    let [x, y] = patch.feature();
    let middle = Vector2::new(x, y).add_scalar(PATCH_RADIUS_PX as f32);
    let mut warped = [[0.0; WARPED_SIDE_PX]; WARPED_SIDE_PX];
    for (row, values) in warped.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            let offset =
                Vector2::new(column as f32, row as f32).add_scalar(-(TEMPLATE_RADIUS_PX as f32 + 1.0));
            let at = middle + here_from_there * offset;
            *value = patch.at(at.x, at.y)?;
        }
    }
    Some(warped)
}

/// Pixels of `patch` in the square around `at`, px from its middle; `None` if the patch is too small.
#[inline(always)]
fn sample(patch: &ImagePatch, at: Vector2<f32>, seen: &mut Pixels) -> Option<()> {
    let corner = at.add_scalar((PATCH_RADIUS_PX - TEMPLATE_RADIUS_PX) as f32);
    let max = 2.0 * (PATCH_RADIUS_PX - TEMPLATE_RADIUS_PX) as f32;
    if !(corner.x >= 0.0 && corner.y >= 0.0 && corner.x < max && corner.y < max) {
        return None;
    }
    let (left, top) = (corner.x as usize, corner.y as usize);
    let (right, down) = (corner.x - left as f32, corner.y - top as f32);
    let weights = [(1.0 - right) * (1.0 - down), right * (1.0 - down), (1.0 - right) * down, right * down];
    patch.blend::<TEMPLATE_SIDE_PX>((left, top), weights, seen);
    Some(())
}

/// The sum of the products, in an order that does not depend on the processor.
#[inline(always)]
fn dot(a: &Pixels, b: &Pixels) -> f32 {
    let mut lanes = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    total(lanes)
}

/// The sum, in the same order.
#[inline(always)]
fn sum(a: &Pixels) -> f32 {
    let mut lanes = [0.0; LANES];
    for a in a.as_chunks::<LANES>().0 {
        for lane in 0..LANES {
            lanes[lane] += a[lane];
        }
    }
    total(lanes)
}

#[inline(always)]
fn total([a, b, c, d, e, f, g, h]: [f32; LANES]) -> f32 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A smooth surface with texture everywhere, at (x, y) px.
    fn surface(x: f32, y: f32) -> f32 {
        120.0 + 50.0 * (0.5 * x + 0.2 * y).sin() + 40.0 * (0.15 * x - 0.6 * y + 1.0).sin()
    }

    /// A patch of this surface with the feature at an offset from the middle, px, and the surface moved.
    fn patch(feature: [f32; 2], value: impl Fn(f32, f32) -> f32) -> ImagePatch {
        let side = 2 * PATCH_RADIUS_PX + 1;
        let pixels = std::array::from_fn(|i| {
            let (x, y) =
                ((i % side) as f32 - PATCH_RADIUS_PX as f32, (i / side) as f32 - PATCH_RADIUS_PX as f32);
            value(x, y).round() as u8
        });
        ImagePatch::new(pixels, feature).unwrap()
    }

    fn unmoved() -> ImagePatch {
        patch([0.0, 0.0], surface)
    }

    proptest! {
        #[test]
        fn a_template_is_found_where_it_is(dx in -2.0_f32..2.0, dy in -2.0_f32..2.0, gain in 0.8_f32..1.3) {
            let template = Template::new(&unmoved(), Matrix2::identity()).unwrap();
            let moved = patch([0.25, -0.5], |x, y| gain * surface(x - dx, y - dy) * 0.7 + 10.0);
            let found = template.find(&moved, Vector2::new(0.5, -0.5)).unwrap();
            prop_assert!((found.offset - Vector2::new(dx - 0.25, dy + 0.5)).norm() < 0.05, "{found:?}");
            prop_assert!(found.sigma < 0.05);
        }

        #[test]
        fn processors_agree(dx in -2.0_f32..2.0, dy in -2.0_f32..2.0, noise in prop::collection::vec(0_u8..9, ImagePatch::BYTES)) {
            let template = Template::new(&unmoved(), Matrix2::identity()).unwrap();
            let clean = patch([0.0, 0.0], |x, y| surface(x - dx, y - dy) * 0.8);
            let pixels = std::array::from_fn(|i| clean.pixels()[i] + noise[i]);
            let noisy = ImagePatch::new(pixels, [0.0, 0.0]).unwrap();
            prop_assert_eq!(template.find(&noisy, Vector2::zeros()), template.find_plainly(&noisy, Vector2::zeros()));
        }
    }

    #[test]
    fn a_warped_template_fits_a_view_from_nearer_and_aside() {
        let there_from_here = Matrix2::new(1.15, 0.1, -0.05, 0.9);
        let template = Template::new(&unmoved(), there_from_here).unwrap();
        let here = there_from_here.try_inverse().unwrap();
        let seen = patch([0.0, 0.0], |x, y| {
            let at = here * Vector2::new(x - 0.7, y + 0.4);
            surface(at.x, at.y)
        });
        let found = template.find(&seen, Vector2::zeros()).unwrap();
        assert!((found.offset - Vector2::new(0.7, -0.4)).norm() < 0.05, "{found:?}");
        assert!(Template::new(&unmoved(), Matrix2::identity() * 0.4).is_none(), "the patch is too small");
        assert!(Template::new(&unmoved(), Matrix2::zeros()).is_none());
    }

    #[test]
    fn a_different_or_plain_patch_is_not_aligned() {
        let template = Template::new(&unmoved(), Matrix2::identity()).unwrap();
        let other = patch([0.0, 0.0], |x, y| 120.0 + 60.0 * (0.9 * x).sin() * (0.8 * y + 0.3).cos());
        assert_eq!(template.find(&other, Vector2::zeros()), None);
        let flat = patch([0.0, 0.0], |_, _| 90.0);
        assert_eq!(template.find(&flat, Vector2::zeros()), None);
        assert!(Template::new(&flat, Matrix2::identity()).is_none());
        let edge = patch([0.0, 0.0], |x, _| if x > 0.0 { 200.0 } else { 50.0 });
        assert!(Template::new(&edge, Matrix2::identity()).is_none(), "it slides along itself");
    }
}
