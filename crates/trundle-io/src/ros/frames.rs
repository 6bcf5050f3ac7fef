//! The tree of static transforms of a ROS 2 bag.

use super::messages::{MessagePose, Transform};
use std::collections::BTreeMap;
use trundle_core::Pose3;

/// The tree of frames that do not move against each other: the newest transform of each.
#[derive(Debug, Clone, Default, PartialEq)]
pub(in crate::ros) struct Frames {
    /// The parent of each child frame, and `parent_from_child`.
    parents: BTreeMap<String, (String, MessagePose)>,
}

/// Reason why the pose of one frame in another is unknown.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ros) enum NoTransform {
    /// No transforms lead from one to the other.
    Unconnected,
    /// A transform between them is invalid: its name and the reason.
    Broken(String),
}

/// Longest chain of frames; a longer one is a cycle. Source: ours.
const MAX_FRAME_CHAIN: usize = 100;

impl Frames {
    /// Adds a transform. A broken transform does not replace a good one.
    pub(in crate::ros) fn insert(&mut self, transform: Transform) {
        let Transform { parent, child, parent_from_child, .. } = transform;
        let is_good = |known: &(String, MessagePose)| known.1.is_ok();
        if parent_from_child.is_ok() || !self.parents.get(&child).is_some_and(is_good) {
            self.parents.insert(child, (parent, parent_from_child));
        }
    }

    /// `to_from_from`: the pose of frame `from` in frame `to`, if transforms lead from both to a common frame.
    pub(in crate::ros) fn between(&self, to: &str, from: &str) -> Result<Pose3, NoTransform> {
        let (up_to, up_from) = (self.chain(to), self.chain(from));
        let ancestor = up_from.iter().find_map(|(name, ancestor_from_from)| {
            let (_, ancestor_from_to) = up_to.iter().find(|(other, _)| other == name)?;
            Some((ancestor_from_to, ancestor_from_from))
        });
        let (ancestor_from_to, ancestor_from_from) = ancestor.ok_or(NoTransform::Unconnected)?;
        let good = |pose: &MessagePose| pose.clone().map_err(NoTransform::Broken);
        Ok(good(ancestor_from_to)?.inverse() * good(ancestor_from_from)?)
    }

    /// A frame and all its ancestors, each with its pose `above_from_frame`, or the broken transform on the path.
    fn chain(&self, frame: &str) -> Vec<(String, MessagePose)> {
        let mut chain = vec![(frame.to_owned(), Ok(Pose3::identity()))];
        while let Some((last, pose)) = chain.last().filter(|_| chain.len() < MAX_FRAME_CHAIN) {
            let Some((parent, parent_from_last)) = self.parents.get(last) else { break };
            let named = |problem: &String| format!("the transform {parent} > {last}: {problem}");
            let above = pose.clone().and_then(|pose| Ok(*parent_from_last.as_ref().map_err(named)? * pose));
            let next = (parent.clone(), above);
            chain.push(next);
        }
        chain
    }

    /// The names, for messages.
    pub(in crate::ros) fn names(&self) -> String {
        let all: Vec<String> =
            self.parents.iter().map(|(child, (parent, _))| format!("{parent} > {child}")).collect();
        if all.is_empty() { "none".to_owned() } else { all.join(", ") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Stamp, Vector3};

    fn link(parent: &str, child: &str, x: f64, roll: f64) -> Transform {
        let rotation = nalgebra::UnitQuaternion::from_euler_angles(roll, 0.0, 0.0);
        let parent_from_child = Ok(Pose3::new(rotation, Vector3::new(x, 0.0, 0.1)));
        Transform { stamp: Stamp::default(), parent: parent.into(), child: child.into(), parent_from_child }
    }

    #[test]
    fn a_laser_is_found_up_and_down_the_tree() {
        let mut frames = Frames::default();
        frames.insert(link("base_footprint", "base_link", 0.0, 0.0));
        frames.insert(link("base_link", "mast", 0.5, 0.0));
        frames.insert(link("mast", "laser", 0.25, std::f64::consts::PI));
        let pose = frames.between("base_link", "laser").unwrap();
        assert!((pose.translation - Vector3::new(0.75, 0.0, 0.2)).norm() < 1e-12);
        assert!((pose.rotate(Vector3::z()) + Vector3::z()).norm() < 1e-12, "upside down");
        assert!((frames.between("base_footprint", "laser").unwrap().translation.z - 0.3).abs() < 1e-12);
        assert!((frames.between("laser", "base_link").unwrap() * pose).log().norm() < 1e-12);
        assert_eq!(frames.between("base_link", "camera"), Err(NoTransform::Unconnected));
        assert_eq!(frames.between("x", "x"), Ok(Pose3::identity()));
    }

    #[test]
    fn a_ring_of_frames_ends() {
        let mut frames = Frames::default();
        frames.insert(link("a", "b", 0.0, 0.0));
        frames.insert(link("b", "a", 0.0, 0.0));
        assert_eq!(frames.between("c", "a"), Err(NoTransform::Unconnected));
        assert_eq!(frames.names(), "b > a, a > b");
    }

    #[test]
    fn a_broken_transform_is_named_unless_a_good_one_is_known() {
        let broken =
            Transform { parent_from_child: Err("no rotation".to_owned()), ..link("base", "laser", 0.0, 0.0) };
        let mut frames = Frames::default();
        frames.insert(broken.clone());
        let problem = NoTransform::Broken("the transform base > laser: no rotation".to_owned());
        assert_eq!(frames.between("base", "laser"), Err(problem));
        frames.insert(link("base", "laser", 0.5, 0.0));
        frames.insert(broken);
        assert!(frames.between("base", "laser").is_ok());
    }
}
