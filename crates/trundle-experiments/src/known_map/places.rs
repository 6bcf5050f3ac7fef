//! Places drawn from a seed: their map, what has changed since, start and goal.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2};

/// Side of a cell of the maps \[m\]. Source: ours, as in MRPB 1.0.
const CELL_M: f64 = 0.05;
/// Width of the solid ground around a place \[m\]. Source: ours.
const MARGIN_M: f64 = 0.5;
/// Distance of start and goal from the ends of a hall \[m\]: the robot's radius and some room. Source: ours.
const END_M: f64 = 0.7;
/// Number of rows and columns of a maze. Source: ours.
const MAZE_SIDE: usize = 8;
/// Width of the walls of a maze \[m\]. Source: ours.
const MAZE_WALL_M: f64 = 0.1;
/// Number of pieces of furniture of a room that stay. Source: ours.
const STAYING_PIECES: usize = 4;
/// Number of pieces of furniture of a room that are moved. Source: ours.
const MOVED_PIECES: usize = 3;
/// Smallest distance between two pieces of furniture, and from start and goal \[m\]: the robot's diameter and some room. Source: ours.
const PASSAGE_M: f64 = 0.8;

/// A kind of place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// 20 to 60 m long, 0.8 to 1.5 m wide, with at most three niches (doors).
    Hall,
    /// 8 x 8 fields of 1.0 to 1.4 m, one way between any two.
    Maze,
    /// A furnished room, a part of whose furniture was moved after the map was made.
    ChangedRoom,
}

impl Place {
    pub(super) const ALL: [Self; 3] = [Self::Hall, Self::Maze, Self::ChangedRoom];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Hall => "hall",
            Self::Maze => "maze",
            Self::ChangedRoom => "changed room",
        }
    }
}

/// A rectangle, world frame: lowest and highest corner, m.
type Area = (Vector2, Vector2);

/// A course through a place of a seed.
#[derive(Debug, Clone)]
pub(super) struct Course {
    pub(super) place: Place,
    pub(super) seed: u64,
    /// Start, world frame.
    pub(super) start: Pose2,
    /// Goal, world frame.
    pub(super) goal: Pose2,
    /// Extent of the place, m.
    size: Vector2,
    /// Free floor.
    floor: Vec<Area>,
    /// Solid parts of the floor, in the map and in the world.
    fixed: Vec<Area>,
    /// Solid parts in the map alone.
    before: Vec<Area>,
    /// Solid parts in the world alone.
    after: Vec<Area>,
}

impl Course {
    /// The course of a place and a seed.
    pub(super) fn new(place: Place, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        match place {
            Place::Hall => hall(seed, &mut rng),
            Place::Maze => maze(seed, &mut rng),
            Place::ChangedRoom => changed_room(seed, &mut rng),
        }
    }

    pub(super) fn name(&self) -> String {
        format!("{}, seed {}", self.place.name(), self.seed)
    }

    /// The map that the robot is given, world frame.
    ///
    /// # Errors
    /// When the extent is outside its range.
    pub(super) fn map(&self) -> Result<OccupancyGrid, Invalid> {
        self.drawn(&self.before)
    }

    /// The place at the time of the drive, world frame.
    ///
    /// # Errors
    /// As [`Course::map`].
    pub(super) fn world(&self) -> Result<OccupancyGrid, Invalid> {
        self.drawn(&self.after)
    }

    fn drawn(&self, more: &[Area]) -> Result<OccupancyGrid, Invalid> {
        let cells = |length: f64| ((length + 2.0 * MARGIN_M) / CELL_M).ceil() as usize;
        let (cols, rows) = (cells(self.size.x), cells(self.size.y));
        let geometry = GridGeometry::new(CELL_M, Vector2::repeat(-MARGIN_M), cols, rows)?;
        let mut grid = OccupancyGrid::filled(geometry, Cell::Occupied);
        let is_in = |areas: &[Area], at: Vector2| {
            areas.iter().any(|(low, high)| low.x <= at.x && at.x <= high.x && low.y <= at.y && at.y <= high.y)
        };
        for cell in (0..geometry.len()).map(|i| geometry.cell(i)) {
            let at = geometry.center(cell);
            if is_in(&self.floor, at) && !is_in(&self.fixed, at) && !is_in(more, at) {
                grid.set(cell, Cell::Free);
            }
        }
        Ok(grid)
    }
}

fn area(x: f64, y: f64, width: f64, height: f64) -> Area {
    (Vector2::new(x, y), Vector2::new(x + width, y + height))
}

fn hall(seed: u64, rng: &mut ChaCha8Rng) -> Course {
    let (length, width) = (rng.random_range(20.0..60.0), rng.random_range(0.8..1.5));
    let reach = 2.0;
    let mut floor = vec![area(0.0, reach, length, width)];
    for _ in 0..rng.random_range(0..=3) {
        let (x, depth) = (rng.random_range(2.0..length - 3.0), rng.random_range(0.1..reach));
        let y = if rng.random_bool(0.5) { reach + width } else { reach - depth };
        floor.push(area(x, y, 0.9, depth));
    }
    let middle = reach + width / 2.0;
    Course {
        place: Place::Hall,
        seed,
        start: Pose2::new(END_M, middle, 0.0),
        goal: Pose2::new(length * rng.random_range(0.6..1.0) - END_M, middle, 0.0),
        size: Vector2::new(length, 2.0 * reach + width),
        floor,
        fixed: Vec::new(),
        before: Vec::new(),
        after: Vec::new(),
    }
}

