//! Maps of every kind: mazes, spirals, slanted walls, crumbs; fine and coarse, far from the origin, tiny, unknown at the border.

use crate::support::{LIMITS, at_home, found_plan, judge, planner};
use trundle_core::{
    Cell, CellIndex, DifferentialDrive, Footprint, GridGeometry, Hypotenuse, OccupancyGrid, Pose2, Twist2,
    Vector2,
};
use trundle_planning::{DistanceField, Plan, Planner, PlannerConfig, UnknownIs, WaypointGraph};

struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end
    }
}

fn walled(size: usize, resolution: f64, origin: Vector2, solid: impl Fn(f64, f64) -> bool) -> OccupancyGrid {
    let geometry = GridGeometry::new(resolution, origin, size, size).unwrap();
    let side = size as f64;
    let cell = |i: usize| {
        let (x, y) = ((i % size) as f64 + 0.5, (i / size) as f64 + 0.5);
        let border = x < 1.0 || y < 1.0 || x > side - 1.0 || y > side - 1.0;
        if border || solid(x / side, y / side) { Cell::Occupied } else { Cell::Free }
    };
    OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap()
}

/// Corridors `wide` cells wide between walls a cell thick, by depth-first digging.
fn maze(halls: usize, wide: usize, resolution: f64, seed: u64) -> OccupancyGrid {
    let pitch = wide + 1;
    let size = halls * pitch + 1;
    let geometry = GridGeometry::new(resolution, Vector2::new(-7.3, 11.1), size, size).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Occupied);
    let mut dig = |(c, r): (usize, usize), (cols, rows): (usize, usize)| {
        (0..cols).for_each(|i| {
            (0..rows).for_each(|j| {
                grid.set(CellIndex { col: c * pitch + 1 + i, row: r * pitch + 1 + j }, Cell::Free);
            });
        });
    };
    let (mut seen, mut dice) = (vec![false; halls * halls], Dice(seed));
    let mut stack = vec![(0_usize, 0_usize)];
    seen[0] = true;
    dig((0, 0), (wide, wide));
    while let Some((c, r)) = stack.last().copied() {
        let near = [(c + 1, r), (c, r + 1), (c.wrapping_sub(1), r), (c, r.wrapping_sub(1))];
        let open: Vec<_> =
            near.into_iter().filter(|(c, r)| *c < halls && *r < halls && !seen[r * halls + c]).collect();
        if open.is_empty() {
            stack.pop();
            continue;
        }
        let next = open[dice.below(open.len())];
        seen[next.1 * halls + next.0] = true;
        dig(next, (wide, wide));
        // Through the wall between the two.
        let low = (c.min(next.0), r.min(next.1));
        dig(low, if next.1 == r { (pitch + wide, wide) } else { (wide, pitch + wide) });
        stack.push(next);
    }
    grid
}

/// Random questions between places that a flood over free centres connects, with a cell to spare; all found and sound.
fn all_found(name: &str, grid: &OccupancyGrid, radius: f64, count: usize) {
    let geometry = *grid.geometry();
    let sure = radius + geometry.resolution / 2.0;
    let field = DistanceField::from_grid(grid, UnknownIs::Free);
    let mut dice = Dice(7);
    let mut planner = planner(at_home(), radius);
    let mut asked = 0;
    for _ in 0..4000 {
        let mut cell = || geometry.cell(dice.below(geometry.len()));
        let (from, to) = (cell(), cell());
        let at = |cell| geometry.center(cell);
        if field.at_cell(from) < sure || field.at_cell(to) < sure || !connected(&field, from, to, sure) {
            continue;
        }
        let mut pose = |p: Vector2| Pose2::new(p.x, p.y, dice.below(628) as f64 / 100.0);
        let (start, goal) = (pose(at(from)), pose(at(to)));
        let plan = planner.plan(grid, start, Twist2::ZERO, goal);
        let Plan::Found(result) = &plan else { panic!("{name}: {start:?} {goal:?}: {plan}") };
        judge(grid, result, start, goal, radius);
        asked += 1;
        if asked == count {
            return;
        }
    }
    panic!("{name}: only {asked} questions");
}

