//! The map that scans are matched to: a given map where it is known, else the drawn one.

use crate::grid_mapper::GridMapper;
use trundle_core::{Cell, Vector2};
use trundle_grid::{GridCell, LogOddsGrid, SurfacePoints};

/// The map that scans are matched to.
///
/// Problem: a robot on a given map draws its scans at its estimated poses. If scans were matched to this drawing, an error of the pose would
/// be drawn, found again and confirmed, and the pose would drift along the given walls. Scans are therefore matched to the surfaces of the
/// given map where that map is known, and to drawn ones elsewhere.
#[derive(Debug, Clone, Copy)]
pub struct MatchedMap<'a> {
    drawn: &'a GridMapper,
    given: Option<&'a LogOddsGrid>,
}

impl<'a> From<&'a GridMapper> for MatchedMap<'a> {
    fn from(drawn: &'a GridMapper) -> Self {
        Self { drawn, given: None }
    }
}

impl<'a> MatchedMap<'a> {
    /// The drawn map over a given one, which the drawing began with.
    pub(crate) fn over(drawn: &'a GridMapper, given: &'a LogOddsGrid) -> Self {
        Self { drawn, given: Some(given) }
    }

    /// Whether a point (map frame, m) is in the known part of a given map.
    pub(crate) fn is_given(&self, point: Vector2) -> bool {
        self.given_class(GridCell::containing(point / self.resolution())) != Cell::Unknown
    }

    /// The surface points within `margin` m of the bounding box of `points` (map frame, m).
    pub(super) fn surface_points(&self, points: &[Vector2], margin: f64) -> Option<SurfacePoints> {
        SurfacePoints::around(|cell| self.surface(cell), self.resolution(), points, margin)
    }

    /// Whether a hit at a point (map frame, m) is on known ground: neither unknown, nor on an object that the given map lacks. What was drawn
    /// within `reach` m of a surface counts as an error of the pose, not as an object.
    pub(super) fn is_known(&self, point: Vector2, surfaces: &SurfacePoints, reach: f64) -> bool {
        let cell = GridCell::containing(point / self.resolution());
        let reach_cells = (reach / self.resolution()).ceil() as i32;
        match self.given_class(cell) {
            Cell::Unknown => self.drawn.evidence().log_odds(cell) != 0.0,
            Cell::Occupied => true,
            Cell::Free => {
                self.drawn_class(cell) != Cell::Occupied || surfaces.near(point, reach_cells).next().is_some()
            }
        }
    }

    /// The surface point of a cell, from its lower-left corner, in cells.
    fn surface(&self, cell: GridCell) -> Option<Vector2> {
        let hit = |map: &LogOddsGrid| map.get(cell).and_then(|evidence| evidence.hit());
        match self.given_class(cell) {
            Cell::Unknown => hit(self.drawn.evidence()).filter(|_| self.drawn_class(cell) == Cell::Occupied),
            Cell::Occupied => self.given.and_then(hit),
            Cell::Free => None,
        }
    }

    fn given_class(&self, cell: GridCell) -> Cell {
        self.given.map_or(Cell::Unknown, |given| self.drawn.thresholds().classify(given.log_odds(cell)))
    }

    fn drawn_class(&self, cell: GridCell) -> Cell {
        self.drawn.thresholds().classify(self.drawn.evidence().log_odds(cell))
    }

    fn resolution(&self) -> f64 {
        self.drawn.config().resolution
    }
}
