//! Hybrid A* [Dolgov10] with Reeds-Shepp arcs [Reeds90], written plainly: a baseline for the table.
//!
//! Poses are expanded by arcs of minimum radius and straights, forward and backward, in cells of 4 cm and 6 deg. From every pose
//! a Reeds-Shepp word to the goal is tried: all words of the form curve-straight-curve and curve-curve-curve. A base whose
//! turn rate cannot leap stops where the curvature does, so that every piece runs from rest to rest; where the direction
//! changes there is the same pause as between the motions of docking.

use crate::dynamic_window::is_near;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
use std::f64::consts::{PI, TAU};
use trundle_core::{Pose2, Vector2, wrap_angle};
use trundle_docking::corridor::Problem;
use trundle_docking::{MotionLimits, ObstacleScene};

/// Minimum radius, m: what a base that prefers to roll takes in a corridor. Source: ours.
const RADIUS: f64 = 0.25;
const STEP: f64 = 0.05;
/// Between two looks for contact, m. Source: ours.
const SAMPLE: f64 = 0.005;
const MAX_NODES: usize = 20_000;

/// An arc: curvature (1/m) and signed length (m).
pub type PathPiece = (f64, f64);

/// A path to the goal that keeps `kept` (m) from everything; `None` if none was found.
pub fn plan(
    problem: &Problem,
    scene: &ObstacleScene,
    limits: &MotionLimits,
    kept: f64,
) -> Option<Vec<PathPiece>> {
    let free = |pose: &Pose2| !is_near(&problem.footprint, scene, pose, kept);
    let mut nodes: Vec<(Pose2, f64, usize, PathPiece)> = vec![(problem.start, 0.0, 0, (0.0, 0.0))];
    let mut seen: BTreeMap<(i32, i32, i32), f64> = BTreeMap::new();
    let mut queue = BinaryHeap::from([(Reverse(0_u64), 0_usize)]);
    let mut expanded = 0;
    while let Some((_, index)) = queue.pop() {
        let (pose, cost, ..) = nodes[index];
        if seen.get(&key(&pose)).is_some_and(|&best| best < cost) {
            continue;
        }
        expanded += 1;
        if expanded > MAX_NODES {
            return None;
        }
        if let Some(word) = reeds_shepp(&pose, &problem.goal, &free) {
            let mut pieces = pieces_to(&nodes, index);
            pieces.extend(word);
            return Some(joined(&pieces));
        }
        for curvature in [-1.0 / RADIUS, 0.0, 1.0 / RADIUS] {
            for distance in [STEP, -STEP] {
                let next = roll(&pose, curvature, distance);
                if (next.position() - problem.goal.position()).norm() > 2.5
                    || !is_free(&pose, &[(curvature, distance)], &free)
                {
                    continue;
                }
                let last = nodes[index].3;
                let turned = last.1 * distance < 0.0;
                let total = cost + STEP / limits.speed + if turned { limits.switch_time + 0.5 } else { 0.0 };
                if seen.get(&key(&next)).is_some_and(|&best| best <= total) {
                    continue;
                }
                seen.insert(key(&next), total);
                let rest = next
                    .distance(&problem.goal)
                    .max(RADIUS * wrap_angle(next.theta - problem.goal.theta).abs());
                queue.push((Reverse(((total + rest / limits.speed) * 1e6) as u64), nodes.len()));
                nodes.push((next, total, index, (curvature, distance)));
            }
        }
    }
    None
}

fn key(pose: &Pose2) -> (i32, i32, i32) {
    ((pose.x / 0.04).round() as i32, (pose.y / 0.04).round() as i32, (pose.theta / 0.105).round() as i32)
}

/// Where a base at `pose` stands after `distance` metres of an arc.
pub fn roll(pose: &Pose2, curvature: f64, distance: f64) -> Pose2 {
    pose.advance(trundle_core::Twist2::new(distance, distance * curvature), 1.0)
}

fn pieces_to(nodes: &[(Pose2, f64, usize, PathPiece)], mut index: usize) -> Vec<PathPiece> {
    let mut pieces = Vec::new();
    while index > 0 {
        pieces.push(nodes[index].3);
        index = nodes[index].2;
    }
    pieces.reverse();
    pieces
}

