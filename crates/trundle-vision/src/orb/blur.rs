use std::num::Wrapping;
use trundle_core::GrayImage;

/// Weights of a Gaussian of standard deviation 2 px over 7 px, in 1/256: middle first. BRIEF compares single pixels, so
/// that it needs a smoothed image \[Calonder10, sec. 3.1\].
const KERNEL: [u16; 4] = [56, 49, 34, 17];
const RADIUS: usize = KERNEL.len() - 1;

/// Gaussian smoothing, rounded to whole grey values after each of the two passes; the border is continued.
#[derive(Debug, Clone, Default)]
pub(crate) struct Blur {
    /// A row smoothed downwards, with `RADIUS` px more at either end.
    row: Vec<u8>,
}

impl Blur {
    /// Smooths `from` into `to`, an image of the same size, at least 1 x 1.
    pub fn run(&mut self, from: &GrayImage, to: &mut GrayImage) {
        let (width, height) = (from.width(), from.height());
        self.row.resize(width + 2 * RADIUS, 0);
        for y in 0..height {
            let rows = std::array::from_fn(|k| from.row((y + k).saturating_sub(RADIUS).min(height - 1)));
            smooth(rows, &mut self.row[RADIUS..RADIUS + width]);
            let (first, last) = (self.row[RADIUS], self.row[RADIUS + width - 1]);
            self.row[..RADIUS].fill(first);
            self.row[RADIUS + width..].fill(last);
            smooth(std::array::from_fn(|k| &self.row[k..k + width]), to.row_mut(y));
        }
    }
}

/// The weighted mean of seven slices, element by element. No sum exceeds 16 bits: it says so (`Wrapping`) because a check
/// for each would keep the compiler from doing many at once.
fn smooth(from: [&[u8]; 2 * RADIUS + 1], to: &mut [u8]) {
    let [a, b, c, d, e, f, g] = from.map(|slice| &slice[..to.len()]);
    let weights = KERNEL.map(Wrapping);
    for i in 0..to.len() {
        let value = |slice: &[u8]| Wrapping(u16::from(slice[i]));
        let sum = value(d) * weights[0]
            + (value(c) + value(e)) * weights[1]
            + (value(b) + value(f)) * weights[2]
            + (value(a) + value(g)) * weights[3];
        to[i] = ((sum + Wrapping(128)).0 >> 8) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