fn connected(field: &DistanceField, from: CellIndex, to: CellIndex, sure: f64) -> bool {
    let geometry = field.geometry();
    let mut reached = vec![false; geometry.len()];
    let mut stack = vec![from];
    while let Some(cell) = stack.pop() {
        if cell == to {
            return true;
        }
        let CellIndex { col, row } = cell;
        let near = [(col + 1, row), (col, row + 1), (col.wrapping_sub(1), row), (col, row.wrapping_sub(1))];
        for (col, row) in near {
            if col < geometry.width && row < geometry.height {
                let next = CellIndex { col, row };
                let is_new = !std::mem::replace(&mut reached[geometry.linear(next)], true);
                if is_new && field.at_cell(next) >= sure {
                    stack.push(next);
                }
            }
        }
    }
    false
}

#[test]
fn mazes_of_thin_walls() {
    for (halls, wide, resolution, radius) in
        [(9, 9, 0.05, 0.1755), (6, 5, 0.1, 0.15), (7, 3, 0.2, 0.19), (4, 45, 0.01, 0.1755)]
    {
        let count = if resolution < 0.02 { 2 } else { 4 };
        all_found(&format!("maze of {halls}"), &maze(halls, wide, resolution, halls as u64), radius, count);
    }
}

/// No centre of a cell has the room, but the middle of the corridor has.
#[test]
fn corridors_an_even_number_of_cells_wide() {
    for (wide, resolution, radius) in [(8, 0.05, 0.1755), (4, 0.1, 0.17), (2, 0.2, 0.14), (4, 0.2, 0.34)] {
        let geometry = GridGeometry::new(resolution, Vector2::new(-1.0, 2.0), 60, wide + 30).unwrap();
        let is_room = |col: usize| !(20..40).contains(&col);
        let cell = |i: usize| {
            let (col, row) = (i % 60, i / 60);
            let open = if is_room(col) { row > 0 && row < wide + 29 } else { (15..15 + wide).contains(&row) };
            if open && col > 0 && col < 59 { Cell::Free } else { Cell::Occupied }
        };
        let grid = OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap();
        let at = |col: f64, row: f64| geometry.origin + Vector2::new(col, row) * resolution;
        let (a, b) = (at(10.0, 9.0), at(50.0, 20.0));
        let (start, goal) = (Pose2::new(a.x, a.y, 0.3), Pose2::new(b.x, b.y, 1.0));
        let plan = found_plan(planner(at_home(), radius).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &plan, start, goal, radius);
        let wider = wide as f64 * resolution / 2.0 + 1e-3;
        let plan = planner(at_home(), wider).plan(&grid, start, Twist2::ZERO, goal);
        assert!(matches!(plan, Plan::Blocked { nearest } if nearest.x < at(20.5, 0.0).x), "{plan}");
    }
}

#[test]
fn spirals_slanted_walls_and_crumbs() {
    let spiral = |x: f64, y: f64| {
        let (dx, dy) = (x - 0.5, y - 0.5);
        let turns = dx.hypotenuse(dy) / 0.09 - dy.atan2(dx) / std::f64::consts::TAU;
        turns.rem_euclid(1.0) < 0.12 && dx.hypotenuse(dy) > 0.05
    };
    all_found("spiral", &walled(160, 0.05, Vector2::new(100.0, -40.0), spiral), 0.1755, 4);
    let slanted = |x: f64, y: f64| {
        let along = (x + 0.6 * y) * 6.0;
        along.rem_euclid(1.0) < 0.05
            && !(0.1..0.25).contains(&(y * 2.0 + along.floor() * 0.37).rem_euclid(1.0))
    };
    all_found("slanted walls", &walled(200, 0.05, Vector2::new(-5.0, -5.0), slanted), 0.1755, 4);
    let crumb = |x: f64, y: f64| {
        let hash =
            ((x * 4001.0) as u64).wrapping_mul(73_856_093) ^ ((y * 4001.0) as u64).wrapping_mul(19_349_663);
        hash.is_multiple_of(211)
    };
    all_found("crumbs", &walled(150, 0.05, Vector2::zeros(), crumb), 0.1755, 4);
    all_found("crumbs of 2 cm", &walled(200, 0.02, Vector2::zeros(), crumb), 0.1, 4);
}

