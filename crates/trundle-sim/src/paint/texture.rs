/// A painted rectangle with its mip levels: what the camera looks at.
///
/// Texels are `0x00BBGGRR`; (u, v) are metres from the left and from the top. Level 0 is the painting, each further level
/// halves both sides by averaging 2 x 2 texels (Williams 1983), so that a pixel sees the mean of what it covers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texture {
    levels: Vec<Level>,
    texels: Vec<u32>,
    /// Of level 0, the more of both directions.
    texels_per_metre: f32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Level {
    /// Place of the first texel. Every row has one more at its end, a copy of its last, and so has the whole: a texel
    /// always has neighbours to the right and below.
    first: usize,
    stride: usize,
    /// Highest coordinates, in sixteenths of a texel.
    most: (i32, i32),
    /// Sixteenths of a texel a metre.
    across: f32,
    down: f32,
}

impl Texture {
    /// A texture of `width` x `height` texels, row by row from the top left, over `size` metres.
    pub(crate) fn new(width: usize, height: usize, texels: Vec<u32>, size: (f32, f32)) -> Self {
        assert!(texels.len() == width * height && !texels.is_empty(), "invariant: a texel for every place");
        let texels_per_metre = (width as f32 / size.0).max(height as f32 / size.1);
        let mut texture = Self { levels: Vec::new(), texels: Vec::new(), texels_per_metre };
        let (mut plain, mut w, mut h) = (texels, width, height);
        loop {
            texture.push_level(&plain, (w, h), size);
            if w % 2 != 0 || h % 2 != 0 {
                return texture;
            }
            plain = halved(&plain, (w, h));
            (w, h) = (w / 2, h / 2);
        }
    }

    fn push_level(&mut self, plain: &[u32], (width, height): (usize, usize), size: (f32, f32)) {
        self.levels.push(Level {
            first: self.texels.len(),
            stride: width + 1,
            most: ((width as i32 - 1) << 4, (height as i32 - 1) << 4),
            across: 16.0 * width as f32 / size.0,
            down: 16.0 * height as f32 / size.1,
        });
        self.texels.reserve((width + 1) * (height + 1));
        let last = &plain[(height - 1) * width..];
        for row in plain.chunks_exact(width).chain([last]) {
            self.texels.extend_from_slice(row);
            self.texels.push(row[width - 1]);
        }
    }

    /// The colour at (u, v) m, averaged over about `footprint` m.
    ///
    /// Between two levels one goes over into the other in the middle half of the way: continuous as the usual blend
    /// over the whole way is, at three quarters of its price.
    pub(crate) fn sample(&self, u: f32, v: f32, footprint: f32) -> Light {
        let level = fast_log2(footprint * self.texels_per_metre).max(0.0);
        let lower = (level as i32 as usize).min(self.levels.len() - 1);
        let part = ((level - lower as f32) * 512.0) as i32 - 128;
        let upper = (lower + 1).min(self.levels.len() - 1);
        if part <= 0 {
            self.bilinear(&self.levels[lower], u, v)
        } else if part >= 256 {
            self.bilinear(&self.levels[upper], u, v)
        } else {
            let sharp = self.bilinear(&self.levels[lower], u, v);
            sharp.blend(self.bilinear(&self.levels[upper], u, v), part as u32)
        }
    }

    /// Between the four texels around a point, in sixteenths of a texel.
    fn bilinear(&self, level: &Level, u: f32, v: f32) -> Light {
        let x = ((u * level.across - 8.0) as i32).max(0).min(level.most.0);
        let y = ((v * level.down - 8.0) as i32).max(0).min(level.most.1);
        let at = level.first + (y >> 4) as usize * level.stride + (x >> 4) as usize;
        let (fx, fy) = ((x & 15) as u64, (y & 15) as u64);
        let both = fx * fy;
        let (upper, lower) =
            (&self.texels[at..at + 2], &self.texels[at + level.stride..at + level.stride + 2]);
        let upper = spread(upper[0]) * (256 + both - 16 * (fx + fy)) + spread(upper[1]) * (16 * fx - both);
        let lower = spread(lower[0]) * (16 * fy - both) + spread(lower[1]) * both;
        Light(upper + lower)
    }
}

/// A colour as three 8.8 fixed-point numbers in one word: red at bit 0, blue at 16, green at 32. Arithmetic works on all
/// three at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Light(u64);

impl Light {
    /// Between two colours, `part` of 256 of the second.
    pub(crate) fn blend(self, other: Self, part: u32) -> Self {
        let part = u64::from(part);
        Self(self.rounded() * (256 - part) + other.rounded() * part)
    }

    /// Red, green, blue under `strength` of 256 of the light.
    pub(crate) fn dimmed(self, strength: u32) -> [u8; 3] {
        let dimmed = self.rounded() * u64::from(strength) + 0x80_0080_0080;
        [(dimmed >> 8) as u8, (dimmed >> 40) as u8, (dimmed >> 24) as u8]
    }

    /// Whole numbers in the three lanes.
    fn rounded(self) -> u64 {
        (self.0 + 0x80_0080_0080) >> 8 & 0xFF_00FF_00FF
    }
}

/// The bytes of a texel in the lanes of [`Light`].
fn spread(texel: u32) -> u64 {
    let texel = u64::from(texel);
    texel & 0xFF_00FF | (texel & 0xFF00) << 24
}

/// Means of 2 x 2 texels.
fn halved(texels: &[u32], (width, height): (usize, usize)) -> Vec<u32> {
    let mean_at = |x: usize, y: usize| {
        let at = 2 * y * width + 2 * x;
        let sum = [at, at + 1, at + width, at + width + 1].iter().map(|&i| spread(texels[i])).sum::<u64>();
        let mean = (sum + 0x02_0002_0002) >> 2 & 0xFF_00FF_00FF;
        (mean & 0xFF_00FF) as u32 | (mean >> 24 & 0xFF00) as u32
    };
    (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| mean_at(x, y))).collect()
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
        assert_eq!(texture.sample(0.105, 0.105, 0.005).dimmed(256), [255; 3]);
        assert_eq!(texture.sample(0.115, 0.105, 0.005).dimmed(256), [0; 3]);
        assert_eq!(texture.sample(0.3, 0.2, 0.05).dimmed(256), [128; 3]);
        assert_eq!(texture.sample(-5.0, 50.0, 1e9).dimmed(128), [64; 3]);
    }

    #[test]
    fn between_texels_and_levels_colour_is_linear() {
        let texture = Texture::new(2, 1, vec![0x00_00FF, 0xFF_8000], (2.0, 1.0));
        assert_eq!(texture.sample(0.75, 0.5, 0.1).dimmed(256), [191, 32, 64]);
        let (red, blue) = (Light(spread(0x00_00FF) << 8), Light(spread(0xFF_0000) << 8));
        assert_eq!(red.blend(blue, 64).dimmed(256), [191, 0, 64]);
        for x in [0.3_f32, 1.0, 5.0, 1000.0] {
            assert!((fast_log2(x) - x.log2()).abs() < 0.09);
        }
    }

    #[test]
    fn widening_the_look_changes_the_colour_without_a_jump() {
        let texels = (0..64 * 64).map(|i| if i % 64 < 3 { 0xFF } else { 0 }).collect();
        let texture = Texture::new(64, 64, texels, (0.64, 0.64));
        let red = |i: i32| i32::from(texture.sample(0.02, 0.3, 0.008 * 1.02_f32.powi(i)).dimmed(256)[0]);
        assert!((0..200).all(|i| (red(i + 1) - red(i)).abs() <= 8));
        assert!(red(0) > 250 && red(200) < 60);
    }
}
