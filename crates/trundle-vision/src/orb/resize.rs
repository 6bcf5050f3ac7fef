use std::num::Wrapping;
use trundle_core::GrayImage;

/// Bilinear shrinking in fixed point, pixel areas aligned: the corners of both images coincide.
#[derive(Debug, Clone, Default)]
pub(crate) struct Resize {
    sizes: [usize; 4],
    columns: Vec<Tap>,
    /// A row of the larger image, interpolated downwards, in 1/256; the last sample twice.
    row: Vec<u16>,
}

/// Between which two samples to interpolate.
#[derive(Debug, Clone, Copy)]
struct Tap {
    first: u32,
    /// Weight of the second in 1/256; 256 - this is that of the first.
    weight: u16,
}

impl Resize {
    /// Fills `to` with `from` at its size, which may be empty. `from` must have pixels if `to` has.
    pub fn run(&mut self, from: &GrayImage, to: &mut GrayImage) {
        let sizes = [from.width(), from.height(), to.width(), to.height()];
        if self.sizes != sizes {
            self.sizes = sizes;
            self.columns = (0..to.width()).map(|x| tap(x, from.width(), to.width())).collect();
            self.row = vec![0; from.width() + 1];
        }
        if to.data().is_empty() {
            return;
        }
        for y in 0..to.height() {
            let Tap { first, weight } = tap(y, from.height(), to.height());
            let lower = (first as usize + 1).min(from.height() - 1);
            mix_rows(from.row(first as usize), from.row(lower), weight, &mut self.row);
            self.row[from.width()] = self.row[from.width() - 1];
            shrink_row(&self.row, &self.columns, to.row_mut(y));
        }
    }
}

// No sum below exceeds its bits. It says so (`Wrapping`) because a check for each would cost more than the sum.

/// Interpolates between two rows, in 1/256.
fn mix_rows(upper: &[u8], lower: &[u8], weight: u16, row: &mut [u16]) {
    let (of_upper, of_lower) = (Wrapping(256 - weight), Wrapping(weight));
    for ((mixed, a), b) in row.iter_mut().zip(upper).zip(lower) {
        *mixed = (Wrapping(u16::from(*a)) * of_upper + Wrapping(u16::from(*b)) * of_lower).0;
    }
}

/// Interpolates within a row and leaves the 1/256.
fn shrink_row(row: &[u16], columns: &[Tap], to: &mut [u8]) {
    for (out, tap) in to.iter_mut().zip(columns) {
        let [a, b] = [0, 1].map(|k| Wrapping(u32::from(row[tap.first as usize..][..2][k])));
        let weight = Wrapping(u32::from(tap.weight));
        let mixed = a * (Wrapping(256) - weight) + b * weight;
        *out = ((mixed + Wrapping(1 << 15)).0 >> 16) as u8;
    }
}

/// Where sample `i` of `to` lies among those of `from`.
fn tap(i: usize, from: usize, to: usize) -> Tap {
    let position = ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, (from - 1) as f64);
    let in_256ths = (position * 256.0).round() as u64;
    Tap { first: (in_256ths / 256) as u32, weight: (in_256ths % 256) as u16 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resized(from: &GrayImage, width: usize, height: usize) -> GrayImage {
        let mut to = GrayImage::filled(width, height, 0);
        Resize::default().run(from, &mut to);
        to
    }

    #[test]
    fn a_ramp_stays_where_it_was() {
        let ramp = GrayImage::from_fn(120, 60, |x, y| (x + y) as u8);
        let small = resized(&ramp, 100, 50);
        for (x, y) in [(0, 0), (10, 3), (50, 25), (98, 48)] {
            let expected = (x as f64 + 0.5) * 1.2 - 0.5 + (y as f64 + 0.5) * 1.2 - 0.5;
            assert!((f64::from(small[(x, y)]) - expected).abs() <= 1.0, "({x}, {y})");
        }
    }

    #[test]
    fn the_same_size_is_the_same_image_and_white_stays_white() {
        let noise = GrayImage::from_fn(31, 17, |x, y| (x * 89 + y * 57) as u8);
        assert_eq!(resized(&noise, 31, 17), noise);
        assert_eq!(resized(&GrayImage::filled(7, 5, 255), 6, 4), GrayImage::filled(6, 4, 255));
        assert_eq!(resized(&noise, 0, 3).data(), &[]);
    }
}
