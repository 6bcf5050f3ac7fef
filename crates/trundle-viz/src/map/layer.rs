//! The layers that are drawn over a map.

use super::arrow::draw_arrow;
use super::badge::draw_badges;
use super::draw::{draw_area, draw_dot, draw_line, draw_outline, draw_pose, draw_swept};
use super::shade::Shade;
use super::style::{DotStyle, LineStyle, PoseStyle};
use super::view::View;
use crate::canvas::{Canvas, Pen};
use crate::clip::Px;
use crate::color::Color;
use crate::legend::{LegendItem, Mark};
use trundle_core::{Beam, Footprint, Pose2, Scan, Vector2};

/// A layer over the map.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    pub label: String,
    pub shape: Shape,
}

#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Line { points: Vec<Vector2>, style: LineStyle },
    Arrow { points: Vec<Vector2>, style: LineStyle },
    Badges { badges: Vec<(String, Vector2)>, color: Color },
    Dots { points: Vec<Vector2>, style: DotStyle },
    Band { points: Vec<Vector2>, radius: f64, color: Color },
    Pose { pose: Pose2, style: PoseStyle },
    Outlines { poses: Vec<Pose2>, footprint: Footprint, color: Color },
    Area { corners: Vec<Vector2>, color: Color },
    Swept { poses: Vec<Pose2>, footprint: Footprint, color: Color },
    Scan { seen: Vec<Vector2>, hits: Vec<Vector2>, color: Color },
    Shade(Shade),
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
    /// The points that the picture has to hold. Landmarks and scans, which reach far, are not among them.
    pub(crate) fn anchors(&self) -> Vec<Vector2> {
        match &self.shape {
            Shape::Line { points, .. } | Shape::Arrow { points, .. } => points.clone(),
            Shape::Band { points, radius, .. } => {
                let reach = Vector2::new(*radius, *radius);
                points.iter().flat_map(|p| [p - reach, p + reach]).collect()
            }
            Shape::Pose { pose, style } => {
                let radius = style.footprint.as_ref().map_or(0.0, Footprint::circumscribed_radius);
                let reach = Vector2::new(radius, radius);
                vec![pose.position() - reach, pose.position() + reach]
            }
            Shape::Outlines { poses, .. } | Shape::Swept { poses, .. } => {
                poses.iter().map(Pose2::position).collect()
            }
            Shape::Area { corners, .. } => corners.clone(),
            Shape::Badges { badges, .. } => badges.iter().map(|(_, p)| *p).collect(),
            Shape::Dots { .. } | Shape::Scan { .. } | Shape::Shade(_) => Vec::new(),
        }
    }

    /// The points that the picture shows in the absence of other content.
    pub(crate) fn strays(&self) -> Vec<Vector2> {
        match &self.shape {
            Shape::Dots { points, .. } => points.clone(),
            Shape::Scan { seen, .. } => seen.clone(),
            _ => Vec::new(),
        }
    }

    /// The layer's line in the legend. `None` for an empty layer.
    pub(crate) fn legend(&self) -> Option<LegendItem> {
        let finite = |points: &[Vector2]| points.iter().any(|p| p.x.is_finite() && p.y.is_finite());
        let (shown, color, mark) = match &self.shape {
            Shape::Line { points, style } => {
                (finite(points), style.color, if style.dashed { Mark::Dashes } else { Mark::Line })
            }
            Shape::Arrow { points, style } => (finite(points), style.color, Mark::Arrow),
            Shape::Badges { badges, color } => (!badges.is_empty(), *color, Mark::Badge),
            Shape::Dots { points, style } => {
                (finite(points), style.color, if style.hollow { Mark::Ring } else { Mark::Dot })
            }
            Shape::Band { points, color, .. } => (finite(points), *color, Mark::Band),
            Shape::Pose { pose, style } => (pose.is_finite(), style.color, Mark::Wedge),
            Shape::Outlines { poses, color, .. } => {
                (poses.iter().any(Pose2::is_finite), *color, Mark::Outline)
            }
            Shape::Area { corners, color } => (finite(corners), *color, Mark::Cell),
            Shape::Swept { poses, color, .. } => {
                (poses.iter().any(Pose2::is_finite), color.alpha(110), Mark::Band)
            }
            Shape::Scan { hits, color, .. } => (finite(hits), *color, Mark::Dot),
            Shape::Shade(shade) => (shade.is_visible(), shade.color(), Mark::Band),
        };
        (shown && !self.label.is_empty()).then(|| LegendItem::new(self.label.clone(), color, mark))
    }

    /// Points of the layer's line in a picture; empty for other layers.
    pub(crate) fn line(&self, view: &View) -> Vec<Px> {
        match &self.shape {
            Shape::Line { points, .. } => points.iter().map(|p| view.px(*p)).collect(),
            _ => Vec::new(),
        }
    }

    /// Draws the layer over a picture; names avoid `lines` if possible.
    pub(crate) fn draw(&self, canvas: &mut Canvas, view: &View, lines: &[Vec<Px>]) {
        let unit = view.unit as f64;
        match &self.shape {
            Shape::Line { points, style } => draw_line(canvas, view, points, style),
            Shape::Arrow { points, style } => draw_arrow(canvas, view, points, style),
            Shape::Badges { badges, color } => draw_badges(canvas, view, badges, *color),
            Shape::Dots { points, style } => {
                points.iter().for_each(|p| draw_dot(canvas, view.px(*p), style, unit));
            }
            Shape::Band { points, radius, color } => {
                let pen = Pen::solid(*color, view.length_px(2.0 * radius));
                canvas.polyline(points.iter().map(|p| view.px(*p)), pen);
            }
            Shape::Pose { pose, style } => draw_pose(canvas, view, *pose, style, &self.label, lines),
            Shape::Outlines { poses, footprint, color } => {
                poses.iter().for_each(|pose| draw_outline(canvas, view, *pose, footprint, *color));
            }
            Shape::Area { corners, color } => draw_area(canvas, view, corners, *color),
            Shape::Swept { poses, footprint, color } => {
                poses.iter().for_each(|pose| draw_swept(canvas, view, *pose, footprint, *color));
            }
            Shape::Shade(shade) => shade.draw(canvas, view),
            Shape::Scan { seen, hits, color } => {
                let area: Vec<Px> = seen.iter().map(|p| view.px(*p)).collect();
                canvas.polygon(&area, color.alpha(color.a / 6));
                hits.iter().for_each(|p| canvas.dot(view.px(*p), 1.1 * unit, *color));
            }
        }
    }
}
