//! Loop closing: a place in view again removes the drift of the loop.
//!
//! Problem: the map drifts along a corridor, and a place reached again appears twice. Idea: a new keyframe is compared with old ones that
//! have similar bags of words, share no landmarks with it, and are within its drift. If enough old points agree on one pose, and no other
//! pose has nearly as many, a pose graph moves the keyframes in between. Duplicate landmarks are fused \[MurArtal17\]. A correction larger
//! than the drift explains must be found by several keyframes in a row, and be smaller than the distance of look-alike rooms. Cost: one
//! query of the index, and about 1 ms of matching for each of at most three candidates.

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
