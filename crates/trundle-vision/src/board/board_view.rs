//! Corners of a board in one image.

use thiserror::Error;
use trundle_core::Vector2;

/// A corner of a board.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardPoint {
    /// On the board, m: x along a row, y down the rows, seen from the front.
    pub board: Vector2,
    /// In the image, px.
    pub pixel: Vector2,
}

/// The corners of a board in one image.
#[derive(Debug, Clone, PartialEq)]
pub struct BoardView {
    /// The corners.
    pub points: Vec<BoardPoint>,
}

/// Why an image does not show a board.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BoardProblem {
    /// Nothing like a board.
    #[error("no board found; expected {expected}; show the whole board, in focus and evenly lit")]
    NoBoard {
        /// The board.
        expected: String,
    },
    /// Another board, or a part of one.
    #[error(
        "a board of {columns} x {rows} inner corners found, expected {expected}; show the whole board, or correct --board"
    )]
    WrongSize {
        /// Corners along a row.
        columns: usize,
        /// Corners down a column.
        rows: usize,
        /// The board.
        expected: String,
    },
}
