//! Content of a calibration board.

use super::board_view::{BoardProblem, BoardView};
use super::checkerboard::find_checkerboard;
use super::tag_board::TagBoard;
use std::fmt;
use std::str::FromStr;
use trundle_core::{GrayImage, Invalid};

/// A calibration board.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Board {
    /// A checkerboard, in text `checkerboard:9x6:25mm`.
    Checkerboard {
        /// Inner corners along a row, 3 to 50.
        columns: usize,
        /// Inner corners down a column, 3 to 50.
        rows: usize,
        /// Side of a square, m.
        square: f64,
    },
    /// Markers of the family tag36h11, in text `apriltag:6x6:88mm:0.3`, or `apriltag:6x6:88mm:0.3:100` with the first id.
    AprilTag(TagBoard),
}

/// Form of the text of a board.
const EXPECTED: &str = "checkerboard:COLUMNSxROWS:SQUARE, inner corners and a length with unit, for example checkerboard:9x6:25mm, or \
     apriltag:COLUMNSxROWS:SIDE:GAP[:FIRST_ID], tags of 587 in all, a length with unit, and the gap over the side, 0.1 to 1, for example \
     apriltag:6x6:88mm:0.3";
/// Smallest and largest number of corners of a row or a column. Source: ours.
const SIDES: std::ops::RangeInclusive<usize> = 3..=50;
/// Smallest and largest number of markers of a row or a column. Source: ours.
const TAG_SIDES: std::ops::RangeInclusive<usize> = 1..=50;
/// Smallest and largest square or marker: 1 mm to 1 m. Source: ours.
const SQUARES_M: std::ops::RangeInclusive<f64> = 0.001..=1.0;
/// Smallest and largest ratio of the gap between markers to their side. Source: ours; a smaller gap leaves no white border around the
/// marker.
const GAP_RATIOS: std::ops::RangeInclusive<f64> = 0.1..=1.0;

impl Board {
    /// The corners of the board in an image.
    ///
    /// # Errors
    /// When the image does not show the whole checkerboard, or too few markers.
    pub fn find(&self, image: &GrayImage) -> Result<BoardView, BoardProblem> {
        match self {
            Self::Checkerboard { columns, rows, square } => {
                find_checkerboard(image, (*columns, *rows), *square)
            }
            Self::AprilTag(board) => board.find(image),
        }
    }
}

impl FromStr for Board {
    type Err = Invalid;

    fn from_str(text: &str) -> Result<Self, Invalid> {
        let parts: Vec<&str> = text.split(':').collect();
        let board = match parts[..] {
            ["checkerboard", size, square] => checkerboard(size, square),
            ["apriltag", size, side, gap] => tag_board(size, side, gap, "0"),
            ["apriltag", size, side, gap, first_id] => tag_board(size, side, gap, first_id),
            _ => None,
        };
        board.ok_or_else(|| Invalid::new("board", format!("'{text}'"), "", EXPECTED))
    }
}

fn checkerboard(size: &str, square: &str) -> Option<Board> {
    let (columns, rows) = size_of(size, &SIDES)?;
    Some(Board::Checkerboard { columns, rows, square: length_of(square)? })
}

fn tag_board(size: &str, side: &str, gap: &str, first_id: &str) -> Option<Board> {
    let (columns, rows) = size_of(size, &TAG_SIDES)?;
    let gap_ratio = gap.parse().ok().filter(|gap| GAP_RATIOS.contains(gap))?;
    let first_id = first_id.parse().ok().filter(|id| *id < super::tags::TAG_COUNT)?;
    let board = TagBoard { columns, rows, side: length_of(side)?, gap_ratio, first_id };
    board.is_in_family().then_some(Board::AprilTag(board))
}

impl fmt::Display for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Checkerboard { columns, rows, square } => {
                write!(
                    f,
                    "a checkerboard of {columns} x {rows} inner corners, squares of {:.1} mm",
                    square * 1e3
                )
            }
            Self::AprilTag(board) => {
                let TagBoard { columns, rows, side, gap_ratio, .. } = board;
                let (first, last) = (board.ids().start, board.ids().end - 1);
                write!(
                    f,
                    "{columns} x {rows} tags of tag36h11, ids {first} to {last}, sides of {:.1} mm, gaps of {:.1} mm",
                    side * 1e3,
                    side * gap_ratio * 1e3
                )
            }
        }
    }
}

/// `9x6`.
fn size_of(text: &str, sides: &std::ops::RangeInclusive<usize>) -> Option<(usize, usize)> {
    let (columns, rows) = text.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|side| sides.contains(side));
    Some((side(columns)?, side(rows)?))
}

/// `25mm`, `2.5cm` or `0.025m`, in m.
fn length_of(text: &str) -> Option<f64> {
    let units = [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)];
    let (number, unit) = units.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, unit)))?;
    let length = number.parse::<f64>().ok()? * unit;
    SQUARES_M.contains(&length).then_some(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_read_from_its_text() {
        let board: Board = "checkerboard:9x6:25mm".parse().unwrap();
        assert_eq!(board, Board::Checkerboard { columns: 9, rows: 6, square: 0.025 });
        assert_eq!("checkerboard:9x6:2.5cm".parse::<Board>().unwrap(), board);
        for bad in [
            "",
            "checkerboard",
            "checkerboard:9:25mm",
            "checkerboard:9x6:25",
            "checkerboard:9x2:25mm",
            "chess:9x6:25mm",
            "checkerboard:9x6:25km",
            "checkerboard:9x6:-1mm",
            "checkerboard:9x6:NaNm",
        ] {
            let error = bad.parse::<Board>().unwrap_err().to_string();
            assert!(error.contains("checkerboard:9x6:25mm"), "{bad}: {error}");
        }
    }

    #[test]
    fn a_board_of_markers_is_read_from_its_text() {
        let expected = TagBoard { columns: 6, rows: 5, side: 0.088, gap_ratio: 0.3, first_id: 0 };
        assert_eq!("apriltag:6x5:88mm:0.3".parse::<Board>().unwrap(), Board::AprilTag(expected));
        let second = Board::AprilTag(TagBoard { first_id: 557, ..expected });
        assert_eq!("apriltag:6x5:0.088m:0.3:557".parse::<Board>().unwrap(), second);
        for bad in [
            "apriltag:6x5:88mm",
            "apriltag:6x5:88mm:0.05",
            "apriltag:6x5:88mm:NaN",
            "apriltag:6x5:88mm:0.3:558",
            "apriltag:6x5:88mm:0.3:18446744073709551615",
            "apriltag:6x5:88mm:0.3:-1",
            "apriltag:0x5:88mm:0.3",
            "apriltag:30x30:88mm:0.3",
            "apriltag:6x5:88mm:0.3:1:2",
        ] {
            let error = bad.parse::<Board>().unwrap_err().to_string();
            assert!(error.contains("apriltag:6x6:88mm:0.3"), "{bad}: {error}");
        }
    }
}
