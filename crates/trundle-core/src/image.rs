//! Images as arrays of pixels: grey, colour and depth.

use crate::Invalid;

/// An image: row by row from the top left, `data[y * width + x]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Image<T> {
    width: usize,
    height: usize,
    data: Vec<T>,
}

/// Luminance, 0 to 255.
pub type GrayImage = Image<u8>;
/// Red, green, blue, 0 to 255 each (sRGB).
pub type ColorImage = Image<[u8; 3]>;
/// Depth along the optical axis, metres; 0 for unknown.
pub type DepthImage = Image<f32>;

impl<T> Image<T> {
    /// An image over `data` of `width * height` pixels.
    ///
    /// # Errors
    /// When a side is zero or `data` has another length.
    pub fn new(width: usize, height: usize, data: Vec<T>) -> Result<Self, Invalid> {
        if width == 0 || height == 0 {
            return Err(Invalid::new("image size", format!("{width} x {height}"), "px", "at least 1 x 1"));
        }
        if width.checked_mul(height) != Some(data.len()) {
            let expected = format!("{width} x {height}");
            return Err(Invalid::new("number of pixels", data.len(), "px", expected));
        }
        Ok(Self { width, height, data })
    }

    /// An image whose pixel (x, y) is `pixel(x, y)`.
    pub fn from_fn(width: usize, height: usize, mut pixel: impl FnMut(usize, usize) -> T) -> Self {
        let data =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Self { width, height, data }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// All pixels, row by row: their memory, for another image.
    pub fn into_data(self) -> Vec<T> {
        self.data
    }

    /// All pixels, row by row.
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// The pixels of row `y`. Panics for a row outside the image.
    pub fn row(&self, y: usize) -> &[T] {
        &self.data[y * self.width..(y + 1) * self.width]
    }

    /// The pixels of row `y`. Panics for a row outside the image.
    pub fn row_mut(&mut self, y: usize) -> &mut [T] {
        &mut self.data[y * self.width..(y + 1) * self.width]
    }

    /// The pixel at column `x`, row `y`; `None` outside the image.
    pub fn get(&self, x: usize, y: usize) -> Option<&T> {
        (x < self.width && y < self.height).then(|| &self.data[y * self.width + x])
    }

    /// Whether both images have the same size.
    pub fn same_size<U>(&self, other: &Image<U>) -> bool {
        self.width == other.width && self.height == other.height
    }
}

impl<T: Clone> Image<T> {
    /// An image of one value. Panics never; a side may be zero.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, data: vec![value; width * height] }
    }
}

/// The pixel at column `x`, row `y`. Panics outside.
impl<T> std::ops::Index<(usize, usize)> for Image<T> {
    type Output = T;

    fn index(&self, (x, y): (usize, usize)) -> &T {
        debug_assert!(x < self.width, "column {x} of {}", self.width);
        &self.data[y * self.width + x]
    }
}

/// The pixel at column `x`, row `y`. Panics outside.
impl<T> std::ops::IndexMut<(usize, usize)> for Image<T> {
    fn index_mut(&mut self, (x, y): (usize, usize)) -> &mut T {
        debug_assert!(x < self.width, "column {x} of {}", self.width);
        &mut self.data[y * self.width + x]
    }
}

/// Luminance by the integer weights of ITU-R BT.601: (77 R + 150 G + 29 B + 128) / 256.
pub fn gray_from_color(color: &ColorImage) -> GrayImage {
    let luma = |p: &[u8; 3]| ((77 * p[0] as u32 + 150 * p[1] as u32 + 29 * p[2] as u32 + 128) >> 8) as u8;
    Image { width: color.width, height: color.height, data: color.data.iter().map(luma).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_a_wrong_number_of_pixels() {
        let error = Image::new(3, 2, vec![0u8; 5]).unwrap_err();
        assert_eq!(error.to_string(), "number of pixels is 5 px, expected 3 x 2");
        assert!(Image::<u8>::new(0, 2, vec![]).is_err());
    }

    #[test]
    fn gray_keeps_black_and_white() {
        let color = Image::new(2, 1, vec![[0; 3], [255; 3]]).unwrap();
        assert_eq!(gray_from_color(&color).data(), &[0, 255]);
    }
}
