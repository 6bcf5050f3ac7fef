//! Mip levels: a texture at half its size.

use super::light::spread;

/// Half the number of texels in each direction (rounded down, at least one), each the mean of its area: of 2 x 2 texels for even numbers.
pub(super) fn halved(texels: &[u32], (width, height): (usize, usize)) -> (Vec<u32>, usize, usize) {
    let (w, h) = ((width / 2).max(1), (height / 2).max(1));
    if width % 2 == 0 && height % 2 == 0 {
        return (means_of_four(texels, width, (w, h)), w, h);
    }
    let (columns, rows) = (shares(width, w), shares(height, h));
    let mean_at = |(row, down): &(usize, [f32; 3]), (column, across): &(usize, [f32; 3])| {
        let mut sum = [0.0_f32; 3];
        for (dy, part_down) in down.iter().enumerate().filter(|(_, part)| **part > 0.0) {
            for (dx, part) in across.iter().enumerate().filter(|(_, part)| **part > 0.0) {
                let texel = texels[(row + dy) * width + column + dx];
                for (channel, sum) in sum.iter_mut().enumerate() {
                    *sum += part_down * part * (texel >> (8 * channel) & 0xFF) as f32;
                }
            }
        }
        sum.iter().enumerate().map(|(channel, sum)| ((sum + 0.5) as u32) << (8 * channel)).sum()
    };
    let texels = rows.iter().flat_map(|row| columns.iter().map(move |column| (row, column)));
    (texels.map(|(row, column)| mean_at(row, column)).collect(), w, h)
}

fn means_of_four(texels: &[u32], width: usize, (w, h): (usize, usize)) -> Vec<u32> {
    let mean_at = |x: usize, y: usize| {
        let at = 2 * y * width + 2 * x;
        let sum = [at, at + 1, at + width, at + width + 1].iter().map(|&i| spread(texels[i])).sum::<u64>();
        let mean = (sum + 0x02_0002_0002) >> 2 & 0xFF_00FF_00FF;
        (mean & 0xFF_00FF) as u32 | (mean >> 24 & 0xFF00) as u32
    };
    (0..h).flat_map(|y| (0..w).map(move |x| mean_at(x, y))).collect()
}

/// Shares of `from` texels of a line in each of `to` texels: the first index, and three shares.
///
/// A texel has a width of from / to, less than 3, and starts at a multiple of that width; with three shares it starts at a texel.
fn shares(from: usize, to: usize) -> Vec<(usize, [f32; 3])> {
    let share = |i: usize| {
        // In units of 1 / to texels all numbers are whole.
        let (low, high) = (i * from, (i + 1) * from);
        let covered = |k: usize| high.min((k + 1) * to).saturating_sub(low.max(k * to)) as f32 / from as f32;
        let first = low / to;
        (first, [covered(first), covered(first + 1), covered(first + 2)])
    };
    (0..to).map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_texels_make_two_and_one_stays_one() {
        assert_eq!(shares(5, 2), [(0, [0.4, 0.4, 0.2]), (2, [0.2, 0.4, 0.4])]);
        let (texels, w, h) = halved(&[10, 20, 30, 40, 50], (5, 1));
        assert_eq!((texels, w, h), (vec![18, 42], 2, 1));
        let (texels, w, h) = halved(&[0x10_0008, 0x30_0000, 0x20_FF04], (1, 3));
        assert_eq!((texels, w, h), (vec![0x20_5504], 1, 1));
    }

    #[test]
    fn the_mean_is_kept() {
        let texels: Vec<u32> = (0..63 * 37).map(|i| (i * 7919 % 256) as u32).collect();
        let mean = |texels: &[u32]| texels.iter().sum::<u32>() as f64 / texels.len() as f64;
        let (half, w, h) = halved(&texels, (63, 37));
        assert_eq!((w, h, half.len()), (31, 18, 31 * 18));
        assert!((mean(&half) - mean(&texels)).abs() < 0.2);
    }
}
