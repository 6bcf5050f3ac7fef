//! A corner of one level of the pyramid.

/// A corner of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corner {
    pub x: u16,
    pub y: u16,
    /// Smallest difference between the corner and its arc, grey values.
    pub score: u8,
}