#[test]
fn halls_that_are_large_for_their_cells() {
    let pillars = |x: f64, y: f64| (x * 7.0).fract() < 0.12 && (y * 9.0).fract() < 0.12;
    all_found("20 cm cells", &walled(120, 0.2, Vector2::new(1e4, -1e4), pillars), 0.26, 6);
    all_found("1 cm cells", &walled(400, 0.01, Vector2::zeros(), pillars), 0.1755, 2);
}

/// Known inside, unknown around: the same answers whether the border is drawn or not.
#[test]
fn an_unknown_border_is_left_and_entered_as_configured() {
    let geometry = GridGeometry::new(0.05, Vector2::new(-2.0, -2.0), 80, 80).unwrap();
    let known = |i: usize| (10..70).contains(&(i % 80)) && (10..70).contains(&(i / 80));
    let cells = (0..geometry.len()).map(|i| if known(i) { Cell::Free } else { Cell::Unknown });
    let grid = OccupancyGrid::new(geometry, cells.collect()).unwrap();
    let (start, inside, beyond) =
        (Pose2::new(-1.0, 0.0, 2.0), Pose2::new(1.0, 1.0, 0.0), Pose2::new(1.8, 0.0, 0.0));
    for (unknown, outside) in [(UnknownIs::Free, true), (UnknownIs::Obstacle, false)] {
        let mut config = at_home();
        config.unknown = unknown;
        let mut planner = planner(config, 0.1755);
        judge(&grid, &found_plan(planner.plan(&grid, start, Twist2::ZERO, inside)), start, inside, 0.1755);
        let plan = planner.plan(&grid, start, Twist2::ZERO, beyond);
        assert_eq!(matches!(plan, Plan::Found(_)), outside, "{plan}");
        assert!(outside || matches!(plan, Plan::GoalInObstacle { .. }), "{plan}");
    }
}

#[test]
fn the_tiniest_and_the_thinnest_maps_have_answers() {
    for (width, height) in [(1, 1), (1, 40), (40, 1), (2, 2), (3, 1)] {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), width, height).unwrap();
        for cell in [Cell::Free, Cell::Unknown, Cell::Occupied] {
            let grid = OccupancyGrid::filled(geometry, cell);
            let (a, b) =
                (geometry.center(geometry.cell(0)), geometry.center(geometry.cell(geometry.len() - 1)));
            for unknown in [UnknownIs::Free, UnknownIs::Obstacle] {
                for mut config in [at_home(), PlannerConfig::default()] {
                    config.unknown = unknown;
                    let mut planner = planner(config, 0.1755);
                    let plan = planner.plan(
                        &grid,
                        Pose2::new(a.x, a.y, 0.0),
                        Twist2::ZERO,
                        Pose2::new(b.x, b.y, 1.0),
                    );
                    let is_way = cell == Cell::Free || (cell == Cell::Unknown && unknown == UnknownIs::Free);
                    let may = is_way && unknown == UnknownIs::Free;
                    assert_eq!(matches!(plan, Plan::Found(_)), may, "{width} x {height} {cell:?}: {plan}");
                }
            }
        }
    }
}

/// A hall with a wall across, and a gap of `wide` cells in the wall.
fn gap(wide: usize) -> (OccupancyGrid, Pose2, Pose2) {
    let geometry = GridGeometry::new(0.1, Vector2::zeros(), 60, 30).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    let wall = (0..30).filter(|row| !(14..14 + wide).contains(row));
    wall.for_each(|row| (28..32).for_each(|col| grid.set(CellIndex { col, row }, Cell::Occupied)));
    (grid, Pose2::new(1.0, 1.0, 0.0), Pose2::new(5.0, 2.0, 0.5))
}

