//! Rooms and scans for tests.

use trundle_core::{Beam, Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// An axis-parallel box: its lower and its upper corner \[m\].
pub(crate) type Block = [Vector2; 2];

/// A room of 4 x 3 m around the origin, symmetric by half a turn, with boxes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Room {
    pub(crate) blocks: Vec<Block>,
}

const HALF: Vector2 = Vector2::new(2.0, 1.5);
/// Half of the camera's view, deg. Source: ours.
const HALF_VIEW_DEG: i32 = 35;

impl Room {
    /// The room with a box in one corner.
    pub(crate) fn with_corner_box() -> Self {
        Self { blocks: vec![[Vector2::new(1.2, 0.7), HALF]] }
    }

    /// This room with a person of 0.4 m at a point.
    pub(crate) fn with_person(mut self, at: Vector2) -> Self {
        let half = Vector2::new(0.2, 0.2);
        self.blocks.push([at - half, at + half]);
        self
    }

    /// The room's map, in cells of 5 cm; unknown outside.
    pub(crate) fn map(&self) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::new(-2.5, -2.0), 100, 80).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Unknown);
        for k in 0..geometry.len() {
            let cell: CellIndex = geometry.cell(k);
            let at = geometry.center(cell);
            let outside = (at.x.abs() - HALF.x).max(at.y.abs() - HALF.y);
            if outside < 0.0 && !self.is_in_block(at) {
                grid.set(cell, Cell::Free);
            } else if outside < 0.1 {
                grid.set(cell, Cell::Occupied);
            }
        }
        grid
    }

    /// The camera's scan from a pose.
    pub(crate) fn scan(&self, at: Pose2, time: f64) -> Scan {
        let beam = |i: i32| Beam::Hit { range: self.range(at, f64::from(i).to_radians()) };
        let beams = (-HALF_VIEW_DEG..=HALF_VIEW_DEG).map(beam).collect();
        let first = f64::from(-HALF_VIEW_DEG).to_radians();
        Scan::new(Stamp::default().after(time), Vector2::zeros(), first, 1_f64.to_radians(), beams).unwrap()
    }

    fn range(&self, at: Pose2, bearing: f64) -> f64 {
        let direction = Vector2::new((at.theta + bearing).cos(), (at.theta + bearing).sin());
        let is_hit = |range: &f64| {
            let point = at.position() + direction * *range;
            point.x.abs() > HALF.x || point.y.abs() > HALF.y || self.is_in_block(point)
        };
        (0..1200).map(|i| 0.005 * f64::from(i)).find(is_hit).unwrap_or(6.0)
    }

    fn is_in_block(&self, at: Vector2) -> bool {
        self.blocks.iter().any(|[low, high]| at >= *low && at <= *high)
    }
}
