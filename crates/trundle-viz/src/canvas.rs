//! A raster canvas with lines, discs and polygons, and its PNG encoder.

use crate::clip::{Px, visible_runs};
use crate::color::Color;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};
use trundle_core::Hypotenuse;

/// Longest side of any canvas, px. Source: ours.
pub(crate) const MAX_SIDE: i64 = 6000;

/// Style of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pen {
    pub color: Color,
    /// Pixels.
    pub width: f64,
    /// Length of dash and gap, px.
    pub dash: Option<f64>,
}

impl Pen {
    pub(crate) fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: None }
    }
}

/// An opaque picture being drawn. Everything outside the picture, and every number that is not finite, is left out.
#[derive(Debug, Clone)]
pub(crate) struct Canvas {
    /// Always opaque: premultiplied and straight colour are the same.
    pixels: Pixmap,
}

impl Canvas {
    /// A canvas of one opaque colour; sides are held in 1 to [`MAX_SIDE`].
    pub(crate) fn new(width: i64, height: i64, background: Color) -> Self {
        let side = |length: i64| length.clamp(1, MAX_SIDE) as u32;
        let mut pixels = Pixmap::new(side(width), side(height)).expect("invariant: sides are 1 to MAX_SIDE");
        pixels.fill(tiny_skia::Color::from_rgba8(background.r, background.g, background.b, 255));
        Self { pixels }
    }

    pub(crate) fn width(&self) -> i64 {
        i64::from(self.pixels.width())
    }

    pub(crate) fn height(&self) -> i64 {
        i64::from(self.pixels.height())
    }

    /// Lays a colour over one pixel.
    pub(crate) fn blend(&mut self, x: i64, y: i64, color: Color) {
        if x < 0 || y < 0 || x >= self.width() || y >= self.height() {
            return;
        }
        let at = ((y * self.width() + x) * 4) as usize;
        let pixel = &mut self.pixels.data_mut()[at..at + 3];
        pixel.copy_from_slice(&color.over([pixel[0], pixel[1], pixel[2]]));
    }

    /// Lays a colour over a rectangle of whole pixels.
    pub(crate) fn fill_rect(&mut self, x: i64, y: i64, width: i64, height: i64, color: Color) {
        for row in y.max(0)..(y.saturating_add(height)).min(self.height()) {
            for column in x.max(0)..(x.saturating_add(width)).min(self.width()) {
                self.blend(column, row, color);
            }
        }
    }

    /// The border of a rectangle of whole pixels, drawn inside it.
    pub(crate) fn frame_rect(&mut self, x: i64, y: i64, width: i64, height: i64, line: i64, color: Color) {
        self.fill_rect(x, y, width, line, color);
        self.fill_rect(x, y + height - line, width, line, color);
        self.fill_rect(x, y + line, line, height - 2 * line, color);
        self.fill_rect(x + width - line, y + line, line, height - 2 * line, color);
    }

    /// A line with round joins; a point that is not finite interrupts it.
    pub(crate) fn polyline(&mut self, points: impl IntoIterator<Item = Px>, pen: Pen) {
        let size = (self.width() as f64, self.height() as f64);
        if !(pen.width.is_finite() && pen.width > 0.0) {
            return;
        }
        let width = pen.width.min(MAX_SIDE as f64);
        let mut path = PathBuilder::new();
        for run in visible_runs(points, size, width + 2.0) {
            path.move_to(run[0].0 as f32, run[0].1 as f32);
            run[1..].iter().for_each(|p| path.line_to(p.0 as f32, p.1 as f32));
        }
        let dash = pen.dash.map(|length| (length.clamp(1.0, 1000.0) as f32, width as f32));
        let stroke = Stroke {
            width: width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash: dash.and_then(|(length, width)| StrokeDash::new(vec![length, length + width], 0.0)),
            ..Stroke::default()
        };
        if let Some(path) = path.finish() {
            self.pixels.stroke_path(&path, &paint(pen.color), &stroke, Transform::identity(), None);
        }
    }

    /// The lines of a path, with round joins.
    pub(crate) fn stroke(&mut self, path: &Path, pen: Pen) {
        let stroke = Stroke { width: pen.width as f32, line_join: LineJoin::Round, ..Stroke::default() };
        self.pixels.stroke_path(path, &paint(pen.color), &stroke, Transform::identity(), None);
    }

    /// The area of a path.
    pub(crate) fn fill(&mut self, path: &Path, color: Color) {
        self.pixels.fill_path(path, &paint(color), FillRule::Winding, Transform::identity(), None);
    }

    /// A filled outline. Points far outside are drawn nearer in.
    pub(crate) fn polygon(&mut self, points: &[Px], color: Color) {
        let far = 4.0 * (self.width().max(self.height()) as f64);
        let tame = |v: f64| v.clamp(-far, far) as f32;
        let mut finite = points.iter().filter(|p| p.0.is_finite() && p.1.is_finite());
        let Some(first) = finite.next() else { return };
        let mut path = PathBuilder::new();
        path.move_to(tame(first.0), tame(first.1));
        finite.for_each(|p| path.line_to(tame(p.0), tame(p.1)));
        path.close();
        if let Some(path) = path.finish() {
            self.pixels.fill_path(&path, &paint(color), FillRule::Winding, Transform::identity(), None);
        }
    }

