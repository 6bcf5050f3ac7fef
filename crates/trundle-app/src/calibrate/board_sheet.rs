//! A calibration board to print, as SVG in true size.

use crate::AppError;
use std::fmt::Write;
use std::path::Path;
use trundle_io::replace_file;
use trundle_vision::board::tags::{TAG_CELLS, tag_cells};
use trundle_vision::board::{Board, TagBoard};

/// White margin around a board, mm. Source: ours; a detector needs paper around the outer squares.
const MARGIN_MM: f64 = 10.0;
/// Height of the line of text below a board, mm. Source: ours.
const TEXT_MM: f64 = 8.0;
/// Length of the line that shows the scale of the print, mm; shorter on smaller boards. Source: ours.
const SCALE_MM: f64 = 100.0;

/// A board as a sheet.
struct Sheet {
    /// Width and height of the board without its margin, mm.
    size: (f64, f64),
    /// Black rectangles as an SVG path, mm from the upper left corner of the board.
    path: String,
}

/// Writes a board to print, as SVG, and replaces an existing file. Lengths of the SVG are in mm, the true size of the board.
///
/// # Errors
/// When the file cannot be written.
pub fn write_board(board: &Board, file: &Path) -> Result<(), AppError> {
    let svg = board_svg(board).ok_or_else(|| {
        AppError::Input(format!("{board}: cannot be drawn, expected a checkerboard or tags"))
    })?;
    Ok(replace_file(file, svg.as_bytes())?)
}

/// The board as SVG.
fn board_svg(board: &Board) -> Option<String> {
    let sheet = match board {
        Board::Checkerboard { columns, rows, square } => checkerboard((*columns, *rows), square * 1e3),
        Board::AprilTag(board) => tag_board(board)?,
        _ => return None,
    };
    let (width, height) = (sheet.size.0 + 2.0 * MARGIN_MM, sheet.size.1 + 2.0 * MARGIN_MM + TEXT_MM);
    let scale = SCALE_MM.min((sheet.size.0 / 10.0).floor() * 10.0).max(10.0);
    let (line_y, text_y) = (sheet.size.1 + MARGIN_MM, sheet.size.1 + MARGIN_MM + 6.0);
    Some(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}mm\" height=\"{height:.3}mm\" \
         viewBox=\"{min:.3} {min:.3} {width:.3} {height:.3}\">\n\
         <rect x=\"{min:.3}\" y=\"{min:.3}\" width=\"{width:.3}\" height=\"{height:.3}\" fill=\"white\"/>\n\
         <path d=\"{path}\" fill=\"black\" shape-rendering=\"crispEdges\"/>\n\
         <path d=\"M0 {line_y:.3}h{scale}m0 -1.5v3m-{scale} 0v-3\" fill=\"none\" stroke=\"#555\" stroke-width=\"0.3\"/>\n\
         <text x=\"0\" y=\"{text_y:.3}\" font-family=\"sans-serif\" font-size=\"3\" fill=\"#555\">Line: {scale} mm. Board: {board}</text>\n\
         </svg>\n",
        min = -MARGIN_MM,
        path = sheet.path,
    ))
}

/// One square more than inner corners along each side; the upper left one is black.
fn checkerboard((columns, rows): (usize, usize), square: f64) -> Sheet {
    let mut path = String::new();
    for row in 0..=rows {
        for column in (row % 2..=columns).step_by(2) {
            add_square(&mut path, (column as f64 * square, row as f64 * square), square);
        }
    }
    Sheet { size: ((columns + 1) as f64 * square, (rows + 1) as f64 * square), path }
}

fn tag_board(board: &TagBoard) -> Option<Sheet> {
    let side = board.side * 1e3;
    let cell = side / TAG_CELLS as f64;
    let (mut path, mut size) = (String::new(), (0.0_f64, 0.0_f64));
    for id in board.ids() {
        let [upper_left, ..] = board.corners(id)?.map(|corner| corner * 1e3);
        let cells = tag_cells(id)?;
        for (row, cells) in cells.iter().enumerate() {
            for (column, _) in cells.iter().enumerate().filter(|(_, is_white)| !**is_white) {
                let at = (upper_left.x + column as f64 * cell, upper_left.y + row as f64 * cell);
                add_square(&mut path, at, cell);
            }
        }
        size = (size.0.max(upper_left.x + side), size.1.max(upper_left.y + side));
    }
    Some(Sheet { size, path })
}

fn add_square(path: &mut String, (x, y): (f64, f64), side: f64) {
    // Writing to a string does not fail.
    let _ = write!(path, "M{x:.3} {y:.3}h{side:.3}v{side:.3}h-{side:.3}z");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_has_the_true_size() {
        let svg = board_svg(&"checkerboard:9x6:25mm".parse().unwrap()).unwrap();
        assert!(
            svg.contains("width=\"270.000mm\" height=\"203.000mm\"") && svg.contains("Line: 100 mm"),
            "{svg}"
        );
        assert_eq!(svg.matches('M').count() - 1, 35, "squares, and the line");
        let svg = board_svg(&"apriltag:6x6:88mm:0.3".parse().unwrap()).unwrap();
        assert!(svg.contains("width=\"680.000mm\""), "{svg}");
    }
}
