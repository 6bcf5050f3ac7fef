//! A camera image on a canvas, enlarged or shrunk by a whole number.

use crate::canvas::{Canvas, Pen};
use crate::color::Color;
use crate::text::{TextStyle, line_height, text_width};
use trundle_core::Image;

/// Width to which small camera pictures are enlarged, px, for sharp marks. Source: ours.
const TARGET_WIDTH: usize = 960;
/// Largest side of a picture of a camera \[px\]. Source: ours.
const MAX_SIDE: usize = 3000;

/// A camera image on a canvas, enlarged or shrunk by a whole number.
pub(crate) struct Photo {
    pub canvas: Canvas,
    /// Canvas pixels per image pixel.
    pub zoom: f64,
}

impl Photo {
    /// Paints `color(x, y)` for each pixel of an image. `None` if the image is empty. Enlarged smoothly or in blocks.
    pub(crate) fn new<T>(image: &Image<T>, smooth: bool, color: impl Fn(&T) -> [u8; 3]) -> Option<Self> {
        let (width, height) = (image.width(), image.height());
        let long = width.max(height);
        if width == 0 || height == 0 {
            return None;
        }
        let (enlarge, shrink) = match long {
            n if n > MAX_SIDE => (1, n.div_ceil(MAX_SIDE)),
            n => ((TARGET_WIDTH.div_ceil(width)).min(MAX_SIDE / n).max(1), 1),
        };
        let size = |side: usize| (side / shrink).max(1) * enlarge;
        let mut canvas = Canvas::new(size(width) as i64, size(height) as i64, Color::BLACK);
        let at = |x: usize, y: usize| color(&image[(x.min(width - 1), y.min(height - 1))]).map(f64::from);
        for y in 0..size(height) {
            for x in 0..size(width) {
                let pixel = if smooth && enlarge > 1 {
                    between(at, x, y, enlarge)
                } else {
                    at(x / enlarge * shrink, y / enlarge * shrink)
                };
                let [r, g, b] = pixel.map(|channel| channel.round() as u8);
                canvas.blend(x as i64, y as i64, Color { r, g, b, a: 255 });
            }
        }
        Some(Self { canvas, zoom: enlarge as f64 / shrink as f64 })
    }

    /// The unit of text and lines, px: readable even if two pictures share a page's width.
    pub(crate) fn unit(&self) -> i64 {
        (self.canvas.width() / 340).clamp(1, 8)
    }

    /// The picture as PNG with a strip of the same width below it.
    pub(crate) fn with_strip(self, strip: &Canvas) -> Vec<u8> {
        let width = self.canvas.width().max(strip.width());
        let mut page = Canvas::new(width, self.canvas.height() + strip.height(), Color::WHITE);
        page.paste(&self.canvas, 0, 0);
        page.paste(strip, 0, self.canvas.height());
        page.to_png()
    }
}

/// Bilinear between the four pixels around the centre of a canvas pixel.
fn between(at: impl Fn(usize, usize) -> [f64; 3], x: usize, y: usize, enlarge: usize) -> [f64; 3] {
    let place = |v: usize| ((v as f64 + 0.5) / enlarge as f64 - 0.5).max(0.0);
    let (px, py) = (place(x), place(y));
    let (x0, y0, fx, fy) = (px as usize, py as usize, px.fract(), py.fract());
    let mix = |a: [f64; 3], b: [f64; 3], f: f64| [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * f);
    let row = |y: usize| mix(at(x0, y), at(x0 + 1, y), fx);
    mix(row(y0), row(y0 + 1), fy)
}

/// Placeholder for a picture without a pixel.
pub(crate) fn no_image() -> Vec<u8> {
    let (scale, text) = (2, "no image");
    let mut canvas = Canvas::new(320, 120, Color::HAIRLINE);
    let (x, y) = (160 - text_width(text, scale) / 2, 60 - line_height(scale) / 2);
    canvas.text(x, y, text, TextStyle::new(scale, Color::FAINT_INK));
    canvas.polyline([(0.0, 0.0), (0.0, 120.0)], Pen::solid(Color::HAIRLINE, 1.0));
    canvas.to_png()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enlarging_keeps_places_and_colours() {
        let image = Image::from_fn(64, 32, |x, _| if x < 32 { 0_u8 } else { 200 });
        let photo = Photo::new(&image, true, |v| [*v; 3]).unwrap();
        assert_eq!((photo.zoom, photo.canvas.width(), photo.canvas.height()), (15.0, 960, 480));
        assert_eq!(photo.canvas.at(100, 100), [0; 3]);
        assert_eq!(photo.canvas.at(800, 100), [200; 3]);
        assert!(photo.canvas.at(480, 100)[0] > 90 && photo.canvas.at(480, 100)[0] < 120);
    }

    #[test]
    fn large_images_shrink_and_empty_ones_are_none() {
        let photo = Photo::new(&Image::filled(7000, 3, 9_u8), true, |v| [*v; 3]).unwrap();
        assert_eq!((photo.canvas.width(), photo.canvas.height()), (2333, 1));
        assert!(Photo::new(&Image::filled(0, 3, 9_u8), true, |v| [*v; 3]).is_none());
    }
}
