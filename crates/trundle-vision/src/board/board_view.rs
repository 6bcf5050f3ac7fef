//! Corners of a board in one image. Any part of the corners is a view; the calibration is independent of the kind of board.

use thiserror::Error;
use trundle_core::Vector2;

/// A corner of a board.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardPoint {
    /// Position on the board, m: x along a row, y down the rows, in front view.
    pub board: Vector2,
    /// Position in the image, px.
    pub pixel: Vector2,
}

/// The corners of a board in one image.
#[derive(Debug, Clone, PartialEq)]
pub struct BoardView {
    /// The corners.
    pub points: Vec<BoardPoint>,
}

/// Reason why an image does not show a board.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BoardProblem {
    /// No board is visible.
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
    /// No marker.
    #[error(
        "no tag of tag36h11 found, expected {expected}; show the board in focus and evenly lit, each tag 20 px wide or more"
    )]
    NoTags {
        /// The ids of the board.
        expected: String,
    },
    /// Markers of another family.
    #[error(
        "{squares} black squares found, none a tag of tag36h11: the nearest differs in {wrong_cells} cells, accepted are 2 or fewer; \
         expected {expected}; print a board of this family by `trundle calibrate board`"
    )]
    OtherFamily {
        /// Squares with cells.
        squares: usize,
        /// Wrong cells of the nearest one.
        wrong_cells: u32,
        /// The ids of the board.
        expected: String,
    },
    /// Markers in a mirror.
    #[error(
        "the image is mirrored: {tags} tags are read from behind only; switch mirroring off in the camera"
    )]
    Mirrored {
        /// Mirrored markers.
        tags: usize,
    },
    /// Markers that the board does not have.
    #[error(
        "tags {ids} found, expected {expected}; cover tags beside the board, or correct columns, rows and first id of --board"
    )]
    ForeignTags {
        /// Ids of the markers.
        ids: String,
        /// The ids of the board.
        expected: String,
    },
    /// A marker appears more than once.
    #[error("tag {id} appears twice; show one board only, without mirrors")]
    RepeatedTag {
        /// Id of the marker.
        id: usize,
    },
    /// The visible part of the board is too small.
    #[error("{found} tags of the board found, expected {minimum} or more; show more of the board, in focus")]
    TooFewTags {
        /// Markers found.
        found: usize,
        /// Markers needed.
        minimum: usize,
    },
}
