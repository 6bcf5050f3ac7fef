//! Identification of the marker in a quad.

use super::codes::{CODE_CELLS, CodeCells, TAG_CELLS, mirrored, nearest_code};
use super::quad::Quad;
use super::tag::Tag;
use crate::board::board_view::BoardPoint;
use crate::board::homography::homography;
use crate::board::smooth_image::SmoothImage;
use nalgebra::Matrix3;
use trundle_core::Vector2;

/// Kind of a quad with a black border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Decoded {
    /// A marker of the family.
    Tag(Tag),
    /// A marker of the family, seen in a mirror.
    Mirrored,
    /// None of the family.
    Unknown {
        /// Number of cells that differ from those of the nearest marker.
        wrong_cells: u32,
    },
}

/// Largest number of wrong cells, border and code. Source: ours; codes differ in 11 cells, and each accepted cell makes false markers
/// 10 times as frequent \[Olson11, sec. III-C\].
pub(super) const MAX_WRONG_CELLS: u32 = 2;
/// Smallest contrast between the border and the surrounding paper, grey values. Source: ours.
const MIN_CONTRAST: f64 = 15.0;
/// Distance of the samples of the paper from the border, cells: less than the smallest gap of a board. Source: ours.
const PAPER_CELLS: f64 = 0.4;
/// Smallest number of white and of black cells in a code: each of the family has more. Source: ours.
const MIN_CELLS: usize = 6;

/// Reads the cells of a quad; `None` if it has no black border on light paper, or a code of one colour.
pub(super) fn decode(image: &SmoothImage, quad: &Quad) -> Option<Decoded> {
    let cells = Cells::new(image, quad)?;
    let dark = mean(border().map(|(row, column)| cells.value(row, column)));
    let threshold = (dark + cells.paper()) / 2.0;
    if cells.paper() - dark < MIN_CONTRAST {
        return None;
    }
    let wrong_border = border().filter(|(row, column)| cells.value(*row, *column) > threshold).count() as u32;
    let code: CodeCells =
        std::array::from_fn(|row| std::array::from_fn(|column| cells.value(row + 1, column + 1) > threshold));
    let white = code.iter().flatten().filter(|is_white| **is_white).count();
    let has_both_colours = (MIN_CELLS..=CODE_CELLS * CODE_CELLS - MIN_CELLS).contains(&white);
    if wrong_border > MAX_WRONG_CELLS || !has_both_colours {
        return None;
    }
    let found = nearest_code(&code);
    let wrong_cells = wrong_border + found.distance;
    if wrong_cells <= MAX_WRONG_CELLS {
        let corners = std::array::from_fn(|i| quad[(i + found.turns) % 4]);
        return Some(Decoded::Tag(Tag { id: found.id, corners, wrong_cells }));
    }
    let is_mirrored = wrong_border + nearest_code(&mirrored(&code)).distance <= MAX_WRONG_CELLS;
    Some(if is_mirrored { Decoded::Mirrored } else { Decoded::Unknown { wrong_cells } })
}

/// Row and column of the cells of the border.
fn border() -> impl Iterator<Item = (usize, usize)> {
    let is_outer = |at: usize| at == 0 || at + 1 == TAG_CELLS;
    (0..TAG_CELLS * TAG_CELLS)
        .map(|i| (i / TAG_CELLS, i % TAG_CELLS))
        .filter(move |(row, column)| is_outer(*row) || is_outer(*column))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The grey values of a quad by cells.
struct Cells<'a> {
    image: &'a SmoothImage,
    /// Homography from cells, x right and y down, to px.
    image_from_cells: Matrix3<f64>,
}

impl<'a> Cells<'a> {
    fn new(image: &'a SmoothImage, quad: &Quad) -> Option<Self> {
        let side = TAG_CELLS as f64;
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        let point = |((x, y), pixel): (&(f64, f64), &Vector2)| BoardPoint {
            board: Vector2::new(*x, *y),
            pixel: *pixel,
        };
        let points: Vec<BoardPoint> = corners.iter().zip(quad).map(point).collect();
        Some(Self { image, image_from_cells: homography(&points)? })
    }

    /// The value at a position in cells.
    fn sample(&self, x: f64, y: f64) -> f64 {
        let p = self.image_from_cells * nalgebra::Vector3::new(x, y, 1.0);
        self.image.sample(Vector2::new(p.x / p.z, p.y / p.z))
    }

    /// Mean of the inner part of a cell.
    fn value(&self, row: usize, column: usize) -> f64 {
        let offset = |k: usize| 0.3 + 0.2 * k as f64;
        mean((0..9).map(|k| self.sample(column as f64 + offset(k % 3), row as f64 + offset(k / 3))))
    }

    /// Mean of the paper around the border.
    fn paper(&self) -> f64 {
        let far = TAG_CELLS as f64 + PAPER_CELLS;
        mean((0..TAG_CELLS).flat_map(|i| {
            let at = i as f64 + 0.5;
            [(at, -PAPER_CELLS), (at, far), (-PAPER_CELLS, at), (far, at)].map(|(x, y)| self.sample(x, y))
        }))
    }
}
