//! Exploration: where to look next until nothing that can be seen is unknown.
//!
//! Problem: an empty map and no goal. Idea: the border between free and unknown, the frontier \[Yamauchi97\], is where new
//! space is; drive to a place from which one is seen, look, and go on until no frontier is left that can be looked at. The
//! next one is the nearest by way, minus what its length is worth; it is kept until it is gone or reached, so that the robot
//! does not waver. Cost: O(cells log cells) a choice.

mod config;
mod frontier;
mod reach;

use crate::{DistanceField, UnknownIs};
pub use config::ExploreConfig;
pub use frontier::Frontier;
use frontier::frontiers;
use reach::{Reach, disc};
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Vector2, require_in};

/// Where to go to see something new.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoint {
    /// Where to stand, looking at the frontier's middle, map frame.
    pub pose: Pose2,
    /// What is to be seen.
    pub frontier: Frontier,
    /// The way there along the lattice, m.
    pub way: f64,
}

/// What is left to explore.
#[derive(Debug, Clone, PartialEq)]
pub enum Exploration {
    /// There is more to see from here.
    Look(Viewpoint),
    /// Every frontier that can be looked at has been.
    Complete {
        /// Frontiers that are left: those that nothing can be seen of, and those that a look did not change.
        left: usize,
    },
}

/// Chooses viewpoints, and remembers which it has looked from.
#[derive(Debug, Clone)]
pub struct Explorer {
    config: ExploreConfig,
    radius: f64,
    /// Middles of the frontiers that were looked at, one entry a look.
    looked: Vec<Vector2>,
    /// The middle of the frontier that is being looked for.
    current: Option<Vector2>,
}

/// It likes so much room around it where it looks, m.
const ROOM: f64 = 0.25;
/// What a metre of that room is worth, in metres of way.
const PRICE_OF_ROOM: f64 = 3.0;

impl Explorer {
    /// An explorer for a robot that keeps `radius` m from obstacles, 0.01 to 5.
    ///
    /// # Errors
    /// When the radius or a number of the configuration is outside its range.
    pub fn new(config: ExploreConfig, radius: f64) -> Result<Self, Invalid> {
        let config = config.validated()?;
        require_in("radius of the explorer", radius, "m", 0.01, 5.0)?;
        Ok(Self { config, radius, looked: Vec::new(), current: None })
    }

    /// Where to look next from `pose`, on the newest grid. The map's origin is where the robot started.
    pub fn next(&mut self, grid: &OccupancyGrid, pose: Pose2) -> Exploration {
        let all = frontiers(grid, self.config.least_frontier);
        let total = all.len();
        let field = DistanceField::up_to(2.0 * self.radius, grid, UnknownIs::Free);
        let reach = Reach::from(grid, &field, pose.position(), self.radius);
        let room = DistanceField::up_to(self.radius + ROOM, grid, UnknownIs::Obstacle);
        let views = all.into_iter().filter(|frontier| self.is_worth_it(frontier));
        let views: Vec<_> = views.filter_map(|frontier| self.view(grid, &reach, &room, frontier)).collect();
        let kept =
            self.current.and_then(|current| views.iter().find(|view| view.frontier.is_that_at(current)));
        let cost = |view: &Viewpoint| view.way - self.config.gain * view.frontier.length;
        let best = kept.or_else(|| views.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))).cloned();
        self.current = best.as_ref().map(|view| view.frontier.middle);
        best.map_or(Exploration::Complete { left: total }, Exploration::Look)
    }

    /// Says that the robot has looked at this frontier from its viewpoint, or could not get there.
    pub fn looked_at(&mut self, frontier: &Frontier) {
        self.looked.push(frontier.middle);
        self.current = None;
    }

    fn is_worth_it(&self, frontier: &Frontier) -> bool {
        let looks = self.looked.iter().filter(|&&middle| frontier.is_that_at(middle)).count();
        frontier.middle.norm() <= self.config.reach && looks < self.config.looks as usize
    }

    /// The place from which the frontier's middle is in sight that is nearest by way, but for a detour to where there is more room: a
    /// corner of which only one side was seen may stand out into a cell that looks free. `room` is to what is occupied or unknown.
    fn view(
        &self,
        grid: &OccupancyGrid,
        reach: &Reach,
        room: &DistanceField,
        frontier: Frontier,
    ) -> Option<Viewpoint> {
        let geometry = grid.geometry();
        let standing = |cell: &CellIndex| grid.get(*cell) == Cell::Free;
        let near = disc(geometry, frontier.middle, self.config.view_distance).filter(standing);
        let missing = |cell| (self.radius + ROOM - room.at_cell(cell)).clamp(0.0, ROOM);
        let priced = |cell| reach.way_to(cell).map(|way| (way + PRICE_OF_ROOM * missing(cell), way, cell));
        let mut near: Vec<_> = near.filter_map(priced).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (_, way, cell) =
            near.into_iter().find(|&(.., cell)| in_sight(grid, geometry.center(cell), frontier.middle))?;
        let at = geometry.center(cell);
        let ahead = frontier.middle - at;
        let theta = if ahead.norm() > 0.0 { ahead.y.atan2(ahead.x) } else { 0.0 };
        Some(Viewpoint { pose: Pose2::new(at.x, at.y, theta), frontier, way })
    }
}

