use super::style::{DotStyle, LineStyle, PoseStyle};
use super::view::View;
use crate::canvas::{Canvas, Pen};
use crate::clip::Px;
use crate::color::Color;
use crate::legend::{LegendItem, Mark, wedge};
use crate::text::{TextStyle, cap_height, text_width};
use trundle_core::{Beam, Footprint, Pose2, Scan, Vector2};

/// Something laid over the map.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    pub label: String,
    pub shape: Shape,
}

#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Line { points: Vec<Vector2>, style: LineStyle },
    Dots { points: Vec<Vector2>, style: DotStyle },
    Band { points: Vec<Vector2>, radius: f64, color: Color },
    Pose { pose: Pose2, style: PoseStyle },
    Outlines { poses: Vec<Pose2>, footprint: Footprint, color: Color },
    Scan { seen: Vec<Vector2>, hits: Vec<Vector2>, color: Color },
}

impl Shape {
    /// A scan taken at `map_from_base`: the area it found free, and its hits.
    pub(crate) fn scan(map_from_base: Pose2, scan: &Scan, color: Color) -> Self {
        let (mut seen, mut hits) = (Vec::new(), Vec::new());
        for (i, beam) in scan.beams().iter().enumerate() {
            let (sin, cos) = scan.angle(i).sin_cos();
            let end = |range: f64| map_from_base.transform(scan.origin() + Vector2::new(cos, sin) * range);
            match *beam {
                Beam::Hit { range } => {
                    hits.push(end(range));
                    seen.push(end(range));
                }
                Beam::Free { range } => seen.push(end(range)),
                Beam::Unseen => seen.push(end(0.0)),
            }
        }
        seen.push(map_from_base.transform(scan.origin()));
        Self::Scan { seen, hits, color }
    }
}

impl Layer {
    /// The points that the picture has to hold. Landmarks and scans reach beyond what anybody wants to see.
    pub(crate) fn anchors(&self) -> Vec<Vector2> {
        match &self.shape {
            Shape::Line { points, .. } => points.clone(),
            Shape::Band { points, radius, .. } => {
                let reach = Vector2::new(*radius, *radius);
                points.iter().flat_map(|p| [p - reach, p + reach]).collect()
            }
            Shape::Pose { pose, style } => {
                let radius = style.footprint.as_ref().map_or(0.0, Footprint::circumscribed_radius);
                let reach = Vector2::new(radius, radius);
                vec![pose.position() - reach, pose.position() + reach]
            }
            Shape::Outlines { poses, .. } => poses.iter().map(Pose2::position).collect(),
            Shape::Dots { .. } | Shape::Scan { .. } => Vec::new(),
        }
    }

    /// The points that the picture shows when there is nothing else.
    pub(crate) fn strays(&self) -> Vec<Vector2> {
        match &self.shape {
            Shape::Dots { points, .. } => points.clone(),
            Shape::Scan { seen, .. } => seen.clone(),
            _ => Vec::new(),
        }
    }

    /// Its line in the legend; none when there is nothing to see.
    pub(crate) fn legend(&self) -> Option<LegendItem> {
        let finite = |points: &[Vector2]| points.iter().any(|p| p.x.is_finite() && p.y.is_finite());
        let (shown, color, mark) = match &self.shape {
            Shape::Line { points, style } => {
                (finite(points), style.color, if style.dashed { Mark::Dashes } else { Mark::Line })
            }
            Shape::Dots { points, style } => {
                (finite(points), style.color, if style.hollow { Mark::Ring } else { Mark::Dot })
            }
            Shape::Band { points, color, .. } => (finite(points), *color, Mark::Band),
            Shape::Pose { pose, style } => (pose.is_finite(), style.color, Mark::Wedge),
            Shape::Outlines { poses, color, .. } => (poses.iter().any(Pose2::is_finite), *color, Mark::Ring),
            Shape::Scan { hits, color, .. } => (finite(hits), *color, Mark::Dot),
        };
        (shown && !self.label.is_empty()).then(|| LegendItem::new(self.label.clone(), color, mark))
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, view: &View) {
        let unit = view.unit() as f64;
        match &self.shape {
            Shape::Line { points, style } => draw_line(canvas, view, points, style),
            Shape::Dots { points, style } => {
                points.iter().for_each(|p| draw_dot(canvas, view.px(*p), style, unit));
            }
            Shape::Band { points, radius, color } => {
                let pen = Pen::solid(*color, view.length_px(2.0 * radius));
                canvas.polyline(points.iter().map(|p| view.px(*p)), pen);
            }
            Shape::Pose { pose, style } => draw_pose(canvas, view, *pose, style, &self.label),
            Shape::Outlines { poses, footprint, color } => {
                for pose in poses {
                    canvas.polyline(outline(view, *pose, footprint), Pen::solid(*color, unit.max(1.0)));
                }
            }
            Shape::Scan { seen, hits, color } => {
                let area: Vec<Px> = seen.iter().map(|p| view.px(*p)).collect();
                canvas.polygon(&area, color.alpha(color.a / 6));
                hits.iter().for_each(|p| canvas.dot(view.px(*p), 1.1 * unit, *color));
            }
        }
    }
}

fn draw_line(canvas: &mut Canvas, view: &View, points: &[Vector2], style: &LineStyle) {
    let unit = view.unit() as f64;
    let line = || points.iter().map(|p| view.px(*p));
    if style.rimmed {
        canvas.polyline(line(), Pen::solid(Color::WHITE.alpha(190), (style.width + 1.4) * unit));
    }
    let dash = style.dashed.then_some(3.0 * style.width * unit);
    canvas.polyline(line(), Pen { color: style.color, width: style.width * unit, dash });
}

fn draw_dot(canvas: &mut Canvas, center: Px, style: &DotStyle, unit: f64) {
    let radius = style.radius * unit;
    if style.hollow {
        canvas.dot(center, radius, Color::WHITE.alpha(style.color.a));
        canvas.ring(center, radius, 1.1 * unit, style.color);
    } else {
        canvas.dot(center, radius, style.color);
    }
}

/// A wedge along the heading, as large as the robot but never too small to see.
fn draw_pose(canvas: &mut Canvas, view: &View, pose: Pose2, style: &PoseStyle, label: &str) {
    if !pose.is_finite() {
        return;
    }
    let (unit, center) = (view.unit() as f64, view.px(pose.position()));
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
        draw_name(canvas, view.unit(), center, tip.max(body) + 3.0 * unit, label, style.color);
    }
}

/// A name beside a place: to its right, or to its left where the picture ends.
fn draw_name(canvas: &mut Canvas, unit: i64, center: Px, distance: f64, label: &str, color: Color) {
    let far = 4.0 * canvas.width().max(canvas.height()) as f64;
    if !(center.0.abs() < far && center.1.abs() < far && distance < far) {
        return;
    }
    let (x, reach, width) = (center.0 as i64, distance as i64, text_width(label, unit));
    let left = if x + reach + width < canvas.width() { x + reach } else { x - reach - width };
    let top = center.1 as i64 - cap_height(unit) / 2;
    let style = TextStyle { scale: unit, color, halo: Some(Color::WHITE) };
    canvas.text(left, top, label, style);
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
