//! Several maps, each with its own frame.

pub(crate) mod map_collection;
pub(crate) mod map_merger;
pub(crate) mod sub_map;
pub(crate) mod submap_link;
pub(crate) mod trajectory;