/// The finer lattice is tried for discs in all cases: with a tolerance, for a goal that does not fit, and along a graph.
#[test]
fn a_tight_gap_is_passed_whatever_else_is_allowed() {
    let (mut grid, start, goal) = gap(4);
    let radius = 0.17;
    let mut near = at_home();
    near.goal_tolerance = 6.0;
    let plan = found_plan(planner(near, radius).plan(&grid, start, Twist2::ZERO, goal));
    assert_eq!(plan.instead_of, None);
    judge(&grid, &plan, start, goal, radius);
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let graph = WaypointGraph::new(vec![at(1.5, 0.5)], vec![]).unwrap();
    let along = WaypointGraph::new(vec![at(4.0, 1.0), at(5.0, 1.0)], vec![(0, 1)]).unwrap();
    let plan = planner(at_home(), radius).plan_on_graph(&grid, &graph, start, Twist2::ZERO, goal);
    judge(&grid, &found_plan(plan), start, goal, radius);
    let plan = found_plan(planner(at_home(), radius).plan_on_graph(&grid, &along, start, Twist2::ZERO, goal));
    judge(&grid, &plan, start, goal, radius);
    assert!(plan.waypoints.points().contains(&at(4.0, 1.0)));
    (48..52).for_each(|col| grid.set(CellIndex { col, row: 20 }, Cell::Occupied));
    let mut some = at_home();
    some.goal_tolerance = 0.6;
    let plan = found_plan(planner(some, radius).plan(&grid, start, Twist2::ZERO, goal));
    assert!(plan.trajectory.end().distance(&goal) < 0.4, "{:?}", plan.trajectory.end());
    assert!(matches!(plan.instead_of, Some(Plan::GoalInObstacle { .. })), "{:?}", plan.instead_of);
}

/// The fields of both lattices are updated: the result equals that of a new planner byte for byte.
#[test]
fn the_finer_field_follows_the_map() {
    let (mut grid, start, goal) = gap(4);
    let mut kept = planner(at_home(), 0.17);
    for row in [2, 5, 18] {
        (14..18).for_each(|col| grid.set(CellIndex { col, row }, Cell::Occupied));
        let plan = kept.plan(&grid, start, Twist2::ZERO, goal);
        assert_eq!(plan, planner(at_home(), 0.17).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &found_plan(plan), start, goal, 0.17);
    }
}

/// A polygon passes every gap that fits it along the lattice's lines: the centres of cells, their corners, the middles of edges.
#[test]
fn an_outline_passes_what_its_lattice_passes() {
    let cart = |half: f64| {
        let corners =
            [(0.3, half), (-0.1, half), (-0.1, -half), (0.3, -half)].map(|(x, y)| Vector2::new(x, y));
        let footprint = Footprint::polygon(corners.to_vec()).unwrap();
        Planner::new(at_home(), &footprint, LIMITS, DifferentialDrive::KOBUKI).unwrap()
    };
    let (odd, start, goal) = gap(3);
    for half in [0.1, 0.14, 0.15] {
        let plan = found_plan(cart(half).plan(&odd, start, Twist2::ZERO, goal));
        assert!(plan.trajectory.end().distance(&goal) < 1.1e-3);
    }
    let plan = cart(0.151).plan(&odd, start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { nearest } if nearest.x < 2.9), "{plan}");
    let (even, ..) = gap(4);
    for half in [0.15, 0.19, 0.2] {
        let plan = found_plan(cart(half).plan(&even, start, Twist2::ZERO, goal));
        assert!(plan.trajectory.end().distance(&goal) < 1.1e-3);
    }
    let plan = cart(0.201).plan(&even, start, Twist2::ZERO, goal);
    assert!(matches!(plan, Plan::Blocked { nearest } if nearest.x < 2.9), "{plan}");
}
