//! Loop closing: a place seen again takes the drift out of everything since.
//!
//! Problem: along a corridor the map drifts, and a place reached again stands beside its first image. Idea: a new
//! keyframe is compared with the old ones that look alike by their words, that it is not yet tied to, and that its drift
//! lets be near; where enough of the old points are found in it under one pose, and under no other nearly as many, the
//! keyframes between are moved by a pose graph, and landmarks that are there twice become one \[MurArtal17\]. A correction
//! larger than the drift explains must be asked for by several keyframes in a row, and be smaller than what parts two
//! rooms: a look-alike elsewhere is refused. Cost: a question to the index, and for each of at most three candidates a
//! matching under the words, about a ms each.

pub(crate) mod candidates;
pub(crate) mod config;
pub(crate) mod correction;
pub(crate) mod essential_graph;
pub(crate) mod loop_closer;
pub(crate) mod loop_closure;
pub(crate) mod loop_detector;
pub(crate) mod place_verification;
pub(crate) mod shared_landmark_information;
pub(crate) mod uncertainty_paths;