/// Neighbours of one arc as one piece.
fn joined(pieces: &[PathPiece]) -> Vec<PathPiece> {
    let mut list: Vec<PathPiece> = Vec::new();
    for &(curvature, distance) in pieces {
        match list.last_mut() {
            Some(last) if last.0 == curvature && last.1 * distance > 0.0 => last.1 += distance,
            _ => list.push((curvature, distance)),
        }
    }
    list
}

/// The shortest free word of three pieces, each a curve of minimum radius or a straight, all ways round.
fn reeds_shepp(from: &Pose2, to: &Pose2, free: &impl Fn(&Pose2) -> bool) -> Option<Vec<PathPiece>> {
    let mut words: Vec<Vec<PathPiece>> = Vec::new();
    let local = from.inverse() * *to;
    let goal = Pose2 { x: local.x / RADIUS, y: local.y / RADIUS, theta: local.theta };
    for mirrored in [false, true] {
        let seen = if mirrored { Pose2::new(goal.x, -goal.y, -goal.theta) } else { goal };
        let side = if mirrored { -1.0 } else { 1.0 };
        for backward in [false, true] {
            let seen = if backward { Pose2::new(-seen.x, seen.y, -seen.theta) } else { seen };
            let sense = if backward { -1.0 } else { 1.0 };
            for (curves, distances) in base_words(&seen) {
                let piece = |i: usize| (side * curves[i] / RADIUS, sense * distances[i] * RADIUS);
                words.push((0..3).map(piece).filter(|piece| piece.1.abs() > 1e-6).collect());
            }
        }
    }
    let length = |word: &[PathPiece]| word.iter().map(|piece| piece.1.abs()).sum::<f64>();
    words.retain(|word| length(word) < 2.0 && ends(from, word).distance(to) < 1e-3);
    words.sort_by(|a, b| length(a).total_cmp(&length(b)));
    words.into_iter().find(|word| is_free(from, word, free))
}

fn ends(from: &Pose2, word: &[PathPiece]) -> Pose2 {
    word.iter().fold(*from, |pose, &(curvature, distance)| roll(&pose, curvature, distance))
}

fn is_free(from: &Pose2, word: &[PathPiece], free: &impl Fn(&Pose2) -> bool) -> bool {
    let mut pose = *from;
    word.iter().all(|&(curvature, distance)| {
        let samples = (distance.abs() / SAMPLE).ceil().max(1.0) as usize;
        let good = (1..=samples).all(|i| free(&roll(&pose, curvature, distance * i as f64 / samples as f64)));
        pose = roll(&pose, curvature, distance);
        good
    })
}

/// Left-straight-left, left-straight-right and left-right-left on circles of radius one: curvatures and lengths.
fn base_words(goal: &Pose2) -> Vec<([f64; 3], [f64; 3])> {
    let (sin, cos) = goal.theta.sin_cos();
    let mut words = Vec::new();
    let turn = |angle: f64| wrap_angle(angle);
    // Left, straight, left.
    let v = Vector2::new(goal.x - sin, goal.y - 1.0 + cos);
    let t = v.y.atan2(v.x);
    words.push(([1.0, 0.0, 1.0], [turn(t), v.norm(), turn(goal.theta - t)]));
    // Left, straight, right.
    let v = Vector2::new(goal.x + sin, goal.y - 1.0 - cos);
    if v.norm() >= 2.0 {
        let u = (v.norm_squared() - 4.0).sqrt();
        let t = v.y.atan2(v.x) + 2.0_f64.atan2(u);
        words.push(([1.0, 0.0, -1.0], [turn(t), u, turn(t - goal.theta)]));
    }
    // Left, right backward, left.
    let v = Vector2::new(goal.x - sin, goal.y - 1.0 + cos);
    if v.norm() <= 4.0 {
        let u = -2.0 * (v.norm() / 4.0).asin();
        let t = turn(v.y.atan2(v.x) + u / 2.0 + PI);
        words.push(([1.0, -1.0, 1.0], [t, u, turn(goal.theta - t + u)]));
    }
    words
        .into_iter()
        .filter(|(_, distances)| distances.iter().all(|distance| distance.abs() < TAU + 10.0))
        .collect()
}
