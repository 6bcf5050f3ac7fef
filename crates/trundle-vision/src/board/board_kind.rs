//! What is on a calibration board.

use super::board_view::{BoardProblem, BoardView};
use super::checkerboard::find_checkerboard;
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
}

/// What the text of a board looks like.
const EXPECTED: &str = "checkerboard:COLUMNSxROWS:SQUARE, inner corners and a length with unit, for example checkerboard:9x6:25mm";
/// Smallest and largest number of corners of a row or a column. Source: ours.
const SIDES: std::ops::RangeInclusive<usize> = 3..=50;
/// Smallest and largest square: 1 mm to 1 m. Source: ours.
const SQUARES_M: std::ops::RangeInclusive<f64> = 0.001..=1.0;

impl Board {
    /// The corners of the board in an image.
    ///
    /// # Errors
    /// When the image does not show the whole board.
    pub fn find(&self, image: &GrayImage) -> Result<BoardView, BoardProblem> {
        match *self {
            Self::Checkerboard { columns, rows, square } => find_checkerboard(image, (columns, rows), square),
        }
    }
}

impl FromStr for Board {
    type Err = Invalid;

    fn from_str(text: &str) -> Result<Self, Invalid> {
        let refused = || Invalid::new("board", format!("'{text}'"), "", EXPECTED);
        let parts: Vec<&str> = text.split(':').collect();
        match parts[..] {
            ["checkerboard", size, square] => {
                let (columns, rows) = size_of(size).ok_or_else(refused)?;
                let square = length_of(square).ok_or_else(refused)?;
                Ok(Self::Checkerboard { columns, rows, square })
            }
            _ => Err(refused()),
        }
    }
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
        }
    }
}

/// `9x6`.
fn size_of(text: &str) -> Option<(usize, usize)> {
    let (columns, rows) = text.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|side| SIDES.contains(side));
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
}
