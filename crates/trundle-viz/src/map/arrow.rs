//! Arrows and leader lines on a map.

use super::draw::draw_line;
use super::style::LineStyle;
use super::view::View;
use crate::canvas::{Canvas, Pen};
use crate::clip::Px;
use crate::color::Color;
use trundle_core::{Hypotenuse, Vector2};

/// Length of a head in line widths, and half its breadth. Source: ours.
const HEAD_SIZE_LINE_WIDTHS: (f64, f64) = (4.6, 2.3);

/// A line with an arrowhead at its end; a line shorter than its head becomes the head only.
pub(super) fn draw_arrow(canvas: &mut Canvas, view: &View, points: &[Vector2], style: &LineStyle) {
    let Some(&end) = points.last() else { return };
    let tip = view.px(end);
    let length = HEAD_SIZE_LINE_WIDTHS.0 * style.width * view.unit as f64;
    // The direction in which the last part of the line arrives, as long as the head.
    let away = |p: &&Vector2| distance(view.px(**p), tip) >= length;
    let Some(from) = points.iter().rev().find(away).or(points.first()).map(|p| view.px(*p)) else { return };
    draw_line(canvas, view, points, style);
    let far = distance(from, tip);
    if far > 0.0 && far.is_finite() {
        let along = ((tip.0 - from.0) / far, (tip.1 - from.1) / far);
        head(canvas, tip, along, length + 1.5 * view.unit as f64, Color::WHITE.alpha(190));
        head(canvas, tip, along, length, style.color);
    }
}

fn head(canvas: &mut Canvas, tip: Px, (x, y): Px, length: f64, color: Color) {
    let half = length * HEAD_SIZE_LINE_WIDTHS.1 / HEAD_SIZE_LINE_WIDTHS.0;
    let foot = (tip.0 - x * length, tip.1 - y * length);
    let side = |s: f64| (foot.0 - y * half * s, foot.1 + x * half * s);
    canvas.polygon(&[tip, side(1.0), side(-1.0)], color);
}

fn distance(a: Px, b: Px) -> f64 {
    (a.0 - b.0).hypotenuse(a.1 - b.1)
}

/// A line from a place to its moved note.
pub(super) fn draw_leader(canvas: &mut Canvas, from: Px, to: Px, unit: f64, color: Color) {
    canvas.polyline([from, to], Pen::solid(color, 0.7 * unit));
}
