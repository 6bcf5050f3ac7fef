//! Cost of a change of 6 x 6 m for the distance field: CPU time, the best of several runs of each change, the worst of all changes.

use super::support::cpu_ms;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use trundle_planning::{DistanceField, UnknownIs};

/// Changes a map and a kind. Source: ours.
const PLACES: usize = 40;
const ROUNDS: usize = 5;
/// Reach of the planner of a disc of 0.26 m, at 5 cm. Source: the planner's configuration for that disc.
pub const REACH: f64 = 1.46;
/// Side of the changed window, m. Source: ours.
const WINDOW: f64 = 6.0;

/// A change of the cells of a window: the new state of cell `i` of `side` x `side`.
type Change = fn(i: usize, side: usize, k: usize, was: Cell) -> Cell;

/// Changes like those of a scan: clutter, and a wall across the map.
fn sensor(i: usize, side: usize, k: usize, was: Cell) -> Cell {
    let (col, row) = (i % side, i / side);
    let is_wall = row == (side / 2 + col / 7) % side || i == 0 || i + 1 == side * side;
    match (i * 7 + k) % 97 {
        0 if was == Cell::Occupied => Cell::Free,
        0 => Cell::Occupied,
        _ if is_wall => Cell::Occupied,
        _ => was,
    }
}

/// Every cell changes.
fn replaced(i: usize, _: usize, k: usize, was: Cell) -> Cell {
    let is_far = !(i / 13 + k).is_multiple_of(5);
    if was == Cell::Occupied || is_far && was == Cell::Unknown { Cell::Free } else { Cell::Occupied }
}

/// All cells cleared: distances grow up to the largest stored one.
fn cleared(_: usize, _: usize, _: usize, _: Cell) -> Cell {
    Cell::Free
}

/// A row of the table a kind of change.
pub fn print(name: &str, grid: &OccupancyGrid) {
    let whole = (0..3).map(|_| timed(|| DistanceField::up_to(REACH, grid, UnknownIs::Free)));
    let whole = whole.fold(f64::INFINITY, f64::min);
    let GridGeometry { width, height, .. } = *grid.geometry();
    for (kind, change) in [
        ("a scan's", sensor as Change),
        ("all replaced", replaced as Change),
        ("all cleared", cleared as Change),
    ] {
        let mut times = changes(grid, change);
        times.sort_by(f64::total_cmp);
        let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
        println!("| {name} | {width} x {height} | {whole:.2} | {kind} | {median:.3} | {worst:.3} |");
    }
}

/// The best time of each change, forth and back, ms.
fn changes(grid: &OccupancyGrid, change: Change) -> Vec<f64> {
    let GridGeometry { width, height, resolution, .. } = *grid.geometry();
    let side = (WINDOW / resolution) as usize;
    let mut field = DistanceField::up_to(REACH, grid, UnknownIs::Free);
    let mut changed = grid.clone();
    let mut times = Vec::new();
    for k in 0..PLACES {
        let (left, low) = (k * 37 % (width - side + 1), k * 53 % (height - side + 1));
        let window = (0..side * side).map(|i| CellIndex { col: left + i % side, row: low + i / side });
        for (i, cell) in window.clone().enumerate() {
            changed.set(cell, change(i, side, k, grid.get(cell)));
        }
        let mut best = [f64::INFINITY; 2];
        for _ in 0..ROUNDS {
            for (best, version) in best.iter_mut().zip([&changed, grid]) {
                *best = best.min(timed(|| field.update(version)));
            }
        }
        times.extend(best);
        field.update(&changed);
        assert!(k > 0 || field == DistanceField::up_to(REACH, &changed, UnknownIs::Free), "exact");
        window.for_each(|cell| changed.set(cell, grid.get(cell)));
        field.update(grid);
    }
    times
}

fn timed<T>(work: impl FnOnce() -> T) -> f64 {
    let begin = cpu_ms();
    let result = std::hint::black_box(work());
    let spent = cpu_ms() - begin;
    drop(std::hint::black_box(result));
    spent
}

/// An empty hall with one square pillar of a given number of cells.
pub fn hall(size: usize, resolution: f64) -> OccupancyGrid {
    let geometry = GridGeometry::new(resolution, Vector2::zeros(), size, size).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    grid.set(CellIndex { col: size / 3, row: size / 2 }, Cell::Occupied);
    grid
}
