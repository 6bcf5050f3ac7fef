//! A checkerboard in an image.
//!
//! Problem: which saddle points of an image are the corners of the board, and their order. Idea \[Geiger12, sec. III-B\]: from a seed and
//! its neighbours the grid grows corner by corner, each at its predicted position. Among all seeds, the grid of the right size is used.
//! Cost: O(corners^2).

use super::board_view::{BoardPoint, BoardProblem, BoardView};
use super::corner_refinement::refine_corner;
use super::saddle_points::{SaddlePoint, saddle_points};
use super::smooth_image::SmoothImage;
use std::collections::BTreeMap;
use trundle_core::{GrayImage, Vector2};

/// Blur before the search, px: it removes saddle points of noise. Source: ours.
const SEARCH_BLUR_PX: f32 = 1.5;
/// Blur before the refinement, px. Source: ours.
const REFINEMENT_BLUR_PX: f32 = 0.7;
/// Seeds that are tried. Source: ours.
const MAX_SEEDS: usize = 30;
/// Largest distance of a corner from its prediction, as a ratio to the side of a square. Source: ours.
const MAX_PREDICTION_ERROR: f64 = 0.3;
/// Smallest fraction of the board's corners: 0.8. The outer corners must be found, because they determine the size of the board. Source:
/// ours.
const MIN_CORNER_RATIO: f64 = 0.8;
/// Radius of the refinement over the distance to the nearest corner. Source: ours; a larger one would meet the next corner.
const REFINEMENT_RADIUS_RATIO: f64 = 0.4;
/// Smallest radius of the refinement, px. Source: ours.
const MIN_REFINEMENT_RADIUS_PX: f64 = 3.0;
/// Largest radius of the refinement, px. Source: ours.
const MAX_REFINEMENT_RADIUS_PX: f64 = 9.0;

/// The corners of a checkerboard with this number of inner corners (columns, rows) and squares of `square` m.
pub(super) fn find_checkerboard(
    image: &GrayImage,
    size: (usize, usize),
    square: f64,
) -> Result<BoardView, BoardProblem> {
    let expected = || {
        let (columns, rows) = size;
        format!("a checkerboard of {columns} x {rows} inner corners")
    };
    let corners = saddle_points(&SmoothImage::new(image, SEARCH_BLUR_PX));
    let mut largest: Option<Grid> = None;
    for seed in 0..corners.len().min(MAX_SEEDS) {
        let Some(grid) = Grid::grow(&corners, seed) else { continue };
        if let Some(ordered) = grid.ordered(size) {
            let smooth = SmoothImage::new(image, REFINEMENT_BLUR_PX);
            return Ok(view(&smooth, &ordered, size, square));
        }
        if largest.as_ref().is_none_or(|largest| grid.cells.len() > largest.cells.len()) {
            largest = Some(grid);
        }
    }
    match largest.map(|grid| grid.size()) {
        Some((columns, rows)) if columns > 2 && rows > 2 => {
            Err(BoardProblem::WrongSize { columns, rows, expected: expected() })
        }
        _ => Err(BoardProblem::NoBoard { expected: expected() }),
    }
}

/// The corners, refined if that is possible.
fn view(
    image: &SmoothImage,
    corners: &[(usize, Vector2)],
    (columns, _): (usize, usize),
    square: f64,
) -> BoardView {
    let nearest = |at: &Vector2| {
        let distances =
            corners.iter().map(|(_, other)| (other - at).norm()).filter(|distance| *distance > 0.0);
        distances.fold(f64::MAX, f64::min)
    };
    let point = |(i, pixel): &(usize, Vector2)| {
        let radius = REFINEMENT_RADIUS_RATIO * nearest(pixel);
        let radius = radius.clamp(MIN_REFINEMENT_RADIUS_PX, MAX_REFINEMENT_RADIUS_PX);
        let board = Vector2::new((i % columns) as f64, (i / columns) as f64) * square;
        Some(BoardPoint { board, pixel: refine_corner(image, *pixel, radius)? })
    };
    BoardView { points: corners.iter().filter_map(point).collect() }
}

/// Cell of a grid: column and row, from the seed.
type GridCell = (i32, i32);

