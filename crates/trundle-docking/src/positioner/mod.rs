//! Closed loop: plan, carry out one motion, measure at rest, decide again.
//!
//! Problem: poses are noisy and wheels lag. A manoeuvre carried out in open loop ends beside its goal, and endless correction
//! oscillates. Idea: after every motion the pose is averaged at rest and the rest is planned again. Where one or two motions end
//! within the tolerance, these replace an exact manoeuvre. A robot at its goal stays until an error exceeds the tolerance by a
//! factor. A search in parts starts from one pose and scene: a robot that is pushed meanwhile starts again, and the result is
//! checked against the obstacles at its end. The method of \[Hong24\] carries out its pair of a turn and a straight move before it
//! decides again. Every step checks the stopping distance along the motion; with an obstacle there the command is zero at once.
//! Cost: one plan per motion, in parts per step, and one closed-form query per step.

pub(crate) mod config;
mod motion_execution;
mod motion_planner;
mod near_goal;
mod pose_average;
pub(crate) mod positioner_loop;
pub(crate) mod report;
