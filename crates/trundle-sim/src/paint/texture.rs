/// A painted rectangle with its mip levels: what the camera looks at.
///
/// Texels are `0x00BBGGRR`; (u, v) are metres from the left and from the top. Level 0 is the painting, each further level
/// halves both sides by averaging 2 x 2 texels (Williams 1983), so that a pixel sees the mean of what it covers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texture {
    levels: Vec<Level>,
    texels: Vec<u32>,
    /// Side of a texel of level 0, m: the smaller of both.
    texel: f32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Level {
    first: usize,
    width: i32,
    height: i32,
    /// Texels a metre.
    across: f32,
    down: f32,
}

impl Texture {
    /// A texture of `width` x `height` texels, row by row from the top left, over `size` metres.
    pub(crate) fn new(width: usize, height: usize, mut texels: Vec<u32>, size: (f32, f32)) -> Self {
        assert!(texels.len() == width * height && !texels.is_empty(), "invariant: a texel for every place");
        let texel = (size.0 / width as f32).min(size.1 / height as f32);
        let mut levels = Vec::new();
        let (mut w, mut h, mut first) = (width, height, 0);
        loop {
            let (across, down) = (w as f32 / size.0, h as f32 / size.1);
            levels.push(Level { first, width: w as i32, height: h as i32, across, down });
            if w % 2 != 0 || h % 2 != 0 {
                break;
            }
            halve(&mut texels, first, (w, h));
            first += w * h;
            (w, h) = (w / 2, h / 2);
        }
        Self { levels, texels, texel }
    }

    /// The colour at (u, v) m, averaged over about `footprint` m.
    pub(crate) fn sample(&self, u: f32, v: f32, footprint: f32) -> u32 {
        let level = fast_log2(footprint / self.texel).max(0.0);
        let last = self.levels.len() - 1;
        let lower = (level as usize).min(last);
        let sharp = self.bilinear(&self.levels[lower], u, v);
        let part = ((level - lower as f32) * 256.0) as u32;
        if part == 0 || lower == last {
            return sharp;
        }
        blend(sharp, self.bilinear(&self.levels[lower + 1], u, v), part)
    }

    fn bilinear(&self, level: &Level, u: f32, v: f32) -> u32 {
        let x = ((u * level.across - 0.5) * 256.0) as i32;
        let y = ((v * level.down - 0.5) * 256.0) as i32;
        let (x, y) = (x.clamp(0, (level.width - 1) << 8), y.clamp(0, (level.height - 1) << 8));
        let (x0, y0) = (x >> 8, y >> 8);
        let (x1, y1) = ((x0 + 1).min(level.width - 1), (y0 + 1).min(level.height - 1));
        let at = |x: i32, y: i32| self.texels[level.first + (y * level.width + x) as usize];
        let (fx, fy) = ((x & 255) as u32, (y & 255) as u32);
        blend(blend(at(x0, y0), at(x1, y0), fx), blend(at(x0, y1), at(x1, y1), fx), fy)
    }
}

/// Appends the level of half the size of the one that starts at `first`.
fn halve(texels: &mut Vec<u32>, first: usize, (width, height): (usize, usize)) {
    texels.reserve(width * height / 4);
    for y in 0..height / 2 {
        for x in 0..width / 2 {
            let at = first + 2 * y * width + 2 * x;
            let four = [texels[at], texels[at + 1], texels[at + width], texels[at + width + 1]];
            let mean = |shift: u32| (four.iter().map(|t| t >> shift & 0xFF).sum::<u32>() + 2) / 4 << shift;
            texels.push(mean(0) | mean(8) | mean(16));
        }
    }
}

/// Between two colours, `part` of 256 of the second, all three channels at once, rounded.
fn blend(a: u32, b: u32, part: u32) -> u32 {
    let keep = 256 - part;
    let red_blue = ((a & 0xFF00FF) * keep + (b & 0xFF00FF) * part + 0x80_0080) >> 8 & 0xFF00FF;
    let green = ((a & 0xFF00) * keep + (b & 0xFF00) * part + 0x8000) >> 8 & 0xFF00;
    red_blue | green
}

/// log2 by the exponent and a straight line over the mantissa: at most 0.09 low. Smooth, which is what matters here.
fn fast_log2(x: f32) -> f32 {
    x.to_bits() as f32 / (1 << 23) as f32 - 127.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_look_sees_the_mean_and_a_narrow_one_the_texel() {
        let checker = (0..64 * 32).map(|i| if (i / 64 + i) % 2 == 0 { 0xFF_FFFF } else { 0 }).collect();
        let texture = Texture::new(64, 32, checker, (0.64, 0.32));
        assert_eq!(texture.sample(0.105, 0.105, 0.005), 0xFF_FFFF);
        assert_eq!(texture.sample(0.115, 0.105, 0.005), 0);
        assert_eq!(texture.sample(0.3, 0.2, 0.05), 0x80_8080);
        assert_eq!(texture.sample(-5.0, 50.0, 1e9), 0x80_8080);
    }

    #[test]
    fn blending_is_linear_in_each_channel() {
        assert_eq!(blend(0x00_00FF, 0xFF_0000, 64), 0x40_00BF);
        assert_eq!(blend(0xFF_FFFF, 0xFF_FFFF, 100), 0xFF_FFFF);
        for x in [0.3_f32, 1.0, 5.0, 1000.0] {
            assert!((fast_log2(x) - x.log2()).abs() < 0.09);
        }
    }
}
