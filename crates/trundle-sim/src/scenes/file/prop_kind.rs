//! The kinds of objects and surface appearances that a scene file can name.

use crate::materials::Paint;
use serde::{Deserialize, Serialize};

/// Kind of a prop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PropKind {
    /// A box.
    Box,
    /// An upright cylinder.
    Cylinder,
    /// A table on four legs.
    Table,
    /// A chair facing along its x axis.
    Chair,
    /// A round stool.
    Stool,
    /// A sofa facing along its x axis.
    Sofa,
    /// A bed, its head at its -x.
    Bed,
    /// A bookshelf, its books toward its -y.
    Shelf,
    /// A cabinet.
    Cabinet,
    /// A carton.
    Carton,
    /// A round bin.
    Bin,
    /// A bush in a pot.
    Plant,
    /// A loaded pallet.
    Pallet,
}

impl PropKind {
    /// Size when none is given: x, y, z, m.
    pub fn default_size(self) -> [f64; 3] {
        match self {
            Self::Box => [0.4, 0.4, 0.4],
            Self::Cylinder => [0.3, 0.3, 0.5],
            Self::Table => [1.2, 0.8, 0.74],
            Self::Chair => [0.45, 0.45, 0.9],
            Self::Stool => [0.36, 0.36, 0.45],
            Self::Sofa => [0.85, 1.7, 0.82],
            Self::Bed => [2.05, 1.5, 0.5],
            Self::Shelf => [1.2, 0.32, 1.9],
            Self::Cabinet => [0.9, 0.46, 1.15],
            Self::Carton => [0.45, 0.35, 0.4],
            Self::Bin => [0.3, 0.3, 0.42],
            Self::Plant => [0.52, 0.52, 1.21],
            Self::Pallet => [1.2, 0.8, 1.0],
        }
    }

    /// Whether width and depth must be equal.
    pub(super) fn is_round(self) -> bool {
        matches!(self, Self::Cylinder | Self::Stool | Self::Bin | Self::Plant)
    }

    /// Whether a paint may be chosen: furniture brings its own.
    pub(super) fn takes_paint(self) -> bool {
        matches!(self, Self::Box | Self::Cylinder)
    }
}

/// A paint by name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PaintName {
    /// One uniform colour.
    Flat,
    /// Blotchy plaster.
    Plaster,
    /// Plaster hung with prints.
    Prints,
    /// Wallpaper.
    Wallpaper,
    /// Bricks.
    Bricks,
    /// Boards.
    Boards,
    /// Tiles.
    Tiles,
    /// Rows of books.
    Books,
    /// A printed carton.
    Cardboard,
    /// Woven cloth.
    Fabric,
    /// Veneer.
    #[default]
    Veneer,
    /// Painted metal.
    Metal,
    /// An even wall.
    Plain,
    /// Carpet tiles.
    Carpet,
    /// Concrete.
    Concrete,
    /// Corrugated sheets.
    Corrugated,
    /// Floor paint.
    Marking,
    /// Boxes under film.
    Goods,
    /// A door's leaf.
    Door,
    /// A window.
    Window,
    /// One print per face.
    Print,
    /// A sign.
    Sign,
    /// Fitted fronts.
    Fronts,
    /// A screen.
    Screen,
}

impl PaintName {
    /// The paint in a colour, if it has one.
    pub(super) fn paint(self, color: [u8; 3]) -> Paint {
        match self {
            Self::Flat => Paint::Flat { color },
            Self::Plaster => Paint::Plaster { color, prints: 0.0 },
            Self::Prints => Paint::Plaster { color, prints: 0.8 },
            Self::Wallpaper => Paint::Wallpaper { color },
            Self::Bricks => Paint::Bricks,
            Self::Boards => Paint::Boards { color },
            Self::Tiles => Paint::Tiles { color },
            Self::Books => Paint::Books,
            Self::Cardboard => Paint::Cardboard,
            Self::Fabric => Paint::Fabric { color },
            Self::Veneer => Paint::Veneer { color },
            Self::Metal => Paint::Metal { color },
            Self::Plain => Paint::Plain { color },
            Self::Carpet => Paint::Carpet { color },
            Self::Concrete => Paint::Concrete { color },
            Self::Corrugated => Paint::Corrugated { color },
            Self::Marking => Paint::Marking { color },
            Self::Goods => Paint::Goods { color },
            Self::Door => Paint::Door { color },
            Self::Window => Paint::Window,
            Self::Print => Paint::Print,
            Self::Sign => Paint::Sign { color },
            Self::Fronts => Paint::Fronts { color },
            Self::Screen => Paint::Screen,
        }
    }
}
