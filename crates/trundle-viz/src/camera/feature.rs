//! Picture of a camera image with its features.

use super::photo::{Photo, no_image};
use crate::canvas::{Canvas, Pen};
use crate::color::Color;
use crate::legend::{LegendItem, Mark, paint_legend};
use trundle_core::ColorImage;

/// A feature in the camera view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureMark {
    /// Column, px of the image.
    pub x: f64,
    /// Row, px of the image.
    pub y: f64,
    /// Diameter of the described patch, px of the image (for ORB: 31 times the scale of its octave). The drawing uses a quarter of the
    /// diameter, which keeps the picture visible under many features.
    pub size: f64,
    /// Orientation, rad, image axes (x right, y down).
    pub angle: f64,
    /// Whether the feature was matched with a landmark.
    pub tracked: bool,
}

const TRACKED: Color = Color::rgb(0x00_c8_92);
const UNTRACKED: Color = Color::YELLOW;
const RIM: Color = Color::BLACK.alpha(150);

/// The camera view with its features as circles and a stroke along the orientation. Tracked ones are green and bold, the others yellow and
/// thin; their numbers are at the bottom. An 8-bit RGB PNG; the image is enlarged to about 960 px by a whole number, or shrunk below 3000
/// px. Features that are not finite are left out; an empty image gives a picture with a note.
pub fn feature_picture(color: &ColorImage, features: &[FeatureMark]) -> Vec<u8> {
    let Some(mut photo) = Photo::new(color, true, |pixel| *pixel) else { return no_image() };
    for tracked in [false, true] {
        features.iter().filter(|f| f.tracked == tracked).for_each(|f| draw_mark(&mut photo, f));
    }
    let count = |tracked: bool| features.iter().filter(|f| f.tracked == tracked).count();
    let legend = [
        LegendItem::new(format!("{} matched with landmarks", count(true)), TRACKED, Mark::Ring),
        LegendItem::new(format!("{} not matched", count(false)), Color::rgb(0xc9_b8_00), Mark::Ring),
    ];
    let strip = with_padding(&paint_legend(&legend, 0, photo.unit()), photo.unit());
    photo.with_strip(&strip)
}

fn draw_mark(photo: &mut Photo, feature: &FeatureMark) {
    let finite = [feature.x, feature.y, feature.angle].iter().all(|v| v.is_finite());
    if !finite {
        return;
    }
    let unit = (photo.canvas.width() as f64 / 900.0).max(0.8);
    let size = if feature.size.is_finite() { feature.size } else { 0.0 };
    let radius = (size / 8.0 * photo.zoom).clamp(3.5 * unit, 40.0 * unit);
    let center = ((feature.x + 0.5) * photo.zoom, (feature.y + 0.5) * photo.zoom);
    let (color, line) = if feature.tracked { (TRACKED, 2.2 * unit) } else { (UNTRACKED, 1.3 * unit) };
    let (sin, cos) = feature.angle.sin_cos();
    let tip = (center.0 + radius * cos, center.1 + radius * sin);
    photo.canvas.ring(center, radius + 0.8 * unit, line + 1.6 * unit, RIM);
    photo.canvas.ring(center, radius, line, color);
    photo.canvas.polyline([center, tip], Pen::solid(color, 0.8 * line));
}

fn with_padding(strip: &Canvas, unit: i64) -> Canvas {
    let mut padded = Canvas::new(strip.width() + 6 * unit, strip.height() + 6 * unit, Color::WHITE);
    padded.paste(strip, 3 * unit, 4 * unit);
    padded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(x: f64, tracked: bool) -> FeatureMark {
        FeatureMark { x, y: 10.0, size: 31.0, angle: 0.3, tracked }
    }

    #[test]
    fn tracked_and_untracked_differ_and_nonsense_is_left_out() {
        let image = ColorImage::filled(40, 30, [120; 3]);
        let picture = |features: &[FeatureMark]| feature_picture(&image, features);
        assert_ne!(picture(&[mark(10.0, true)]), picture(&[mark(10.0, false)]));
        assert_eq!(picture(&[mark(f64::NAN, true)]), picture(&[mark(1e300, true)]));
        assert!(!feature_picture(&ColorImage::default(), &[mark(1.0, true)]).is_empty());
    }
}
