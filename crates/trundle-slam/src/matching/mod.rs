//! Features matched with points of the map, and the pose that these matches give.

pub(crate) mod alignment;
pub(crate) mod matched_pose;
pub(crate) mod point_match;
pub(crate) mod projection_search;
pub(crate) mod reference_frame;
