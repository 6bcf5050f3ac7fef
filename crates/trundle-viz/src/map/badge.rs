//! Short labels in circles on a map, placed without overlap.

use super::arrow::draw_leader;
use super::view::View;
use crate::canvas::Canvas;
use crate::clip::Px;
use crate::color::Color;
use crate::text::{TextStyle, cap_height, text_width};
use trundle_core::{Hypotenuse, Vector2};

/// Space around a text within its badge, in dots of the typeface. Source: ours.
const PADDING_DOTS: f64 = 2.5;
/// Maximum shift of a badge from its place, in badge diameters. Source: ours.
const MAX_SHIFT_DIAMETERS: u32 = 6;
/// Bearings tried at each distance. Source: ours.
const BEARINGS_PER_DISTANCE: u32 = 12;

/// Short texts in circles at their places without overlaps: an overlapping one is moved aside, with a line to its place.
pub(super) fn draw_badges(canvas: &mut Canvas, view: &View, badges: &[(String, Vector2)], color: Color) {
    let scale = view.unit + 1;
    let places: Vec<Px> = badges.iter().map(|(_, p)| view.px(*p)).collect();
    let radius = badges.iter().map(|(text, _)| radius_of(text, scale)).fold(0.0, f64::max);
    let size = (canvas.width() as f64, canvas.height() as f64);
    let placed = spread(&places, radius, size);
    for (from, to) in places.iter().zip(&placed).filter(|(from, to)| from != to) {
        draw_leader(canvas, *from, *to, scale as f64, color);
    }
    for ((text, _), center) in badges.iter().zip(placed) {
        draw_badge(canvas, center, radius, text, scale, color);
    }
}

/// A text in its circle.
pub(crate) fn draw_badge(canvas: &mut Canvas, center: Px, radius: f64, text: &str, scale: i64, color: Color) {
    if !(center.0.is_finite() && center.1.is_finite()) {
        return;
    }
    canvas.dot(center, radius, Color::WHITE);
    canvas.ring(center, radius, 0.8 * scale as f64, color);
    let left = center.0 - text_width(text, scale) as f64 / 2.0;
    let top = center.1 - cap_height(scale) as f64 / 2.0;
    canvas.text(left.round() as i64, top.round() as i64, text, TextStyle::new(scale, Color::INK));
}

/// The circle about a text, px.
pub(crate) fn radius_of(text: &str, scale: i64) -> f64 {
    (text_width(text, scale) as f64).hypotenuse(cap_height(scale) as f64) / 2.0
        + PADDING_DOTS * scale as f64 / 2.0
}

/// Centres of the circles for `places`: at the place, or at the nearest position without overlap, within a picture of `size`.
fn spread(places: &[Px], radius: f64, size: Px) -> Vec<Px> {
    let mut placed: Vec<Px> = Vec::with_capacity(places.len());
    for &place in places {
        let is_free = |p: &Px| {
            let inside = |at: f64, size: f64| at >= radius && at <= size - radius;
            inside(p.0, size.0)
                && inside(p.1, size.1)
                && placed.iter().all(|q| (p.0 - q.0).hypotenuse(p.1 - q.1) > 2.0 * radius + 1.0)
        };
        let beside = (1..=2 * MAX_SHIFT_DIAMETERS).flat_map(|step| {
            let distance = f64::from(step) * radius;
            (0..BEARINGS_PER_DISTANCE).map(move |i| {
                let (sin, cos) =
                    (std::f64::consts::TAU * f64::from(i) / f64::from(BEARINGS_PER_DISTANCE)).sin_cos();
                (place.0 + distance * cos, place.1 - distance * sin)
            })
        });
        let chosen = std::iter::once(place).chain(beside).find(is_free).unwrap_or(place);
        placed.push(chosen);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_badge_lies_over_another_or_off_the_picture() {
        let places: Vec<Px> = (0..12).map(|i| (50.0 + f64::from(i), 3.0)).collect();
        let placed = spread(&places, 8.0, (300.0, 300.0));
        for (i, p) in placed.iter().enumerate() {
            assert!(p.0 >= 8.0 && p.1 >= 8.0, "{p:?}");
            for q in &placed[..i] {
                assert!((p.0 - q.0).hypotenuse(p.1 - q.1) > 16.0, "{p:?} {q:?}");
            }
        }
        assert_eq!(spread(&[(100.0, 100.0)], 8.0, (300.0, 300.0)), [(100.0, 100.0)]);
    }
}
