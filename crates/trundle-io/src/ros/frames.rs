//! The tree of static transforms of a ROS 2 bag.

use super::messages::Transform;
use std::collections::BTreeMap;
use trundle_core::Pose3;

/// The tree of frames that do not move against each other: the newest transform of each.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Frames {
    /// By child: its parent, and `parent_from_child`.
    parents: BTreeMap<String, (String, Pose3)>,
}

/// A robot has no longer chain of frames; a longer one is a ring.
const MAX_FRAME_CHAIN: usize = 100;

impl Frames {
    pub(super) fn insert(&mut self, transform: Transform) {
        let Transform { parent, child, parent_from_child, .. } = transform;
        self.parents.insert(child, (parent, parent_from_child));
    }

    /// `to_from_from`: where one frame sits in another, when transforms lead from both to one frame.
    pub(super) fn between(&self, to: &str, from: &str) -> Option<Pose3> {
        let (up_to, up_from) = (self.chain(to), self.chain(from));
        let meet = up_from.iter().find_map(|(name, meet_from_from)| {
            let (_, meet_from_to) = up_to.iter().find(|(other, _)| other == name)?;
            Some(meet_from_to.inverse() * *meet_from_from)
        })?;
        meet.is_finite().then_some(meet)
    }

    /// A frame and all above it, each with its pose `above_from_frame`.
    fn chain(&self, frame: &str) -> Vec<(String, Pose3)> {
        let mut chain = vec![(frame.to_owned(), Pose3::identity())];
        while let Some((last, pose)) = chain.last().filter(|_| chain.len() < MAX_FRAME_CHAIN) {
            let Some((parent, parent_from_last)) = self.parents.get(last) else { break };
            let next = (parent.clone(), *parent_from_last * *pose);
            chain.push(next);
        }
        chain
    }

    /// The names, for messages.
    pub(super) fn names(&self) -> String {
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
        let parent_from_child = Pose3::new(rotation, Vector3::new(x, 0.0, 0.1));
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
        assert_eq!(frames.between("base_link", "camera"), None);
        assert_eq!(frames.between("x", "x"), Some(Pose3::identity()));
    }

    #[test]
    fn a_ring_of_frames_ends() {
        let mut frames = Frames::default();
        frames.insert(link("a", "b", 0.0, 0.0));
        frames.insert(link("b", "a", 0.0, 0.0));
        assert_eq!(frames.between("c", "a"), None);
        assert_eq!(frames.names(), "b > a, a > b");
    }
}
