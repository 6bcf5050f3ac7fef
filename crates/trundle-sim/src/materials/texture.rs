//! Textures with mip levels.

mod light;
mod shrink;

pub(crate) use light::Light;
use light::spread;
use shrink::halved;
use trundle_core::ColorImage;

/// A rectangle of colours with its mip levels, for the camera.
///
/// Texels are `0x00BBGGRR`, row by row from the top left. Each level is half the previous one in both directions, by averaging (Williams
/// 1983, "Pyramidal parametrics"). A pixel therefore gets the mean of its area.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texture {
    levels: Vec<Level>,
    texels: Vec<u32>,
    /// Texels of level 0.
    size: [f32; 2],
    /// Whether the texture repeats outside its borders; otherwise the border's colour continues.
    repeats: bool,
    /// Texels of level 0 per unit of (u, v).
    scale: [f32; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Level {
    /// Index of the first texel. Each row has an extra texel at its end, and the texture an extra row: every texel has neighbours to the
    /// right and below.
    first: usize,
    stride: usize,
    /// Sixteenths of a texel all across and down.
    extent: [i32; 2],
    /// Sixteenths of a texel a texel of level 0.
    scale: [f32; 2],
}

impl Texture {
    /// A painting of `width` x `height` texels over `size` metres; (u, v) are metres from the left and from the top.
    pub(crate) fn new(width: usize, height: usize, texels: Vec<u32>, size: (f32, f32)) -> Self {
        let scale = [width as f32 / size.0, height as f32 / size.1];
        Self::with_levels(texels, (width, height), scale, false)
    }

    /// Texture of a material: a colour, multiplied by a picture if given. (u, v) are in widths and heights of the picture, which repeats.
    pub(crate) fn of_picture(color: [u8; 3], picture: Option<&ColorImage>) -> Self {
        let tinted = |texel: [u8; 3]| {
            let channel = |k: usize| ((u32::from(texel[k]) * u32::from(color[k]) + 127) / 255) << (8 * k);
            channel(0) | channel(1) | channel(2)
        };
        let Some(picture) = picture else {
            return Self::with_levels(vec![tinted([255; 3])], (1, 1), [1.0; 2], true);
        };
        let texels = picture.data().iter().map(|&texel| tinted(texel)).collect();
        let (width, height) = (picture.width(), picture.height());
        Self::with_levels(texels, (width, height), [width as f32, height as f32], true)
    }

    fn with_levels(
        texels: Vec<u32>,
        (width, height): (usize, usize),
        scale: [f32; 2],
        repeats: bool,
    ) -> Self {
        assert!(texels.len() == width * height && !texels.is_empty(), "invariant: a texel for every place");
        let size = [width as f32, height as f32];
        let mut texture = Self { levels: Vec::new(), texels: Vec::new(), size, repeats, scale };
        texture.texels.reserve_exact(texels.len() * 4 / 3 + 4 * (width + height) + 64);
        let (mut plain, mut w, mut h) = (texels, width, height);
        loop {
            texture.push_level(&plain, (w, h));
            // Paintings end at odd sizes: their borders must not move.
            if (w == 1 && h == 1) || (!repeats && (w % 2 != 0 || h % 2 != 0)) {
                return texture;
            }
            (plain, w, h) = halved(&plain, (w, h));
        }
    }

    fn push_level(&mut self, plain: &[u32], (width, height): (usize, usize)) {
        self.levels.push(Level {
            first: self.texels.len(),
            stride: width + 1,
            extent: [16 * width as i32, 16 * height as i32],
            scale: [16.0 * width as f32 / self.size[0], 16.0 * height as f32 / self.size[1]],
        });
        let beyond = if self.repeats { &plain[..width] } else { &plain[(height - 1) * width..] };
        for row in plain.chunks_exact(width).chain([beyond]) {
            self.texels.extend_from_slice(row);
            self.texels.push(if self.repeats { row[0] } else { row[width - 1] });
        }
    }

    /// Texels of level 0 per unit of (u, v).
    pub(crate) fn scale(&self) -> [f32; 2] {
        self.scale
    }

    /// The colour at (x, y) texels of level 0 from the upper left corner, averaged over 2^`level` texels in each direction.
    ///
    /// The blend between two levels uses the middle half of the interval. Like the usual blend over the whole interval it is continuous, at
    /// three quarters of the cost.
    #[inline(always)]
    pub(crate) fn sample(&self, [x, y]: [f32; 2], level: f32) -> Light {
        let [x, y] = if self.repeats { self.wrapped([x, y]) } else { [x, y] };
        let level = if level > 0.0 { level } else { 0.0 };
        let last = self.levels.len() - 1;
        let lower = (level as i32 as usize).min(last);
        let part = ((level - lower as f32) * 512.0) as i32 - 128;
        let upper = (lower + 1).min(last);
        if part <= 0 {
            self.bilinear(&self.levels[lower], x, y)
        } else if part >= 256 {
            self.bilinear(&self.levels[upper], x, y)
        } else {
            let sharp = self.bilinear(&self.levels[lower], x, y);
            sharp.blend(self.bilinear(&self.levels[upper], x, y), part as u32)
        }
    }

    /// The same place in the rectangle itself.
    #[inline(always)]
    fn wrapped(&self, place: [f32; 2]) -> [f32; 2] {
        let inside = |k: usize| place[k] - (place[k] / self.size[k]).floor() * self.size[k];
        [inside(0), inside(1)]
    }

    /// The light between the four texels around a point, in sixteenths of a texel.
    #[inline(always)]
    fn bilinear(&self, level: &Level, x: f32, y: f32) -> Light {
        let x = self.inside((x * level.scale[0] - 8.0) as i32, level.extent[0]);
        let y = self.inside((y * level.scale[1] - 8.0) as i32, level.extent[1]);
        let at = level.first + (y >> 4) as usize * level.stride + (x >> 4) as usize;
        let (fx, fy) = ((x & 15) as u64, (y & 15) as u64);
        let both = fx * fy;
        let (upper, lower) =
            (&self.texels[at..at + 2], &self.texels[at + level.stride..at + level.stride + 2]);
        let upper = spread(upper[0]) * (256 + both - 16 * (fx + fy)) + spread(upper[1]) * (16 * fx - both);
        let lower = spread(lower[0]) * (16 * fy - both) + spread(lower[1]) * both;
        Light(upper + lower)
    }

    /// A place that may be half a texel and a rounding outside, in sixteenths of a texel.
    #[inline(always)]
    fn inside(&self, x: i32, extent: i32) -> i32 {
        let x = if self.repeats && x < 0 { x + extent } else { x };
        x.max(0).min(extent - if self.repeats { 1 } else { 16 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_look_sees_the_mean_and_a_narrow_one_the_texel() {
        let checker = (0..64 * 32).map(|i| if (i / 64 + i) % 2 == 0 { 0xFF_FFFF } else { 0 }).collect();
        let texture = Texture::new(64, 32, checker, (0.64, 0.32));
        assert!(texture.scale().iter().all(|scale| (scale - 100.0).abs() < 1e-4));
        assert_eq!(texture.sample([10.5, 10.5], -1.0).dimmed(256), [255; 3]);
        assert_eq!(texture.sample([11.5, 10.5], -1.0).dimmed(256), [0; 3]);
        assert_eq!(texture.sample([30.0, 20.0], 2.2).dimmed(256), [128; 3]);
        assert_eq!(texture.sample([-500.0, 5000.0], 99.0).dimmed(128), [64; 3]);
    }

    #[test]
    fn between_texels_colour_is_linear() {
        let texture = Texture::new(2, 1, vec![0x00_00FF, 0xFF_8000], (2.0, 1.0));
        assert_eq!(texture.sample([0.75, 0.5], -3.0).dimmed(256), [191, 32, 64]);
    }

    #[test]
    fn widening_the_look_changes_the_colour_without_a_jump() {
        let texels = (0..64 * 64).map(|i| if i % 64 < 3 { 0xFF } else { 0 }).collect();
        let texture = Texture::new(64, 64, texels, (0.64, 0.64));
        let level = |i: i32| (0.8 * 1.02_f32.powi(i)).log2();
        let red = |i: i32| i32::from(texture.sample([2.0, 30.0], level(i)).dimmed(256)[0]);
        assert!((0..200).all(|i| (red(i + 1) - red(i)).abs() <= 8));
        assert!(red(0) > 250 && red(200) < 60);
    }

    #[test]
    fn pictures_repeat_without_a_seam_and_take_the_materials_colour() {
        let wave =
            |i: usize, n: usize| (100.0 + 100.0 * (std::f64::consts::TAU * i as f64 / n as f64).sin()) as u8;
        let picture = ColorImage::from_fn(45, 31, |x, y| [wave(x, 45), wave(y, 31), 200]);
        let texture = Texture::of_picture([255, 255, 51], Some(&picture));
        for level in [-1.0, 0.5, 1.0, 2.3] {
            let at = |x: f32, y: f32| texture.sample([x, y], level).dimmed(256).map(i32::from);
            for step in 0..600 {
                let x = 0.1 * step as f32;
                let (here, next) = (at(x, 0.3 * x), at(x + 0.1, 0.3 * (x + 0.1)));
                assert!((0..3).all(|k| (here[k] - next[k]).abs() <= 8), "{level}: {here:?} {next:?} at {x}");
                let again = at(x + 45.0, 0.3 * x - 62.0);
                assert!(
                    (0..3).all(|k| (here[k] - again[k]).abs() <= 3),
                    "{level}: {here:?} {again:?} at {x}"
                );
            }
        }
        let mean = texture.sample([3.0, 4.0], 77.0).dimmed(256);
        assert!(mean.iter().zip([100_u8, 100, 40]).all(|(a, b)| a.abs_diff(b) <= 1), "{mean:?}");
        assert_eq!(Texture::of_picture([9, 8, 7], None).sample([5.3, -9.0], 3.0).dimmed(256), [9, 8, 7]);
    }
}