/// Steps to the four neighbours of a cell.
const STEPS: [GridCell; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Corners in a grid.
struct Grid {
    cells: BTreeMap<GridCell, Vector2>,
}

impl Grid {
    /// The grid that grows from a seed; `None` if the seed has no neighbours in two directions.
    fn grow(corners: &[SaddlePoint], seed: usize) -> Option<Self> {
        let origin = corners[seed].pixel;
        let (along, across) = axes(corners, origin)?;
        let mut grid = Self { cells: BTreeMap::from([((0, 0), origin)]) };
        let mut open = vec![(0, 0)];
        while let Some(cell) = open.pop() {
            for step in STEPS {
                let next = (cell.0 + step.0, cell.1 + step.1);
                if grid.cells.contains_key(&next) {
                    continue;
                }
                let (predicted, side) = grid.prediction(cell, step, (along, across));
                let (distance, found) = nearest(corners, predicted)?;
                if distance <= MAX_PREDICTION_ERROR * side
                    && !grid.cells.values().any(|pixel| *pixel == found)
                {
                    grid.cells.insert(next, found);
                    open.push(next);
                }
            }
        }
        Some(grid)
    }

    /// Predicted position of a cell's neighbour, px, and the local side of a square, px.
    fn prediction(
        &self,
        cell: GridCell,
        step: GridCell,
        (along, across): (Vector2, Vector2),
    ) -> (Vector2, f64) {
        let here = self.cells[&cell];
        let before = self.cells.get(&(cell.0 - step.0, cell.1 - step.1)).map(|before| here - before);
        // A neighbour to the side shows the same step.
        let side = [(step.1, step.0), (-step.1, -step.0)].into_iter().find_map(|(dx, dy)| {
            let (from, to) = ((cell.0 + dx, cell.1 + dy), (cell.0 + dx + step.0, cell.1 + dy + step.1));
            Some(self.cells.get(&to)? - self.cells.get(&from)?)
        });
        let start = along * f64::from(step.0) + across * f64::from(step.1);
        let motion = match (side, before) {
            (Some(side), Some(before)) => (side + before) / 2.0,
            (Some(motion), None) | (None, Some(motion)) => motion,
            (None, None) => start,
        };
        (here + motion, motion.norm())
    }

    /// Columns and rows of the bounding rectangle.
    fn size(&self) -> (usize, usize) {
        let span = |value: &dyn Fn(&GridCell) -> i32| {
            let values = self.cells.keys().map(value);
            values.clone().max().unwrap_or(0) - values.min().unwrap_or(0) + 1
        };
        (span(&|cell| cell.0) as usize, span(&|cell| cell.1) as usize)
    }

    /// The pixels with their corner numbers, row by row, right-handed in front view; `None` for a grid of another size or with too many
    /// gaps.
    fn ordered(&self, (columns, rows): (usize, usize)) -> Option<Vec<(usize, Vector2)>> {
        let is_turned = self.size() == (rows, columns) && rows != columns;
        let is_whole = self.cells.len() as f64 >= MIN_CORNER_RATIO * (columns * rows) as f64;
        if !is_whole || !(is_turned || self.size() == (columns, rows)) {
            return None;
        }
        let first = |value: &dyn Fn(&GridCell) -> i32| self.cells.keys().map(value).min();
        let (x0, y0) = (first(&|cell| cell.0)?, first(&|cell| cell.1)?);
        // The axes of a turned grid are exchanged, which mirrors it.
        let is_mirrored = self.is_mirrored()? != is_turned;
        let number = |cell: &GridCell| {
            let (x, y) = ((cell.0 - x0) as usize, (cell.1 - y0) as usize);
            let (column, row) = if is_turned { (y, x) } else { (x, y) };
            row * columns + if is_mirrored { columns - 1 - column } else { column }
        };
        let mut ordered: Vec<(usize, Vector2)> =
            self.cells.iter().map(|(cell, pixel)| (number(cell), *pixel)).collect();
        ordered.sort_by_key(|(number, _)| *number);
        Some(ordered)
    }

    /// Whether the grid is left-handed in the image; `None` if no corner has neighbours in both directions.
    fn is_mirrored(&self) -> Option<bool> {
        self.cells.iter().find_map(|(cell, here)| {
            let right = self.cells.get(&(cell.0 + 1, cell.1))? - here;
            let down = self.cells.get(&(cell.0, cell.1 + 1))? - here;
            Some(right.perp(&down) < 0.0)
        })
    }
}

/// The steps from a corner to its nearest neighbour and to the nearest neighbour in another direction.
fn axes(corners: &[SaddlePoint], origin: Vector2) -> Option<(Vector2, Vector2)> {
    let mut steps: Vec<Vector2> =
        corners.iter().map(|corner| corner.pixel - origin).filter(|step| step.norm() > 0.0).collect();
    steps.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let along = *steps.first()?;
    let is_across = |step: &&Vector2| step.perp(&along).abs() > 0.5 * step.norm() * along.norm();
    let across = *steps.iter().find(is_across)?;
    Some((along, across))
}

/// The corner nearest to a position, and its distance, px.
fn nearest(corners: &[SaddlePoint], at: Vector2) -> Option<(f64, Vector2)> {
    let distances = corners.iter().map(|corner| ((corner.pixel - at).norm(), corner.pixel));
    distances.min_by(|a, b| a.0.total_cmp(&b.0))
}
