//! Closed loop: plan, carry out one motion, measure at rest, decide again.
//!
//! Problem: poses are noisy and wheels lag. A manoeuvre carried out in open loop misses its goal, and endless correction oscillates. Idea:
//! after every motion the pose is averaged at rest, and the remaining motions are planned again. If one or two motions end within the
//! tolerance, they replace an exact manoeuvre. A robot at its goal remains at rest until an error exceeds the tolerance by a factor. A
//! search in parts starts from one pose and scene. It restarts if the robot is pushed, and its result is checked against the present
//! obstacles. The method of \[Hong24\] carries out its pair of a turn and a straight move before the next decision. Every step checks the
//! stopping distance along the motion; an obstacle within it sets the command to zero. Cost: one plan per motion, in parts per step, and
//! one closed-form query per step.

pub(crate) mod config;
mod motion_execution;
mod motion_planner;
mod near_goal;
mod pose_average;
pub(crate) mod positioner_loop;
pub(crate) mod report;
