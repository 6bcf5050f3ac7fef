//! Ids of maps, keyframes and landmarks.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Id of a keyframe of the map. Ids rise in the order of creation and are never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct KeyframeId(u32);

/// Id of a landmark of the map. Ids rise in the order of creation and are never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct LandmarkId(u32);

macro_rules! arena_id {
    ($id:ident, $prefix:literal) => {
        impl $id {
            pub(crate) fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("invariant: an arena holds less than 2^32 things"))
            }

            /// Index in the arena, from 0.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $id {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }
    };
}

arena_id!(KeyframeId, "K");
arena_id!(LandmarkId, "L");

/// Id of a map with its own frame. Ids rise in the order of creation and are never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MapId(pub(crate) u32);

impl MapId {
    /// The id as a number.
    pub fn number(self) -> u32 {
        self.0
    }
}

impl fmt::Display for MapId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "M{}", self.0)
    }
}
