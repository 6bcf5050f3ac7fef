//! Picture of a depth image in colours, with a scale.

use super::photo::{Photo, no_image};
use crate::canvas::Canvas;
use crate::color::Color;
use crate::colormap::color_at;
use crate::text::{TextStyle, cap_height, text_width};
use crate::ticks::Ticks;
use trundle_core::DepthImage;

/// A depth image in colour: near is light, far is dark, unknown is black; a scale in metres is at the bottom.
///
/// The scale covers the 1st to the 99th percentile of the measured depths. An 8-bit RGB PNG; the image is enlarged to about 960 px by a
/// whole number, or shrunk below 3000 px. An empty image gives a picture with a note.
pub fn depth_picture(depth: &DepthImage) -> Vec<u8> {
    let (near, far) = range(depth.data());
    let color = |metres: &f32| match f64::from(*metres) {
        m if m.is_finite() && m > 0.0 => color_at((m - near) / (far - near)),
        _ => [0; 3],
    };
    match Photo::new(depth, false, color) {
        Some(photo) => {
            let strip = paint_scale(photo.canvas.width(), photo.unit(), near, far);
            photo.with_strip(&strip)
        }
        None => no_image(),
    }
}

/// The 1st and the 99th percentile of all that is a depth, at least a millimetre apart, m.
fn range(depths: &[f32]) -> (f64, f64) {
    let mut valid: Vec<f32> = depths.iter().copied().filter(|d| d.is_finite() && *d > 0.0).collect();
    if valid.is_empty() {
        return (0.0, 1.0);
    }
    valid.sort_unstable_by(f32::total_cmp);
    let at = |fraction: f64| f64::from(valid[((valid.len() - 1) as f64 * fraction).round() as usize]);
    let near = at(0.01);
    (near, at(0.99).max(near + 1e-3 * near.max(1.0)))
}

fn paint_scale(width: i64, unit: i64, near: f64, far: f64) -> Canvas {
    let mut canvas = Canvas::new(width, cap_height(unit) + 19 * unit, Color::WHITE);
    let (left, length, bar) = (10 * unit, width - 20 * unit, 8 * unit);
    for x in 0..length.max(0) {
        let [r, g, b] = color_at(x as f64 / length as f64);
        canvas.fill_rect(left + x, 4 * unit, 1, bar, Color { r, g, b, a: 255 });
    }
    let ticks = Ticks::new(near, far, 6);
    for &value in &ticks.values {
        let label = format!("{} m", ticks.label(value));
        let x = left + ((value - near) / (far - near) * length as f64).round() as i64;
        canvas.fill_rect(x, 4 * unit + bar, (unit / 2).max(1), 2 * unit, Color::FAINT_INK);
        let text = text_width(&label, unit);
        let start = (x - text / 2).clamp(0, (width - text).max(0));
        canvas.text(start, bar + 8 * unit, &label, TextStyle::new(unit, Color::INK));
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_leaves_outliers_and_holes_out() {
        let mut depths = vec![1.0_f32; 500];
        depths.extend([3.0; 500]);
        depths.extend([0.0, f32::NAN, 900.0, -1.0]);
        assert_eq!(range(&depths), (1.0, 3.0));
        assert_eq!(range(&[0.0, f32::NAN]), (0.0, 1.0));
        let (near, far) = range(&[2.0; 9]);
        assert!(far > near);
    }

    #[test]
    fn any_image_gives_a_picture() {
        for depth in
            [DepthImage::default(), DepthImage::filled(3, 2, f32::NAN), DepthImage::filled(1, 1, 1e38)]
        {
            assert_eq!(&depth_picture(&depth)[1..4], b"PNG");
        }
    }
}
