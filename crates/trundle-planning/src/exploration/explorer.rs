//! Exploration: the next viewpoint until no reachable frontier is left.
//!
//! Problem: an empty map and no goal. Idea: new space begins at the frontier, the border between free and unknown space \[Yamauchi97\]. The
//! robot drives to a viewpoint of a frontier, scans, and repeats until no frontier can be viewed. The next viewpoint has the smallest path
//! length minus the value of the frontier's length. It remains the target until the frontier has vanished or was viewed, which prevents
//! alternation. Cost: O(cells log cells) per choice.

use crate::exploration::config::ExploreConfig;
use crate::exploration::frontier::{Frontier, frontiers};
use crate::exploration::travel_distance::{TravelDistances, disc};
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Vector2, require_in};
use trundle_grid::{DistanceField, UnknownIs};

/// A pose from which a frontier can be viewed.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoint {
    /// Pose that faces the frontier's middle, map frame.
    pub pose: Pose2,
    /// The frontier to view.
    pub frontier: Frontier,
    /// Length of the path to the pose along the lattice, m.
    pub path_length: f64,
}

/// The next step of an exploration.
#[derive(Debug, Clone, PartialEq)]
pub enum Exploration {
    /// The next viewpoint.
    Next(Viewpoint),
    /// Every frontier that can be viewed has been viewed.
    Complete {
        /// Number of remaining frontiers: those without a viewpoint, and those that a view did not change.
        left: usize,
    },
}

/// Chooses viewpoints, and keeps the frontiers that were viewed.
#[derive(Debug, Clone)]
pub struct Explorer {
    config: ExploreConfig,
    radius: f64,
    /// Middles of the viewed frontiers, one entry per view.
    viewed: Vec<Vector2>,
    /// The middle of the current target frontier.
    current: Option<Vector2>,
}

/// Wanted clearance of a viewpoint beyond the robot's radius, m. A smaller clearance adds to the viewpoint's cost. Source: ours.
const VIEWPOINT_CLEARANCE_M: f64 = 0.25;
/// Cost of a metre of missing clearance, in metres of path. Source: ours.
const MISSING_CLEARANCE_COST: f64 = 3.0;

impl Explorer {
    /// An explorer for a robot that keeps `radius` m from obstacles, 0.01 to 5.
    ///
    /// # Errors
    /// When the radius or a number of the configuration is outside its range.
    pub fn new(config: ExploreConfig, radius: f64) -> Result<Self, Invalid> {
        let config = config.validated()?;
        require_in("radius of the explorer", radius, "m", 0.01, 5.0)?;
        Ok(Self { config, radius, viewed: Vec::new(), current: None })
    }

    /// The next viewpoint from `pose`, on the newest grid. The map's origin is the robot's start.
    pub fn next(&mut self, grid: &OccupancyGrid, pose: Pose2) -> Exploration {
        let all = frontiers(grid, self.config.min_frontier);
        let total = all.len();
        let field = DistanceField::up_to(2.0 * self.radius, grid, UnknownIs::Free);
        let travel = TravelDistances::from(grid, &field, pose.position(), self.radius);
        let clearance = DistanceField::up_to(self.radius + VIEWPOINT_CLEARANCE_M, grid, UnknownIs::Obstacle);
        let views = all.into_iter().filter(|frontier| self.is_open(frontier));
        let views: Vec<_> =
            views.filter_map(|frontier| self.view(grid, &travel, &clearance, frontier)).collect();
        let kept =
            self.current.and_then(|current| views.iter().find(|view| view.frontier.is_that_at(current)));
        let cost = |view: &Viewpoint| view.path_length - self.config.gain * view.frontier.length;
        let best = kept.or_else(|| views.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))).cloned();
        self.current = best.as_ref().map(|view| view.frontier.middle);
        best.map_or(Exploration::Complete { left: total }, Exploration::Next)
    }

    /// Marks a frontier as viewed from its viewpoint, or its viewpoint as unreachable.
    pub fn mark_viewed(&mut self, frontier: &Frontier) {
        self.viewed.push(frontier.middle);
        self.current = None;
    }

    fn is_open(&self, frontier: &Frontier) -> bool {
        let view_count = self.viewed.iter().filter(|&&middle| frontier.is_that_at(middle)).count();
        frontier.middle.norm() <= self.config.reach && view_count < self.config.looks as usize
    }

    /// The nearest cell by path length with a view of the frontier's middle. Missing clearance adds a cost: an obstacle observed from one
    /// side only may extend into a free cell. `clearance` is the distance to occupied or unknown cells.
    fn view(
        &self,
        grid: &OccupancyGrid,
        travel: &TravelDistances,
        clearance: &DistanceField,
        frontier: Frontier,
    ) -> Option<Viewpoint> {
        let geometry = grid.geometry();
        let standing = |cell: &CellIndex| grid.get(*cell) == Cell::Free;
        let near = disc(geometry, frontier.middle, self.config.view_distance).filter(standing);
        let missing = |cell| {
            (self.radius + VIEWPOINT_CLEARANCE_M - clearance.at_cell(cell)).clamp(0.0, VIEWPOINT_CLEARANCE_M)
        };
        let priced = |cell| {
            travel
                .length_to(cell)
                .map(|path_length| (path_length + MISSING_CLEARANCE_COST * missing(cell), path_length, cell))
        };
        let mut near: Vec<_> = near.filter_map(priced).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (_, path_length, cell) =
            near.into_iter().find(|&(.., cell)| is_visible(grid, geometry.center(cell), frontier.middle))?;
        let at = geometry.center(cell);
        let ahead = frontier.middle - at;
        let theta = if ahead.norm() > 0.0 { ahead.y.atan2(ahead.x) } else { 0.0 };
        Some(Viewpoint { pose: Pose2::new(at.x, at.y, theta), frontier, path_length })
    }
}

