//! Obstacles that block a motion or a pose.

use crate::scene::cells::Cells;
use std::fmt;
use trundle_core::{Cell, Vector2};

/// An obstacle in contact with a motion or a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocker {
    /// Kind of the obstacle.
    pub thing: BlockerKind,
    /// Nearest point of the obstacle; for a cell, its centre. Map frame, m.
    pub at: Vector2,
}

/// Kind of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BlockerKind {
    /// An obstacle of a list, by its number; during a search on a grid, a segment of an outline.
    Listed(u32),
    /// An occupied cell of a grid.
    Occupied,
    /// An unknown cell of a grid.
    Unknown,
    /// The space outside the grid.
    OffMap,
}

impl Blocker {
    /// An obstacle of a list.
    pub(crate) fn listed(number: u32, at: Vector2) -> Self {
        Self { thing: BlockerKind::Listed(number), at }
    }

    /// The cell whose outline is in contact.
    pub(super) fn among(self, cells: &Cells) -> Self {
        match cells.at(self.at) {
            Some((Cell::Unknown, at)) => Self { thing: BlockerKind::Unknown, at },
            Some((_, at)) => Self { thing: BlockerKind::Occupied, at },
            None => Self { thing: BlockerKind::OffMap, ..self },
        }
    }
}

impl fmt::Display for Blocker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.thing {
            BlockerKind::Listed(number) => write!(f, "obstacle {number} at")?,
            BlockerKind::Occupied => write!(f, "the occupied cell at")?,
            BlockerKind::Unknown => write!(f, "the unknown cell at")?,
            BlockerKind::OffMap => write!(f, "the end of the map at")?,
        }
        write!(f, " ({:.3}, {:.3}) m", self.at.x, self.at.y)
    }
}