/// A maze by depth-first search.
fn maze(seed: u64, rng: &mut ChaCha8Rng) -> Course {
    let field = rng.random_range(1.0..1.4);
    let room = field - MAZE_WALL_M;
    let at = |i: usize| i as f64 * field + MAZE_WALL_M / 2.0;
    let (mut floor, mut path, mut is_open) = (Vec::new(), vec![(0, 0)], [[false; MAZE_SIDE]; MAZE_SIDE]);
    is_open[0][0] = true;
    while let Some(&(x, y)) = path.last() {
        floor.push(area(at(x), at(y), room, room));
        let beside =
            [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().filter_map(|(right, up): (isize, isize)| {
                let (x, y) = (x.checked_add_signed(right)?, y.checked_add_signed(up)?);
                (x < MAZE_SIDE && y < MAZE_SIDE && !is_open[y][x]).then_some((x, y))
            });
        let beside: Vec<(usize, usize)> = beside.collect();
        if beside.is_empty() {
            path.pop();
            continue;
        }
        let (nx, ny) = beside[rng.random_range(0..beside.len())];
        is_open[ny][nx] = true;
        let (width, height) = (at(x.max(nx)) + room - at(x.min(nx)), at(y.max(ny)) + room - at(y.min(ny)));
        floor.push(area(at(x.min(nx)), at(y.min(ny)), width, height));
        path.push((nx, ny));
    }
    let middle = |i: usize| at(i) + room / 2.0;
    let size = Vector2::repeat(field * MAZE_SIDE as f64);
    Course {
        place: Place::Maze,
        seed,
        start: Pose2::new(middle(0), middle(0), 0.0),
        goal: Pose2::new(middle(MAZE_SIDE - 1), middle(MAZE_SIDE - 1), 0.0),
        size,
        floor,
        fixed: Vec::new(),
        before: Vec::new(),
        after: Vec::new(),
    }
}

fn changed_room(seed: u64, rng: &mut ChaCha8Rng) -> Course {
    let size = Vector2::new(rng.random_range(6.0..9.0), rng.random_range(5.0..7.0));
    let (start, goal) = (Pose2::new(END_M, END_M, 0.0), Pose2::new(size.x - END_M, size.y - END_M, 0.0));
    let mut placed: Vec<Area> =
        [start, goal].map(|pose| (pose.position(), pose.position())).into_iter().collect();
    while placed.len() < 2 + STAYING_PIECES + 2 * MOVED_PIECES {
        let (width, height) = (rng.random_range(0.3..0.9), rng.random_range(0.3..0.9));
        let (x, y) = (rng.random_range(0.0..size.x - width), rng.random_range(0.0..size.y - height));
        let new = area(x, y, width, height);
        if placed.iter().all(|other| gap(&new, other) >= PASSAGE_M) {
            placed.push(new);
        } else if rng.random_bool(0.01) {
            placed.truncate(2); // No room for the rest: another arrangement.
        }
    }
    let furniture = placed.split_off(2);
    Course {
        place: Place::ChangedRoom,
        seed,
        start,
        goal,
        size,
        floor: vec![area(0.0, 0.0, size.x, size.y)],
        fixed: furniture[..STAYING_PIECES].to_vec(),
        before: furniture[STAYING_PIECES..STAYING_PIECES + MOVED_PIECES].to_vec(),
        after: furniture[STAYING_PIECES + MOVED_PIECES..].to_vec(),
    }
}

/// Distance between two rectangles, m.
fn gap(a: &Area, b: &Area) -> f64 {
    (a.0 - b.1).sup(&(b.0 - a.1)).sup(&Vector2::zeros()).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_and_goal_are_free_and_only_changed_rooms_differ_from_their_map() {
        for (place, seed) in Place::ALL.into_iter().flat_map(|place| (1..20).map(move |seed| (place, seed))) {
            let course = Course::new(place, seed);
            let (map, world) = (course.map().unwrap(), course.world().unwrap());
            for pose in [course.start, course.goal] {
                assert_eq!(world.at(pose.position()), Cell::Free, "{}", course.name());
            }
            assert_eq!(map.cells() != world.cells(), place == Place::ChangedRoom, "{}", course.name());
            assert_eq!(Course::new(place, seed).map().unwrap().cells(), map.cells(), "the seed decides");
        }
    }

    #[test]
    fn rectangles_beside_each_other_have_their_gap_and_others_none() {
        let a = area(0.0, 0.0, 1.0, 1.0);
        assert_eq!(gap(&a, &area(2.0, 0.5, 1.0, 1.0)), 1.0);
        assert!((gap(&a, &area(4.0, 5.0, 1.0, 1.0)) - 5.0).abs() < 1e-12);
        assert_eq!(gap(&a, &area(0.5, 0.5, 1.0, 1.0)), 0.0);
    }
}