    /// A filled disc, smooth at its edge. Cheap enough for a hundred thousand landmarks.
    pub(crate) fn dot(&mut self, center: Px, radius: f64, color: Color) {
        self.round(center, radius, color, |distance| radius + 0.5 - distance);
    }

    /// A circle `line` px wide, its outer edge at `radius`.
    pub(crate) fn ring(&mut self, center: Px, radius: f64, line: f64, color: Color) {
        self.round(center, radius, color, |distance| {
            (radius + 0.5 - distance).min(distance - (radius - line - 0.5))
        });
    }

    /// Blends a colour over each pixel near `center`, with the opacity that `coverage` gives for its distance.
    fn round(&mut self, center: Px, radius: f64, color: Color, coverage: impl Fn(f64) -> f64) {
        let size = self.width().max(self.height()) as f64;
        let near = |v: f64| v.is_finite() && v > -size && v < 2.0 * size;
        if !(near(center.0) && near(center.1) && radius.is_finite() && radius > 0.0) {
            return;
        }
        let reach = radius.min(2.0 * size) + 1.0;
        let range = |middle: f64, limit: i64| {
            ((middle - reach).floor() as i64).max(0)..((middle + reach).ceil() as i64 + 1).min(limit)
        };
        for y in range(center.1, self.height()) {
            for x in range(center.0, self.width()) {
                let distance = (x as f64 + 0.5 - center.0).hypotenuse(y as f64 + 0.5 - center.1);
                let opacity = f64::from(color.a) * coverage(distance).clamp(0.0, 1.0);
                if opacity >= 0.5 {
                    self.blend(x, y, color.alpha(opacity.round() as u8));
                }
            }
        }
    }

    /// Copies another canvas with its upper left corner to this position.
    pub(crate) fn paste(&mut self, other: &Self, x: i64, y: i64) {
        let (from, to) = (x.max(0), (x + other.width()).min(self.width()));
        if from >= to {
            return;
        }
        let bytes = ((to - from) * 4) as usize;
        let (own, others) = (self.width(), other.width());
        for row in y.max(0)..(y + other.height()).min(self.height()) {
            let source = (((row - y) * others + (from - x)) * 4) as usize;
            let target = ((row * own + from) * 4) as usize;
            self.pixels.data_mut()[target..target + bytes]
                .copy_from_slice(&other.pixels.data()[source..source + bytes]);
        }
    }

    /// The picture as an 8-bit RGB PNG: same picture, same bytes.
    pub(crate) fn to_png(&self) -> Vec<u8> {
        let rgb: Vec<u8> = self.pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, self.pixels.width(), self.pixels.height());
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Balanced);
        encoder.set_filter(Filter::Adaptive);
        let mut writer = encoder.write_header().expect("invariant: memory takes a header");
        writer.write_image_data(&rgb).expect("invariant: memory takes width x height pixels");
        writer.finish().expect("invariant: memory takes the end");
        bytes
    }
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(color.r, color.g, color.b, color.a);
    paint
}

impl Canvas {
    /// The colour of a pixel inside the picture.
    pub(crate) fn at(&self, x: i64, y: i64) -> [u8; 3] {
        let at = ((y * self.width() + x) * 4) as usize;
        let pixel = &self.pixels.data()[at..at + 3];
        [pixel[0], pixel[1], pixel[2]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_drawn_at_their_coordinates() {
        let mut canvas = Canvas::new(40, 30, Color::WHITE);
        canvas.fill_rect(-5, -5, 8, 8, Color::BLACK);
        canvas.dot((20.0, 15.0), 4.0, Color::BLUE);
        canvas.polyline([(30.0, 0.0), (30.0, 30.0)], Pen::solid(Color::ORANGE, 4.0));
        assert_eq!(canvas.at(2, 2), [0; 3]);
        assert_eq!(canvas.at(3, 3), [255; 3]);
        assert_eq!(canvas.at(20, 15), [0, 0x72, 0xb2]);
        assert_eq!(canvas.at(30, 15), [0xe6, 0x9f, 0]);
        assert_eq!(canvas.at(36, 15), [255; 3]);
    }

    #[test]
    fn absurd_numbers_are_left_out() {
        let mut canvas = Canvas::new(10, 10, Color::WHITE);
        let blank = canvas.to_png();
        for wild in [f64::NAN, f64::INFINITY, 1e300] {
            canvas.dot((wild, 1.0), 2.0, Color::BLACK);
            canvas.dot((1.0, 1.0), f64::NAN, Color::BLACK);
            canvas.polyline([(wild, wild), (wild, -wild)], Pen::solid(Color::BLACK, 2.0));
            canvas.polyline([(0.0, 0.0), (5.0, 5.0)], Pen::solid(Color::BLACK, f64::NAN));
        }
        canvas.paste(&Canvas::new(3, 3, Color::BLACK), 50, 50);
        assert_eq!(canvas.to_png(), blank);
        assert_eq!(Canvas::new(0, -3, Color::WHITE).width(), 1);
    }
}
