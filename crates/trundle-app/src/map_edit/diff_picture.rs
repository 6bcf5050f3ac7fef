//! The picture of two compared maps.

use trundle_core::{Cell, OccupancyGrid};
use trundle_mapping::map_edit::{CellPair, MapComparison};
use trundle_viz::{Color, MapPicture};

/// Cells of these values in this colour.
struct DiffKind {
    label: &'static str,
    pair: CellPair,
    color: Color,
}

/// The kinds of cells with a colour; other cells are those of the ground.
fn kinds() -> [DiffKind; 6] {
    use Cell::{Free, Occupied, Unknown};
    let kind = |label, pair, color| DiffKind { label, pair, color };
    [
        kind("occupied only in A, free in B", [Occupied, Free], Color::VERMILLION),
        kind("occupied only in A, unknown in B", [Occupied, Unknown], Color::ORANGE),
        kind("occupied only in B, free in A", [Free, Occupied], Color::BLUE),
        kind("occupied only in B, unknown in A", [Unknown, Occupied], Color::SKY),
        kind("free in A, unknown in B", [Free, Unknown], Color::YELLOW.alpha(110)),
        kind("free in B, unknown in A", [Unknown, Free], Color::GREEN.alpha(70)),
    ]
}

/// The differences over the cells on which the maps agree, with a legend. An 8-bit RGB PNG.
pub(super) fn diff_picture(found: &MapComparison) -> Vec<u8> {
    let ground = ground(found);
    let picture =
        MapPicture::over(&ground).cell_names(["free in both", "occupied in both", "unknown in both"]);
    let tinted = kinds().into_iter().fold(picture, |picture, kind| {
        let share = |pair: &CellPair| if *pair == kind.pair { 1.0 } else { 0.0 };
        let shares = found.pairs().iter().map(share).collect();
        picture.tint(kind.label, *found.geometry(), shares, kind.color)
    });
    tinted.to_png()
}

/// The cells on which the maps agree; white below the colours of the others.
fn ground(found: &MapComparison) -> OccupancyGrid {
    let cell = |pair: &CellPair| match pair {
        [a, b] if a == b => *a,
        _ => Cell::Free,
    };
    OccupancyGrid::new(*found.geometry(), found.pairs().iter().map(cell).collect())
        .expect("invariant: there is a pair for each cell")
}