/// Whether nothing occupied lies between two points.
fn in_sight(grid: &OccupancyGrid, from: Vector2, to: Vector2) -> bool {
    let steps = ((to - from).norm() / (0.5 * grid.geometry().resolution)).ceil().max(1.0) as usize;
    (0..=steps).all(|i| grid.at(from + (to - from) * (i as f64 / steps as f64)) != Cell::Occupied)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explorer() -> Explorer {
        let config = ExploreConfig { least_frontier: 0.3, ..ExploreConfig::default() };
        Explorer::new(config, 0.17).unwrap()
    }

    /// Two rooms of which the right one is unknown behind a door of 0.8 m.
    fn two_rooms() -> OccupancyGrid {
        let wall = "#".repeat(31) + "\n";
        let row = |door: char| format!("#{}{door}{}#\n", ".".repeat(18), "?".repeat(10));
        let rows: String = (0..16).map(|i| row(if (4..12).contains(&i) { '.' } else { '#' })).collect();
        OccupancyGrid::from_ascii(0.1, &(wall.clone() + &rows + &wall)).unwrap()
    }

    #[test]
    fn it_looks_through_the_door_and_leaves_alone_what_does_not_change() {
        let (grid, mut explorer) = (two_rooms(), explorer());
        let pose = Pose2::new(0.5, 0.9, 0.0);
        for _ in 0..2 {
            let Exploration::Look(view) = explorer.next(&grid, pose) else { panic!("nothing to see") };
            assert!((view.frontier.middle - Vector2::new(1.95, 0.9)).norm() < 0.1, "{view:?}");
            assert!(view.pose.theta.abs() < 1.0 && view.pose.x < 1.9, "{view:?}");
            assert_eq!(explorer.next(&grid, pose), Exploration::Look(view.clone()), "it does not waver");
            explorer.looked_at(&view.frontier);
        }
        assert_eq!(explorer.next(&grid, pose), Exploration::Complete { left: 1 });
    }

    #[test]
    fn it_looks_round_a_corner_from_where_there_is_room() {
        // A wall from the left ends at x = 2 m; what is behind it on the left is unknown.
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
        let Exploration::Look(view) = explorer.next(&grid, Pose2::new(1.6, 1.6, 0.0)) else {
            panic!("nothing to see")
        };
        assert!(room_at(&view, &grid) > 0.37, "{view:?}");
        assert!((view.frontier.middle - Vector2::new(0.85, 3.0)).norm() < 0.2, "{view:?}");
    }

    #[test]
    fn from_the_brink_of_the_unknown_it_steps_back_to_look() {
        let corridor = |width: usize| {
            let row = format!("#{}{}", ".".repeat(15), "?".repeat(14));
            let walls = "#".repeat(30);
            let rows = [vec![walls.clone()], vec![row; width], vec![walls]].concat();
            OccupancyGrid::from_ascii(0.1, &rows.join("\n")).unwrap()
        };
        let look = |grid: &OccupancyGrid, y: f64| match explorer().next(grid, Pose2::new(1.35, y, 0.0)) {
            Exploration::Look(view) => view,
            complete => panic!("{complete:?}"),
        };
        let wide = corridor(12);
        let view = look(&wide, 0.75);
        assert!(room_at(&view, &wide) > 0.37 && view.pose.x > 1.0, "{view:?}");
        // Where it is narrow everywhere it looks from there, and what it lacks is no part of the way.
        let view = look(&corridor(5), 0.35);
        assert!(view.way < 0.4, "{view:?}");
    }

    /// From where it looks to what is occupied or unknown, m.
    fn room_at(view: &Viewpoint, grid: &OccupancyGrid) -> f64 {
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
    fn nothing_is_looked_at_from_beyond_a_wall() {
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
