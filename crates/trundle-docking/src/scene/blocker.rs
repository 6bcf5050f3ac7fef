use super::cells::Cells;
use std::fmt;
use trundle_core::{Cell, Vector2};

/// What a motion or a pose meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocker {
    /// What it is.
    pub thing: Thing,
    /// Its nearest point; of a cell, its middle. Map frame, m.
    pub at: Vector2,
}

/// What stands in the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thing {
    /// One of a list of obstacles, by its place; of a grid, while a search goes on, a piece of an outline.
    Listed(u32),
    /// An occupied cell of a grid.
    Occupied,
    /// An unknown cell of a grid.
    Unknown,
    /// All that is off the grid.
    OffMap,
}

impl Blocker {
    /// One of a list.
    pub(crate) fn listed(number: u32, at: Vector2) -> Self {
        Self { thing: Thing::Listed(number), at }
    }

    /// The cell of which it is an outline.
    pub(super) fn among(self, cells: &Cells) -> Self {
        match cells.at(self.at) {
            Some((Cell::Unknown, at)) => Self { thing: Thing::Unknown, at },
            Some((_, at)) => Self { thing: Thing::Occupied, at },
            None => Self { thing: Thing::OffMap, ..self },
        }
    }
}

impl fmt::Display for Blocker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.thing {
            Thing::Listed(number) => write!(f, "obstacle {number} at")?,
            Thing::Occupied => write!(f, "the occupied cell at")?,
            Thing::Unknown => write!(f, "the unknown cell at")?,
            Thing::OffMap => write!(f, "the end of the map at")?,
        }
        write!(f, " ({:.3}, {:.3}) m", self.at.x, self.at.y)
    }
}
