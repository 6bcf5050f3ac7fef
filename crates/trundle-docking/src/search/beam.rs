//! Beam search over legs.

use crate::connectivity_proof::time_estimate::TimeEstimate;
use crate::search::leg_search::LegSearch;
use crate::search::rays::{Ray, rays};
use std::collections::BTreeMap;
use trundle_core::{Pose2, wrap_angle};

/// A base at rest after some legs.
#[derive(Debug, Clone, Copy)]
struct Node {
    pose: Pose2,
    /// Time so far, with the pause after the last motion, s.
    spent: f64,
    /// Time so far plus the estimated rest, s.
    total: f64,
    /// Index of the previous node; its own index for the start.
    parent: usize,
    /// The leg that led here.
    leg: (f64, f64),
}

/// Parts of a free distance at which a leg may end. Source: ours.
const LEG_PARTS: [f64; 7] = [1.0, 0.8, 0.6, 0.42, 0.26, 0.13, 0.05];
/// Counted cost of two estimates, in units of [`crate::ContactSpace::work`]. Source: ours.
const ESTIMATE_COST: u64 = 60;
/// Side of the cells in which two poses count as equal, m. Source: ours.
const SAME_POSE_CELL_M: f64 = 0.02;
/// Width of the sectors in which two headings count as equal, rad. Source: ours.
const SAME_POSE_SECTOR_RAD: f64 = 0.06;
/// Number of headings tried at a node. Source: ours.
const NODE_HEADINGS: usize = 20;
/// Largest number of legs of a manoeuvre. Source: ours.
const MAX_LEGS: usize = 6;
/// Largest number of legs in the search led by the connectivity. Source: ours.
const MAX_LEGS_GUIDED: usize = 60;

/// Number of further layers of a guided beam after the first solution: the result is shortened anyway. Source: ours.
const EXTRA_LAYERS: usize = 2;

/// Beam search: each layer adds one leg, and the best `width` nodes continue. From each node the search is completed by one or two exact
/// legs. At most `nodes` are expanded.
pub async fn beam(search: &mut LegSearch<'_, '_>, width: usize, nodes: usize) {
    layers(search, width, MAX_LEGS, (nodes, usize::MAX), |search, pose| search.estimate(pose)).await;
}

/// Beam search with many legs, led by the estimated time over connected poses.
pub async fn guided_beam(
    search: &mut LegSearch<'_, '_>,
    guide: &mut TimeEstimate<'_, '_>,
    width: usize,
    nodes: usize,
) {
    layers(search, width, MAX_LEGS_GUIDED, (nodes, EXTRA_LAYERS), |_, pose| guide.seconds(pose)).await;
}

async fn layers(
    search: &mut LegSearch<'_, '_>,
    width: usize,
    max_legs: usize,
    (max_nodes, mut layers_more): (usize, usize),
    mut estimate: impl FnMut(&LegSearch<'_, '_>, &Pose2) -> f64,
) {
    let start = search.query.start;
    let mut nodes = vec![Node { pose: start, spent: 0.0, total: 0.0, parent: 0, leg: (0.0, 0.0) }];
    let mut seen: BTreeMap<(i32, i32, i32), f64> = BTreeMap::new();
    let (mut layer, mut fan, mut expanded) = (vec![0], Vec::new(), 0);
    for _ in 1..max_legs {
        let mut children: Vec<Node> = Vec::new();
        for &index in &layer {
            let node = nodes[index];
            if node.total >= search.time_to_beat() || expanded >= max_nodes || search.is_spent() {
                continue;
            }
            expanded += 1;
            rays(&search.query, search.space, &node.pose, NODE_HEADINGS, 0.02, &mut fan).await;
            if index > 0 {
                search.complete(&node.pose, &fan, &legs_to(&nodes, index), node.spent).await;
            }
            spread(search, &node, index, &fan, &mut children, &mut estimate);
        }
        if search.best.is_some() {
            if layers_more == 0 {
                break;
            }
            layers_more -= 1;
        }
        children.sort_by(|a, b| a.total.total_cmp(&b.total));
        layer.clear();
        for child in children {
            if child.total >= search.time_to_beat() {
                break;
            }
            let key = key_of(&child.pose);
            if seen.get(&key).is_some_and(|&spent| spent <= child.spent + 1e-9) {
                continue;
            }
            if layer.len() >= width {
                break;
            }
            seen.insert(key, child.spent);
            layer.push(nodes.len());
            nodes.push(child);
        }
        if layer.is_empty() {
            break;
        }
    }
}

/// The nodes one leg beyond a node.
fn spread(
    search: &LegSearch<'_, '_>,
    node: &Node,
    index: usize,
    fan: &[Ray],
    children: &mut Vec<Node>,
    estimate: &mut impl FnMut(&LegSearch<'_, '_>, &Pose2) -> f64,
) {
    let query = search.query;
    search.space.spend(fan.len() as u64 * LEG_PARTS.len() as u64 * ESTIMATE_COST);
    for ray in fan {
        // The first ray is the heading of the last leg: continuing along it is not a new leg.
        if index > 0 && ray.cost == 0.0 {
            continue;
        }
        for limit in [ray.ahead, -ray.behind] {
            for distance in
                LEG_PARTS.map(|part| part * limit).into_iter().filter(|distance| distance.abs() > 0.004)
            {
                let p = node.pose.position() + ray.direction * distance;
                let spent = node.spent + ray.cost + query.drive_cost(distance);
                if !query.in_region(p) || spent >= search.time_to_beat() {
                    continue;
                }
                let pose = Pose2 { x: p.x, y: p.y, theta: ray.heading };
                let total = spent + estimate(search, &pose) - query.limits.switch_time;
                children.push(Node { pose, spent, total, parent: index, leg: (ray.heading, distance) });
            }
        }
    }
}

fn legs_to(nodes: &[Node], mut index: usize) -> Vec<(f64, f64)> {
    let mut legs = Vec::new();
    while index > 0 {
        legs.push(nodes[index].leg);
        index = nodes[index].parent;
    }
    legs.reverse();
    legs
}

fn key_of(pose: &Pose2) -> (i32, i32, i32) {
    let round = |x: f64, by: f64| (x / by).round() as i32;
    (
        round(pose.x, SAME_POSE_CELL_M),
        round(pose.y, SAME_POSE_CELL_M),
        round(wrap_angle(pose.theta), SAME_POSE_SECTOR_RAD),
    )
}
