//! The kinds of surface appearance: plain colours, prints, wood and others.

/// A kind of surface. Colours are sRGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// One uniform colour: hidden faces, and tests.
    Flat {
        /// The colour.
        color: [u8; 3],
    },
    /// Blotchy plaster hung with prints.
    Plaster {
        /// The wall's colour.
        color: [u8; 3],
        /// Share of the wall's fields (0.9 x 0.8 m) that hold a print, 0 to 1.
        prints: f32,
    },
    /// Wallpaper with a different motif every 0.16 m, and a few prints.
    Wallpaper {
        /// The ground colour.
        color: [u8; 3],
    },
    /// A brick wall.
    Bricks,
    /// Floor boards.
    Boards {
        /// The wood's colour.
        color: [u8; 3],
    },
    /// Floor tiles.
    Tiles {
        /// The tiles' colour.
        color: [u8; 3],
    },
    /// Ceiling boards with lamps.
    Ceiling,
    /// Rows of books.
    Books,
    /// A printed carton.
    Cardboard,
    /// Woven cloth.
    Fabric {
        /// The cloth's colour.
        color: [u8; 3],
    },
    /// Veneered furniture.
    Veneer {
        /// The wood's colour.
        color: [u8; 3],
    },
    /// Painted metal.
    Metal {
        /// The metal's colour.
        color: [u8; 3],
    },
    /// Evenly painted walls: poor in texture.
    Plain {
        /// The wall's colour.
        color: [u8; 3],
    },
    /// Carpet tiles.
    Carpet {
        /// The carpet's colour.
        color: [u8; 3],
    },
    /// Cast concrete: floors of halls, columns.
    Concrete {
        /// Main colour, sRGB.
        color: [u8; 3],
    },
    /// Corrugated sheets: walls of halls.
    Corrugated {
        /// Their colour.
        color: [u8; 3],
    },
    /// Worn floor paint.
    Marking {
        /// Main colour, sRGB.
        color: [u8; 3],
    },
    /// Slotted steel: uprights of racks.
    Slotted {
        /// Main colour, sRGB.
        color: [u8; 3],
    },
    /// Boxes stacked under film: goods on pallets.
    Goods {
        /// The boxes' colour.
        color: [u8; 3],
    },
    /// A door's leaf.
    Door {
        /// The wood's colour.
        color: [u8; 3],
    },
    /// A window by day.
    Window,
    /// One print over the whole face: posters, pictures, notice boards.
    Print,
    /// A sign with a glyph.
    Sign {
        /// The board's colour.
        color: [u8; 3],
    },
    /// Fitted kitchen fronts.
    Fronts {
        /// Their colour.
        color: [u8; 3],
    },
    /// A screen that is on.
    Screen,
}
