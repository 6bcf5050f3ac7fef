//! Representative points of cells in a search: their centres, their corners, or one of nine points of each.

use trundle_core::Vector2;

/// Offsets from the centre, half cells: the centre, the middles of the edges, the corners.
pub(crate) const OFFSETS: [(i8, i8); 9] =
    [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
/// Marks a cell without a free point.
pub(crate) const NO_POINT: u8 = u8::MAX;

/// The representative point of each cell.
pub(crate) enum CellPoints {
    Centres,
    UpperCorners,
    /// The centre if that is free, else the free point with the largest clearance.
    Free(FreePoints),
}

/// Index into [`OFFSETS`] by cell, or [`NO_POINT`].
pub(crate) struct FreePoints(pub(crate) Vec<u8>);

impl CellPoints {
    /// The representative point of a cell, relative to its centre, half cells.
    pub(crate) fn offset(&self, cell: usize) -> Vector2 {
        let choice = match self {
            Self::Centres => 0,
            Self::UpperCorners => return Vector2::repeat(1.0),
            Self::Free(FreePoints(choice)) => choice[cell],
        };
        OFFSETS.get(usize::from(choice)).map_or_else(Vector2::zeros, |at| vector(*at))
    }
}

impl FreePoints {
    /// Whether any point of a cell is free.
    pub(crate) fn is_free(&self, cell: usize) -> bool {
        self.0[cell] != NO_POINT
    }
}

pub(crate) fn vector((x, y): (i8, i8)) -> Vector2 {
    Vector2::new(f64::from(x), f64::from(y))
}
