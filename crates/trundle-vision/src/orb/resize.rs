//! Shrinks an image.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use super::vector::{self, block};
#[cfg(target_arch = "x86_64")]
use super::vector::{block_mut, starts};
use trundle_core::GrayImage;

/// Bilinear shrinking in fixed point, pixel areas aligned: the corners of both images coincide.
#[derive(Debug, Clone, Default)]
pub(crate) struct Resize {
    sizes: [usize; 4],
    columns: Vec<Tap>,
    /// The same columns, in groups of four; empty if a group needs more samples than a register has.
    quads: Vec<Quad>,
    /// A row of the larger image, interpolated downwards, in 1/128, with [`SAMPLES_PER_REGISTER`] more after its end.
    row: Vec<i16>,
}

/// The two samples between which a pixel is interpolated.
#[derive(Debug, Clone, Copy)]
struct Tap {
    first: u32,
    /// Weight of the second sample in 1/256; that of the first is 256 minus this.
    weight: u16,
}

/// Samples of 16 bits in 16 bytes: a register of NEON, half of one of AVX2. Source: ours.
const SAMPLES_PER_REGISTER: usize = 8;

/// Four neighbouring columns: from [`SAMPLES_PER_REGISTER`] samples on from `first`, which bytes make the pairs of samples between which each
/// is interpolated, and their weights.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    expect(dead_code, reason = "only vectors take four at a time")
)]
struct Quad {
    first: u32,
    bytes: [u8; 16],
    weights: [u8; 16],
}

impl Resize {
    /// Resizes `from` to the size of `to`, which may be empty. `from` must have pixels if `to` has.
    pub fn run(&mut self, from: &GrayImage, to: &mut GrayImage) {
        self.fit([from.width(), from.height(), to.width(), to.height()]);
        if to.data().is_empty() {
            return;
        }
        for y in 0..to.height() {
            let Tap { first, weight } = tap(y, from.height(), to.height());
            let lower = (first as usize + 1).min(from.height() - 1);
            mix_rows(from.row(first as usize), from.row(lower), weight, &mut self.row[..from.width()]);
            self.row[from.width()] = self.row[from.width() - 1];
            shrink_row(&self.row, &self.columns, &self.quads, to.row_mut(y));
        }
    }

    /// Prepares the tables for images of these sizes.
    fn fit(&mut self, sizes: [usize; 4]) {
        if self.sizes == sizes {
            return;
        }
        self.sizes = sizes;
        let [width, _, to_width, _] = sizes;
        self.columns = (0..to_width).map(|x| tap(x, width, to_width)).collect();
        self.row = vec![0; width + SAMPLES_PER_REGISTER];
        let quads: Option<Vec<Quad>> = self.columns.as_chunks().0.iter().map(quad).collect();
        self.quads = quads.unwrap_or_default();
    }
}

/// Position of sample `i` of `to` among those of `from`.
fn tap(i: usize, from: usize, to: usize) -> Tap {
    let position = ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, (from - 1) as f64);
    let in_256ths = (position * 256.0).round() as u64;
    Tap { first: (in_256ths / 256) as u32, weight: (in_256ths % 256) as u16 }
}

/// `None` if the columns span too many samples.
fn quad(columns: &[Tap; 4]) -> Option<Quad> {
    let first = columns[0].first;
    (columns[3].first + 2 - first <= SAMPLES_PER_REGISTER as u32).then_some(())?;
    let (mut bytes, mut weights) = ([0; 16], [0; 16]);
    for (tap, (bytes, weights)) in
        columns.iter().zip(bytes.as_chunks_mut::<4>().0.iter_mut().zip(weights.as_chunks_mut::<4>().0))
    {
        let byte = 2 * (tap.first - first) as u8;
        *bytes = [byte, byte + 1, byte + 2, byte + 3];
        weights[..2].copy_from_slice(&(256 - tap.weight).to_le_bytes());
        weights[2..].copy_from_slice(&tap.weight.to_le_bytes());
    }
    Some(Quad { first, bytes, weights })
}

