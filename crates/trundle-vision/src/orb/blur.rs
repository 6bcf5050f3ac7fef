//! Smooths an image by a Gaussian.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use super::vector::{self, BLOCK_PX, Bytes, block, block_mut, starts};
use trundle_core::GrayImage;

/// Weights of a Gaussian of standard deviation 2 px over 7 px, in 1/256: middle first. BRIEF compares single pixels and therefore needs a
/// smoothed image. Source: \[Calonder10, sec. 3.1\].
const KERNEL: [u32; 4] = [56, 49, 34, 17];
/// Reach of the Gaussian to each side \[px\].
const KERNEL_RADIUS_PX: usize = KERNEL.len() - 1;
/// Number of pixels whose seven slices are found together: finding them costs as much as smoothing 16 px. Source: ours.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
const SPAN_PX: usize = 64;

/// Gaussian smoothing, rounded to whole grey values after each of the two passes; the border is continued.
#[derive(Debug, Clone, Default)]
pub(crate) struct Blur {
    /// A row smoothed downwards, with `KERNEL_RADIUS_PX` px more at either end.
    row: Vec<u8>,
}

impl Blur {
    /// Smooths `from` into `to`, an image of the same size, at least 1 x 1.
    pub fn run(&mut self, from: &GrayImage, to: &mut GrayImage) {
        let (width, height) = (from.width(), from.height());
        self.row.resize(width + 2 * KERNEL_RADIUS_PX, 0);
        for y in 0..height {
            let rows =
                std::array::from_fn(|k| from.row((y + k).saturating_sub(KERNEL_RADIUS_PX).min(height - 1)));
            smooth(rows, &mut self.row[KERNEL_RADIUS_PX..KERNEL_RADIUS_PX + width]);
            let (first, last) = (self.row[KERNEL_RADIUS_PX], self.row[KERNEL_RADIUS_PX + width - 1]);
            self.row[..KERNEL_RADIUS_PX].fill(first);
            self.row[KERNEL_RADIUS_PX + width..].fill(last);
            smooth(std::array::from_fn(|k| &self.row[k..k + width]), to.row_mut(y));
        }
    }
}

/// The weighted mean of seven slices, element by element.
fn smooth(from: [&[u8]; 2 * KERNEL_RADIUS_PX + 1], to: &mut [u8]) {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    if to.len() >= SPAN_PX && vector::is_available() {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { smooth_by_blocks(from, to) };
    }
    smooth_plainly(from, to);
}

fn smooth_plainly([a, b, c, d, e, f, g]: [&[u8]; 2 * KERNEL_RADIUS_PX + 1], to: &mut [u8]) {
    for (i, out) in to.iter_mut().enumerate() {
        let value = |slice: &[u8]| u32::from(slice[i]);
        let sum = value(d) * KERNEL[0]
            + (value(c) + value(e)) * KERNEL[1]
            + (value(b) + value(f)) * KERNEL[2]
            + (value(a) + value(g)) * KERNEL[3];
        *out = ((sum + 128) >> 8) as u8;
    }
}

/// [`smooth_plainly`] of [`SPAN_PX`] pixels or more.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
#[cfg_attr(target_arch = "aarch64", target_feature(enable = "neon"))]
fn smooth_by_blocks(from: [&[u8]; 2 * KERNEL_RADIUS_PX + 1], to: &mut [u8]) {
    const WEIGHTS: [u8; KERNEL.len()] = [KERNEL[0] as u8, KERNEL[1] as u8, KERNEL[2] as u8, KERNEL[3] as u8];
    for x in starts(to.len(), SPAN_PX) {
        let mut windows = [&[0; SPAN_PX]; 2 * KERNEL_RADIUS_PX + 1];
        for (window, slice) in windows.iter_mut().zip(from) {
            *window = block(slice, x);
        }
        let out: &mut [u8; SPAN_PX] = block_mut(to, x);
        for part in (0..SPAN_PX).step_by(BLOCK_PX) {
            let pixels = windows.map(|window| Bytes::load(block(window, part)));
            Bytes::mean_of_seven(pixels, &WEIGHTS).store(block_mut(out, part));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_pixels_at_once_change_nothing(pixels in prop::collection::vec(any::<[u8; 7]>(), 1..200)) {
            let row = |k: usize| pixels.iter().map(|p| p[k]).collect::<Vec<u8>>();
            let rows: [Vec<u8>; 7] = std::array::from_fn(row);
            let (mut means, mut plainly) = (vec![0; pixels.len()], vec![0; pixels.len()]);
            smooth(rows.each_ref().map(Vec::as_slice), &mut means);
            smooth_plainly(rows.each_ref().map(Vec::as_slice), &mut plainly);
            prop_assert_eq!(means, plainly);
        }
    }

    fn blurred(image: &GrayImage) -> GrayImage {
        let mut out = image.clone();
        Blur::default().run(image, &mut out);
        out
    }

    #[test]
    fn the_kernel_is_the_gaussian_and_adds_up_to_one() {
        assert_eq!(KERNEL[0] + 2 * (KERNEL[1] + KERNEL[2] + KERNEL[3]), 256);
        let gauss = [0.0_f64, 1.0, 2.0, 3.0].map(|x| (-x * x / 8.0).exp());
        let sum = gauss[0] + 2.0 * gauss[1..].iter().sum::<f64>();
        for (weight, exact) in KERNEL.iter().zip(gauss) {
            assert!((f64::from(*weight) - 256.0 * exact / sum).abs() < 1.0);
        }
    }

    #[test]
    fn flat_stays_flat_and_a_point_becomes_a_bell() {
        for value in [0, 1, 200, 255] {
            assert_eq!(blurred(&GrayImage::filled(9, 5, value)), GrayImage::filled(9, 5, value));
        }
        let mut point = GrayImage::filled(15, 15, 0);
        point[(7, 7)] = 255;
        let bell = blurred(&point);
        assert_eq!(bell[(7, 7)], 12);
        assert_eq!((bell[(7, 4)], bell[(4, 7)], bell[(3, 7)]), (4, 4, 0));
    }

    #[test]
    fn a_single_pixel_is_not_too_small() {
        assert_eq!(blurred(&GrayImage::filled(1, 1, 77))[(0, 0)], 77);
    }
}