/// Whether no occupied cell is between two points.
fn is_visible(grid: &OccupancyGrid, from: Vector2, to: Vector2) -> bool {
    let steps = ((to - from).norm() / (0.5 * grid.geometry().resolution)).ceil().max(1.0) as usize;
    (0..=steps).all(|i| grid.at(from + (to - from) * (i as f64 / steps as f64)) != Cell::Occupied)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explorer() -> Explorer {
        let config = ExploreConfig { min_frontier: 0.3, ..ExploreConfig::default() };
        Explorer::new(config, 0.17).unwrap()
    }

    /// Two rooms; the right one is unknown behind an opening of 0.8 m.
    fn two_rooms() -> OccupancyGrid {
        let wall = "#".repeat(31) + "\n";
        let row = |door: char| format!("#{}{door}{}#\n", ".".repeat(18), "?".repeat(10));
        let rows: String = (0..16).map(|i| row(if (4..12).contains(&i) { '.' } else { '#' })).collect();
        OccupancyGrid::from_ascii(0.1, &(wall.clone() + &rows + &wall)).unwrap()
    }

    #[test]
    fn an_opening_is_viewed_and_an_unchanged_frontier_is_given_up() {
        let (grid, mut explorer) = (two_rooms(), explorer());
        let pose = Pose2::new(0.5, 0.9, 0.0);
        for _ in 0..2 {
            let Exploration::Next(view) = explorer.next(&grid, pose) else { panic!("no viewpoint") };
            assert!((view.frontier.middle - Vector2::new(1.95, 0.9)).norm() < 0.1, "{view:?}");
            assert!(view.pose.theta.abs() < 1.0 && view.pose.x < 1.9, "{view:?}");
            assert_eq!(explorer.next(&grid, pose), Exploration::Next(view.clone()), "the choice is kept");
            explorer.mark_viewed(&view.frontier);
        }
        assert_eq!(explorer.next(&grid, pose), Exploration::Complete { left: 1 });
    }

    #[test]
    fn a_corner_is_viewed_from_a_place_with_clearance() {
        // A wall from the left ends at x = 2 m; the space behind it on the left is unknown.
        let row = |y: usize| match y {
            0 | 39 => "#".repeat(40),
            21.. => "?".repeat(8) + &".".repeat(31) + "#",
            20 => "#".repeat(20) + &".".repeat(19) + "#",
            _ => "#".to_owned() + &".".repeat(38) + "#",
        };
        let rows: Vec<String> = (0..40).rev().map(row).collect();
        let grid = OccupancyGrid::from_ascii(0.1, &rows.join("\n")).unwrap();
        let config = ExploreConfig { view_distance: 3.0, ..ExploreConfig::default() };
        let mut explorer = Explorer::new(config, 0.17).unwrap();
        let Exploration::Next(view) = explorer.next(&grid, Pose2::new(1.6, 1.6, 0.0)) else {
            panic!("no viewpoint")
        };
        assert!(clearance_at(&view, &grid) > 0.37, "{view:?}");
        assert!((view.frontier.middle - Vector2::new(0.85, 3.0)).norm() < 0.2, "{view:?}");
    }

    #[test]
    fn at_the_edge_of_unknown_space_the_viewpoint_is_further_back() {
        let corridor = |width: usize| {
            let row = format!("#{}{}", ".".repeat(15), "?".repeat(14));
            let walls = "#".repeat(30);
            let rows = [vec![walls.clone()], vec![row; width], vec![walls]].concat();
            OccupancyGrid::from_ascii(0.1, &rows.join("\n")).unwrap()
        };
        let look = |grid: &OccupancyGrid, y: f64| match explorer().next(grid, Pose2::new(1.35, y, 0.0)) {
            Exploration::Next(view) => view,
            complete => panic!("{complete:?}"),
        };
        let wide = corridor(12);
        let view = look(&wide, 0.75);
        assert!(clearance_at(&view, &wide) > 0.37 && view.pose.x > 1.0, "{view:?}");
        // In a narrow corridor the viewpoint is near, and the missing clearance is not part of the path length.
        let view = look(&corridor(5), 0.35);
        assert!(view.path_length < 0.4, "{view:?}");
    }

    /// Distance of the viewpoint from occupied or unknown cells, m.
    fn clearance_at(view: &Viewpoint, grid: &OccupancyGrid) -> f64 {
        let cell = grid.geometry().cell_at(view.pose.position()).unwrap();
        DistanceField::from_grid(grid, UnknownIs::Obstacle).at_cell(cell)
    }

    #[test]
    fn a_known_room_is_complete() {
        let grid =
            OccupancyGrid::from_ascii(0.1, "######\n#....#\n#....#\n#....#\n#....#\n######\n").unwrap();
        assert_eq!(explorer().next(&grid, Pose2::new(0.3, 0.3, 0.0)), Exploration::Complete { left: 0 });
    }

    #[test]
    fn no_frontier_is_viewed_through_a_wall() {
        let mut grid = two_rooms();
        for row in 5..13 {
            grid.set(CellIndex { col: 10, row }, Cell::Occupied);
        }
        for row in [1, 2, 3, 4, 13, 14, 15, 16] {
            grid.set(CellIndex { col: 10, row }, Cell::Occupied);
        }
        let next = explorer().next(&grid, Pose2::new(0.5, 0.9, 0.0));
        assert_eq!(next, Exploration::Complete { left: 1 });
    }
}
