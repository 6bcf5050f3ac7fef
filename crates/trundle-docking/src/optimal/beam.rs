use super::rays::{Ray, rays};
use super::search::Search;
use crate::flood::Guide;
use std::collections::BTreeMap;
use trundle_core::{Pose2, wrap_angle};

/// A base at rest after some legs.
#[derive(Debug, Clone, Copy)]
struct Node {
    pose: Pose2,
    /// Time so far, with the pause after the last motion, s.
    spent: f64,
    /// With the estimate of the rest, s.
    total: f64,
    /// Index of the node before; its own index for the start.
    parent: usize,
    /// The leg that led here.
    leg: (f64, f64),
}

/// Parts of a free way at which a leg may end.
const PARTS: [f64; 7] = [1.0, 0.8, 0.6, 0.42, 0.26, 0.13, 0.05];
/// What two estimates cost, in units of [`crate::Space::work`].
const ESTIMATE: u64 = 60;
/// Poses count as the same within a cell of this side, m, ...
const CELL: f64 = 0.02;
/// ... and this sector, rad.
const SECTOR: f64 = 0.06;
/// Headings tried at a node.
const HEADINGS: usize = 20;
/// Most legs of a manoeuvre.
const MOST_LEGS: usize = 6;
/// The same where a guide says that it is worth while.
const MOST_LEGS_GUIDED: usize = 60;

/// A guided beam goes on for so many layers once it has got through: what is found is shortened anyway.
const LAYERS_MORE: usize = 2;

/// Layer by layer, one more leg each, the most promising `width` nodes are carried on; from each the search is completed by
/// one or two exact legs. No more than `nodes` are expanded.
pub async fn beam(search: &mut Search<'_, '_>, width: usize, nodes: usize) {
    layers(search, width, MOST_LEGS, (nodes, usize::MAX), |search, pose| search.estimate(pose)).await;
}

/// The same with many legs, led by a guide that knows how the free poses hang together.
pub async fn guided_beam(search: &mut Search<'_, '_>, guide: &mut Guide<'_, '_>, width: usize, nodes: usize) {
    layers(search, width, MOST_LEGS_GUIDED, (nodes, LAYERS_MORE), |_, pose| guide.seconds(pose)).await;
}

async fn layers(
    search: &mut Search<'_, '_>,
    width: usize,
    most_legs: usize,
    (most_nodes, mut layers_more): (usize, usize),
    mut estimate: impl FnMut(&Search<'_, '_>, &Pose2) -> f64,
) {
    let start = search.task.start;
    let mut nodes = vec![Node { pose: start, spent: 0.0, total: 0.0, parent: 0, leg: (0.0, 0.0) }];
    let mut seen: BTreeMap<(i32, i32, i32), f64> = BTreeMap::new();
    let (mut layer, mut fan, mut expanded) = (vec![0], Vec::new(), 0);
    for _ in 1..most_legs {
        let mut children: Vec<Node> = Vec::new();
        for &index in &layer {
            let node = nodes[index];
            if node.total >= search.time_to_beat() || expanded >= most_nodes || search.is_spent() {
                continue;
            }
            expanded += 1;
            rays(&search.task, search.space, &node.pose, HEADINGS, 0.02, &mut fan).await;
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
    search: &Search<'_, '_>,
    node: &Node,
    index: usize,
    fan: &[Ray],
    children: &mut Vec<Node>,
    estimate: &mut impl FnMut(&Search<'_, '_>, &Pose2) -> f64,
) {
    let task = search.task;
    search.space.spend(fan.len() as u64 * PARTS.len() as u64 * ESTIMATE);
    for ray in fan {
        // The first ray is the heading it came on: going on along it is no new leg.
        if index > 0 && ray.cost == 0.0 {
            continue;
        }
        for limit in [ray.ahead, -ray.behind] {
            for way in PARTS.map(|part| part * limit).into_iter().filter(|way| way.abs() > 0.004) {
                let p = node.pose.position() + ray.direction * way;
                let spent = node.spent + ray.cost + task.drive_cost(way);
                if !task.in_region(p) || spent >= search.time_to_beat() {
                    continue;
                }
                let pose = Pose2 { x: p.x, y: p.y, theta: ray.heading };
                let total = spent + estimate(search, &pose) - task.limits.switch_time;
                children.push(Node { pose, spent, total, parent: index, leg: (ray.heading, way) });
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
    (round(pose.x, CELL), round(pose.y, CELL), round(wrap_angle(pose.theta), SECTOR))
}
