//! Texture around a corner: whether it fixes the corner's position.

use super::corner::Corner;
use trundle_core::{GrayImage, Hypotenuse};

/// Radius of the area in which a corner's texture is measured: 7 px. Source: ours.
const TEXTURE_RADIUS_PX: usize = 7;
/// Side of that area \[px\].
const TEXTURE_SIDE_PX: usize = 2 * TEXTURE_RADIUS_PX + 1;
/// Columns that are read: a power of two; the last is not counted.
const TEXTURE_STRIDE: usize = TEXTURE_SIDE_PX + 1;
/// Weight of each column that is read: 0 for the last, else 1.
const COUNT_WEIGHTS: [i16; TEXTURE_STRIDE] = {
    let mut counts = [1; TEXTURE_STRIDE];
    counts[TEXTURE_SIDE_PX] = 0;
    counts
};

/// Root mean square of the gradient around `corner` in its minimum direction, grey values per px: the smaller eigenvalue of the structure
/// tensor \[Shi94\]. It is zero for an edge of any strength.
///
/// `image` is smoothed, so its noise is small; the corner has enough distance from the border for a descriptor.
pub(crate) fn min_gradient(image: &GrayImage, corner: Corner) -> f32 {
    let [across, down, both] = tensor(image, corner).map(f64::from);
    let middle = (across + down) / 2.0;
    let min = (middle - ((across - down) / 2.0).hypotenuse(both)).max(0.0);
    // The differences are over two pixels.
    (min / (4 * TEXTURE_SIDE_PX * TEXTURE_SIDE_PX) as f64).sqrt() as f32
}

fn tensor(image: &GrayImage, corner: Corner) -> [i32; 3] {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { tensor_by_avx2(image, corner) };
    }
    tensor_plainly(image, corner)
}

/// The same as [`tensor_plainly`], more numbers per instruction.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn tensor_by_avx2(image: &GrayImage, corner: Corner) -> [i32; 3] {
    tensor_plainly(image, corner)
}

/// Sums over the square of the squared differences across, down, and of their product.
#[inline(always)]
fn tensor_plainly(image: &GrayImage, corner: Corner) -> [i32; 3] {
    let (left, top) = (usize::from(corner.x) - TEXTURE_RADIUS_PX, usize::from(corner.y) - TEXTURE_RADIUS_PX);
    let mut sums = [[0_i32; TEXTURE_STRIDE]; 3];
    let row = |y: usize| &image.row(y)[left - 1..][..TEXTURE_STRIDE + 2];
    for y in top..top + TEXTURE_SIDE_PX {
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        for x in 0..TEXTURE_STRIDE {
            let difference = |a: u8, b: u8| (i16::from(a) - i16::from(b)) * COUNT_WEIGHTS[x];
            let across = i32::from(difference(here[x + 2], here[x]));
            let down = i32::from(difference(below[x + 1], above[x + 1]));
            sums[0][x] += across * across;
            sums[1][x] += down * down;
            sums[2][x] += across * down;
        }
    }
    sums.map(|lanes| lanes.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MIDDLE: Corner = Corner { x: 16, y: 16, score: 20 };

    fn min(value: impl Fn(f64, f64) -> f64) -> f32 {
        let pixel = |x: usize, y: usize| value(x as f64 - 16.0, y as f64 - 16.0).round() as u8;
        min_gradient(&GrayImage::from_fn(33, 33, pixel), MIDDLE)
    }

    #[test]
    fn an_edge_has_no_texture_and_a_corner_has() {
        assert_eq!(min(|_, _| 90.0), 0.0);
        assert_eq!(min(|x, _| 128.0 + 8.0 * x), 0.0);
        assert!(min(|x, y| (128.0 + 20.0 * (0.6 * x + 0.8 * y)).clamp(50.0, 200.0)) < 0.5);
        assert!(min(|x, y| if x > 0.0 && y > 0.0 { 200.0 } else { 50.0 }) > 10.0);
        let bump = min(|x, y| 90.0 + 3.0 * x.abs() + 3.0 * y.abs());
        assert!((bump - 2.9).abs() < 0.1, "{bump}");
    }

    proptest! {
        #[test]
        fn processors_agree(pixels in prop::collection::vec(any::<u8>(), 33 * 33)) {
            let image = GrayImage::new(33, 33, pixels).unwrap();
            prop_assert_eq!(tensor(&image, MIDDLE), tensor_plainly(&image, MIDDLE));
        }
    }
}
