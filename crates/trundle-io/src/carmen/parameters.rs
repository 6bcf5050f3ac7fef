//! The parameters of a CARMEN log that describe the front laser.

use super::line::Line;

/// Parameters of the front laser, the last ones of the log.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parameters {
    /// Distance of the front laser ahead of the base, m.
    pub offset: f64,
    /// The front laser's field of view, rad, for lines without one.
    pub field_of_view: Option<f64>,
    /// The angle between its beams, rad, likewise.
    pub resolution: Option<f64>,
}

impl Parameters {
    /// Takes the parameter of a line; ignores other lines.
    pub(super) fn take(&mut self, line: &Line) {
        match line {
            Line::Offset(metres) => self.offset = *metres,
            Line::FieldOfView(angle) => self.field_of_view = Some(*angle),
            Line::Resolution(angle) => self.resolution = Some(*angle),
            _ => {}
        }
    }
}
