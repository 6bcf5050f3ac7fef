//! Sufficiency of board views for a calibration.

use trundle_core::Vector2;

/// Coverage of the image and of the tilts of the board.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardCoverage {
    /// Views that were used.
    pub views: usize,
    /// Largest angle of the board to the image plane, deg.
    pub max_tilt_deg: f64,
    /// Fraction of the image's cells, 4 x 4, that hold corners, 0 to 1.
    pub cells: f64,
}

/// Cells along each side of the image. Source: ours.
const CELLS_PER_SIDE: usize = 4;
/// Number of views below which a warning is given. Source: \[Zhang00, fig. 2\]: the error falls slowly above ten.
const FEW_VIEWS: usize = 10;
/// Tilt below which a warning is given, deg. Source: \[Zhang00, fig. 3\]: the error is smallest at 45 deg.
const LOW_TILT_DEG: f64 = 25.0;
/// Fraction of cells below which a warning is given. Source: ours.
const FEW_CELLS: f64 = 0.6;

impl BoardCoverage {
    pub(super) fn of(
        views: usize,
        tilts_deg: impl Iterator<Item = f64>,
        pixels: impl Iterator<Item = Vector2>,
        (width, height): (usize, usize),
    ) -> Self {
        let mut seen = [[false; CELLS_PER_SIDE]; CELLS_PER_SIDE];
        let cell = |at: f64, size: usize| {
            ((at + 0.5) / size as f64 * CELLS_PER_SIDE as f64).clamp(0.0, CELLS_PER_SIDE as f64 - 1.0)
                as usize
        };
        for pixel in pixels {
            seen[cell(pixel.y, height)][cell(pixel.x, width)] = true;
        }
        let count = seen.iter().flatten().filter(|is_seen| **is_seen).count();
        Self {
            views,
            max_tilt_deg: tilts_deg.fold(0.0, f64::max),
            cells: count as f64 / (CELLS_PER_SIDE * CELLS_PER_SIDE) as f64,
        }
    }

    /// Advice, one sentence each; empty for sufficient views.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let Self { views, max_tilt_deg, cells } = *self;
        if views < FEW_VIEWS {
            warnings.push(format!("{views} images were used, expected {FEW_VIEWS} or more: take more"));
        }
        if max_tilt_deg < LOW_TILT_DEG {
            warnings.push(format!(
                "the board is tilted by {max_tilt_deg:.0} deg at most, expected {LOW_TILT_DEG} deg or more: the focal \
                 length is uncertain; tilt the board about both axes"
            ));
        }
        if cells < FEW_CELLS {
            warnings.push(format!(
                "corners lie in {:.0} % of the image, expected {:.0} % or more: the lens is uncertain; move the board to \
                 the borders",
                cells * 100.0,
                FEW_CELLS * 100.0
            ));
        }
        warnings
    }
}