/// Interpolates between two rows, in 1/128.
fn mix_rows(upper: &[u8], lower: &[u8], weight: u16, row: &mut [i16]) {
    #[cfg(target_arch = "x86_64")]
    if row.len() >= 16 && vector::is_available() {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { mix_rows_by_blocks(upper, lower, weight, row) };
    }
    mix_rows_plainly(upper, lower, weight, row);
}

fn mix_rows_plainly(upper: &[u8], lower: &[u8], weight: u16, row: &mut [i16]) {
    let weight = u32::from(weight);
    for ((mixed, a), b) in row.iter_mut().zip(upper).zip(lower) {
        *mixed = ((u32::from(*a) * (256 - weight) + u32::from(*b) * weight) >> 1) as i16;
    }
}

/// [`mix_rows_plainly`] of 16 pixels or more. Compilers for aarch64 make code as good of [`mix_rows_plainly`].
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn mix_rows_by_blocks(upper: &[u8], lower: &[u8], weight: u16, row: &mut [i16]) {
    for x in starts(row.len(), 16) {
        vector::mix_16(block(upper, x), block(lower, x), weight, block_mut(row, x));
    }
}

/// Interpolates within a row and leaves the fractions.
fn shrink_row(row: &[i16], columns: &[Tap], quads: &[Quad], to: &mut [u8]) {
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    let _ = quads;
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    if vector::is_available() {
        // SAFETY: the processor has the only feature that the function is compiled for.
        unsafe { shrink_quads(row, quads, to) };
        let done = quads.len() / 2 * 8;
        return shrink_row_plainly(row, &columns[done..], &mut to[done..]);
    }
    shrink_row_plainly(row, columns, to);
}

fn shrink_row_plainly(row: &[i16], columns: &[Tap], to: &mut [u8]) {
    for (out, tap) in to.iter_mut().zip(columns) {
        let [a, b] = [0, 1].map(|k| u32::from(row[tap.first as usize + k] as u16));
        let weight = u32::from(tap.weight);
        *out = ((a * (256 - weight) + b * weight + (1 << 14)) >> 15) as u8;
    }
}

/// [`shrink_row_plainly`] for the first columns, two quads per step.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
#[cfg_attr(target_arch = "aarch64", target_feature(enable = "neon"))]
fn shrink_quads(row: &[i16], quads: &[Quad], to: &mut [u8]) {
    for ([p, q], out) in quads.as_chunks().0.iter().zip(to.as_chunks_mut().0) {
        let samples = [p, q].map(|quad| block(row, quad.first as usize));
        *out = vector::shrink_8(samples, [&p.bytes, &q.bytes], [&p.weights, &q.weights]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
        assert_eq!(resized(&GrayImage::filled(47, 5, 255), 39, 4), GrayImage::filled(39, 4, 255));
        assert_eq!(resized(&noise, 0, 3).data(), &[]);
    }

    proptest! {
        #[test]
        fn many_pixels_at_once_change_nothing(
            rows in prop::collection::vec(any::<[u8; 2]>(), 1..150), shrink in 1.0..4.0_f64, weight in 0..256u16,
        ) {
            let (upper, lower): (Vec<u8>, Vec<u8>) = rows.iter().map(|[a, b]| (*a, *b)).unzip();
            let mut resize = Resize::default();
            resize.fit([rows.len(), 1, (rows.len() as f64 / shrink) as usize, 1]);
            let (mut mixed, mut plainly) = (resize.row.clone(), resize.row.clone());
            mix_rows(&upper, &lower, weight, &mut mixed[..rows.len()]);
            mix_rows_plainly(&upper, &lower, weight, &mut plainly[..rows.len()]);
            prop_assert_eq!(&mixed, &plainly);
            mixed[rows.len()] = mixed[rows.len() - 1];
            let (mut out, mut out_plainly) = (vec![0; resize.columns.len()], vec![0; resize.columns.len()]);
            shrink_row(&mixed, &resize.columns, &resize.quads, &mut out);
            shrink_row_plainly(&mixed, &resize.columns, &mut out_plainly);
            prop_assert_eq!(out, out_plainly);
        }
    }
}
