//! Styles of lines, dots and poses.

use crate::color::Color;
use trundle_core::Footprint;

/// Style of a polyline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineStyle {
    /// Colour of the line.
    pub color: Color,
    /// Width in dots of the picture's lettering (a capital letter is 7 high). Default 1.5.
    pub width: f64,
    /// Dashes instead of a solid line.
    pub dashed: bool,
    /// A white border, which keeps the line visible over walls.
    pub rimmed: bool,
}

impl LineStyle {
    /// A solid, rimmed line.
    pub fn solid(color: Color) -> Self {
        Self { color, width: 1.5, dashed: false, rimmed: true }
    }

    /// A dashed line.
    pub fn dashed(color: Color) -> Self {
        Self { dashed: true, ..Self::solid(color) }
    }

    /// The same line, `width` dots wide.
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// The same line without a border.
    pub fn plain(self) -> Self {
        Self { rimmed: false, ..self }
    }
}

/// Style of dots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DotStyle {
    /// Colour of the dots; its alpha makes crowds readable.
    pub color: Color,
    /// Radius in dots of the picture's lettering.
    pub radius: f64,
    /// Circles with a white inside instead of filled dots.
    pub hollow: bool,
}

impl DotStyle {
    /// Small translucent dots, made for thousands.
    pub fn crowd(color: Color) -> Self {
        Self { color: color.alpha(90), radius: 0.9, hollow: false }
    }

    /// Circles, for a few points.
    pub fn circles(color: Color) -> Self {
        Self { color, radius: 2.6, hollow: true }
    }

    /// The same dots of another radius.
    pub fn radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }
}

/// Style of a pose: a wedge along its heading, optionally with the robot's outline.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseStyle {
    /// Colour of the wedge.
    pub color: Color,
    /// The robot's outline, drawn to scale.
    pub footprint: Option<Footprint>,
    /// Whether the picture shows the pose's label.
    pub named: bool,
}

impl PoseStyle {
    /// A wedge with its name.
    pub fn named(color: Color) -> Self {
        Self { color, footprint: None, named: true }
    }

    /// The same wedge without its name.
    pub fn nameless(self) -> Self {
        Self { named: false, ..self }
    }

    /// The same pose with the robot's outline.
    pub fn with_footprint(self, footprint: Footprint) -> Self {
        Self { footprint: Some(footprint), ..self }
    }
}
