//! The poses of visual maps in one frame, by the odometry between them.

use super::odometry_path::OdometryPath;
use trundle_core::Pose3;
use trundle_optim::{PoseConstraint, PoseGraph, PoseGraphConfig};

/// Relative pose of two maps by the odometry between them.
#[derive(Debug, Clone)]
pub(super) struct MapLink(PoseConstraint);

impl MapLink {
    /// The link from a frame of map `from` to a frame of map `to`, each with its pose in its map; `None` if the path has no information.
    pub(super) fn new(from: (usize, Pose3), to: (usize, Pose3), path: &OdometryPath) -> Option<Self> {
        let camera_from_to = to.1.inverse();
        let from_to = (from.1 * path.motion * camera_from_to).renormalized();
        let information = path.information_at(camera_from_to)?;
        Some(Self(PoseConstraint { from: from.0, to: to.0, from_to, information }))
    }

    fn other_end(&self, map: usize) -> Option<(usize, Pose3)> {
        let PoseConstraint { from, to, from_to, .. } = self.0;
        match map {
            _ if map == from => Some((to, from_to)),
            _ if map == to => Some((from, from_to.inverse())),
            _ => None,
        }
    }
}

/// `world_from_map` of each map in the group of linked maps with the largest number of frames; the first map of the group is the world.
/// `None` for other maps. `frames` are the numbers of located frames per map.
pub(super) fn lay_out(frames: &[usize], links: &[MapLink]) -> Vec<Option<Pose3>> {
    let mut best: (usize, Vec<Option<Pose3>>) = (0, vec![None; frames.len()]);
    for first in 0..frames.len() {
        let chained = chained_from(first, frames.len(), links);
        let located =
            chained.iter().zip(frames).filter(|(pose, _)| pose.is_some()).map(|(_, count)| count).sum();
        // The loop reaches the first map of each group first.
        if located > best.0 {
            best = (located, chained);
        }
    }
    refined(&best.1, links).unwrap_or(best.1)
}

/// Poses of the maps linked with map `first` (the world), by one path of links each.
fn chained_from(first: usize, count: usize, links: &[MapLink]) -> Vec<Option<Pose3>> {
    let mut poses = vec![None; count];
    poses[first] = Some(Pose3::identity());
    let mut open = vec![(first, Pose3::identity())];
    while let Some((map, pose)) = open.pop() {
        for (other, map_from_other) in links.iter().filter_map(|link| link.other_end(map)) {
            if poses[other].is_none() {
                let placed = (pose * map_from_other).renormalized();
                poses[other] = Some(placed);
                open.push((other, placed));
            }
        }
    }
    poses
}

/// The placed maps by all links between them; `None` if the graph is not valid.
fn refined(chained: &[Option<Pose3>], links: &[MapLink]) -> Option<Vec<Option<Pose3>>> {
    let poses = chained.iter().map(|pose| pose.unwrap_or_default()).collect();
    // A map without a pose has no link to a map with one.
    let first = chained.iter().position(Option::is_some)?;
    let fixed: Vec<bool> = chained.iter().enumerate().map(|(i, pose)| i == first || pose.is_none()).collect();
    let is_placed = |link: &&MapLink| chained[link.0.from].is_some();
    let constraints = links.iter().filter(is_placed).map(|link| link.0.clone()).collect();
    let solution = PoseGraph::new(poses, &fixed, constraints).ok()?.solve(&PoseGraphConfig::default());
    Some(solution.poses.into_iter().zip(chained).map(|(pose, placed)| placed.map(|_| pose)).collect())
}
