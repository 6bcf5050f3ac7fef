//! Loop closing: a place seen again removes the drift of everything since.
//!
//! Problem: along a corridor the map drifts, and a place reached again stands beside its first image. Idea: a new keyframe is compared
//! with old ones that have similar bags of words, share no landmarks with it, and are within its drift. Where enough of the old points
//! are found in it under one pose, and under no other pose nearly as many, a pose graph moves the keyframes in between. Landmarks
//! that are there twice are fused \[MurArtal17\]. A correction larger than the drift explains must be found by several
//! keyframes in a row, and be smaller than the distance of look-alike rooms. Cost: a query of the index, and for each of at most three
//! candidates a matching under the vocabulary, about 1 ms each.

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
