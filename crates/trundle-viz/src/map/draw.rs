//! Drawing of lines, dots, poses, outlines and areas on a map.

use super::style::{DotStyle, LineStyle, PoseStyle};
use super::view::View;
use crate::canvas::{Canvas, Pen};
use crate::clip::{Px, visible_runs};
use crate::color::Color;
use crate::text::{TextStyle, cap_height, text_width};
use crate::wedge::wedge;
use trundle_core::{Footprint, Pose2, Vector2};

pub(super) fn draw_line(canvas: &mut Canvas, view: &View, points: &[Vector2], style: &LineStyle) {
    let unit = view.unit as f64;
    let line = || points.iter().map(|p| view.px(*p));
    if style.rimmed {
        canvas.polyline(line(), Pen::solid(Color::WHITE.alpha(190), (style.width + 1.4) * unit));
    }
    let dash = style.dashed.then_some(3.0 * style.width * unit);
    canvas.polyline(line(), Pen { color: style.color, width: style.width * unit, dash });
}

pub(super) fn draw_dot(canvas: &mut Canvas, center: Px, style: &DotStyle, unit: f64) {
    let radius = style.radius * unit;
    if style.hollow {
        canvas.dot(center, radius, Color::WHITE.alpha(style.color.a));
        canvas.ring(center, radius, 1.1 * unit, style.color);
    } else {
        canvas.dot(center, radius, style.color);
    }
}

/// A wedge along the heading with the size of the robot, but with a visible minimum size. Its name avoids `lines` if possible.
pub(super) fn draw_pose(
    canvas: &mut Canvas,
    view: &View,
    pose: Pose2,
    style: &PoseStyle,
    label: &str,
    lines: &[Vec<Px>],
) {
    if !pose.is_finite() {
        return;
    }
    let (unit, center) = (view.unit as f64, view.px(pose.position()));
    let body = style.footprint.as_ref().map_or(0.0, |f| view.length_px(f.circumscribed_radius()));
    let tip = (0.8 * body).clamp(7.0 * unit, 16.0 * unit);
    if let Some(footprint) = &style.footprint {
        let edge = outline(view, pose, footprint);
        canvas.polygon(&edge, style.color.alpha(45));
        canvas.polyline(edge, Pen::solid(style.color, unit));
    }
    canvas.polygon(&wedge(center, tip + 1.8 * unit, -pose.theta), Color::WHITE);
    canvas.polygon(&wedge(center, tip, -pose.theta), style.color);
    if style.named {
        let distance = tip.max(body) + 3.0 * unit;
        let far = 4.0 * canvas.width().max(canvas.height()) as f64;
        if center.0.abs() < far && center.1.abs() < far && distance < far {
            let (left, top) = place_of_name(canvas, view.unit, center, distance, label, lines);
            let style = TextStyle { scale: view.unit, color: style.color, halo: Some(Color::WHITE) };
            canvas.text(left, top, label, style);
        }
    }
}

/// The upper left corner of a name next to a place: right, left, above or below, whichever the fewest lines cross, within the picture.
fn place_of_name(
    canvas: &Canvas,
    unit: i64,
    center: Px,
    distance: f64,
    label: &str,
    lines: &[Vec<Px>],
) -> (i64, i64) {
    let (width, height) = (text_width(label, unit), cap_height(unit));
    let (x, y, reach) = (center.0 as i64, center.1 as i64, distance as i64);
    let places = [
        (x + reach, y - height / 2),
        (x - reach - width, y - height / 2),
        (x - width / 2, y - reach - height),
        (x - width / 2, y + reach),
    ];
    let size = (width as f64, height as f64);
    let crossed = |(left, top): (i64, i64)| -> i64 {
        let beside = |p: &Px| (p.0 - left as f64, p.1 - top as f64);
        let within = |line: &Vec<Px>| visible_runs(line.iter().map(beside), size, unit as f64);
        lines.iter().flat_map(within).map(|run| run.len() as i64).sum()
    };
    let outside = |(left, top): (i64, i64)| {
        left < 0 || top < 0 || left + width >= canvas.width() || top + height >= canvas.height()
    };
    let cost = |place: &(i64, i64)| (outside(*place), crossed(*place));
    places.into_iter().min_by_key(cost).unwrap_or(places[0])
}

/// The robot's outline, with a stroke from its middle along the heading.
pub(super) fn draw_outline(
    canvas: &mut Canvas,
    view: &View,
    pose: Pose2,
    footprint: &Footprint,
    color: Color,
) {
    let pen = Pen::solid(color, 1.3 * view.unit as f64);
    canvas.polyline(outline(view, pose, footprint), pen);
    let tip = pose.position() + pose.direction() * front(footprint);
    canvas.polyline([view.px(pose.position()), view.px(tip)], pen);
}

/// A filled polygon with a firm edge.
pub(super) fn draw_area(canvas: &mut Canvas, view: &View, corners: &[Vector2], color: Color) {
    let edge: Vec<Px> = corners.iter().chain(corners.first()).map(|corner| view.px(*corner)).collect();
    canvas.polygon(&edge, color);
    canvas.polyline(edge, Pen::solid(Color::OCCUPIED, view.unit as f64));
}

/// One of many overlapping outlines.
pub(super) fn draw_swept(canvas: &mut Canvas, view: &View, pose: Pose2, footprint: &Footprint, color: Color) {
    let edge = outline(view, pose, footprint);
    canvas.polygon(&edge, color.alpha(16));
    canvas.polyline(edge, Pen::solid(color.alpha(70), 0.5 * view.unit as f64));
}

/// Distance from the axle to the outline straight ahead, m; the maximum along x if the axle is outside.
fn front(footprint: &Footprint) -> f64 {
    let corners = match footprint {
        Footprint::Disc { radius } => return *radius,
        Footprint::Polygon { corners } => corners,
    };
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossings = sides.filter(|(a, b)| (a.y <= 0.0) != (b.y <= 0.0));
    let ahead = crossings.map(|(a, b)| a.x + (b.x - a.x) * a.y / (a.y - b.y));
    ahead.max_by(f64::total_cmp).unwrap_or_else(|| corners.iter().map(|c| c.x).fold(0.0, f64::max))
}

/// The robot's outline at a pose, closed.
fn outline(view: &View, pose: Pose2, footprint: &Footprint) -> Vec<Px> {
    const SIDES: usize = 72;
    let mut corners: Vec<Vector2> = match footprint {
        Footprint::Disc { radius } => (0..SIDES)
            .map(|i| std::f64::consts::TAU * i as f64 / SIDES as f64)
            .map(|angle| Vector2::new(angle.cos(), angle.sin()) * *radius)
            .collect(),
        Footprint::Polygon { corners } => corners.clone(),
    };
    corners.extend(corners.first().copied());
    corners.into_iter().map(|corner| view.px(pose.transform(corner))).collect()
}
