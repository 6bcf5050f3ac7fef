//! The tree of coordinate frames that `tf` and `tf_static` describe.

use crate::convert::transform;
use crate::generated::geometry_msgs::TransformStamped;
use std::collections::BTreeMap;
use trundle_core::{Invalid, Pose3};

/// Maximum number of frames between a frame and its root: more indicate a loop. Source: ours.
const MAX_DEPTH: usize = 64;
/// Largest number of frames: a robot has some 50. Source: ours.
const MAX_FRAMES: usize = 1000;

/// The newest pose of each frame in its parent's frame.
#[derive(Debug, Default)]
pub struct FrameTree {
    /// Child to its parent and `parent_from_child`.
    parents: BTreeMap<String, (String, Pose3)>,
}

impl FrameTree {
    /// Takes a transform up.
    ///
    /// # Errors
    /// When its numbers are not finite, its rotation was never set, or the number of frames is at its limit.
    pub fn add(&mut self, stamped: &TransformStamped) -> Result<(), Invalid> {
        let (parent, child) = (bare(&stamped.header.frame_id), bare(&stamped.child_frame_id));
        let named = |error: Invalid| Invalid {
            field: format!("{} of the transform {parent} -> {child}", error.field),
            ..error
        };
        let pose = transform::from_ros(&stamped.transform).map_err(named)?;
        if self.parents.len() >= MAX_FRAMES && !self.parents.contains_key(child) {
            return Err(Invalid::new(
                "number of frames",
                self.parents.len() + 1,
                "",
                format!("at most {MAX_FRAMES}"),
            ));
        }
        self.parents.insert(child.to_owned(), (parent.to_owned(), pose));
        Ok(())
    }

    /// `from_frame`: the pose of `frame` in the frame `from`; `None` if the tree does not connect both.
    #[must_use]
    pub fn pose(&self, from: &str, frame: &str) -> Option<Pose3> {
        let (from, frame) = (bare(from), bare(frame));
        let (root, root_from_base) = self.to_root(from)?;
        let (other, root_from_frame) = self.to_root(frame)?;
        (root == other).then(|| root_from_base.inverse() * root_from_frame)
    }

    /// The root above a frame, and the frame's pose in it. `None` in a loop.
    fn to_root<'f>(&'f self, frame: &'f str) -> Option<(&'f str, Pose3)> {
        let (mut at, mut pose) = (frame, Pose3::identity());
        for _ in 0..MAX_DEPTH {
            let Some((parent, parent_from_child)) = self.parents.get(at) else { return Some((at, pose)) };
            pose = *parent_from_child * pose;
            at = parent;
        }
        None
    }
}

/// A frame's name without the leading slash of ROS 1.
fn bare(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Pose2, Stamp};

    fn link(parent: &str, child: &str, x: f64) -> TransformStamped {
        transform::planar_to_ros(&Pose2::new(x, 0.0, 0.0), Stamp::default(), parent, child)
    }

    #[test]
    fn poses_go_through_common_parents() {
        let mut tree = FrameTree::default();
        for (parent, child, x) in [
            ("base_footprint", "base_link", 0.5),
            ("base_link", "camera", 0.25),
            ("base_footprint", "laser", 1.0),
        ] {
            tree.add(&link(parent, child, x)).unwrap();
        }
        assert_eq!(tree.pose("base_link", "camera").unwrap().translation.x, 0.25);
        assert_eq!(tree.pose("/base_link", "laser").unwrap().translation.x, 0.5);
        assert_eq!(tree.pose("base_link", "elsewhere"), None);
    }

    #[test]
    fn loops_and_broken_transforms_are_refused() {
        let mut tree = FrameTree::default();
        tree.add(&link("a", "b", 1.0)).unwrap();
        tree.add(&link("b", "a", 1.0)).unwrap();
        assert_eq!(tree.pose("a", "b"), None);
        let error = tree.add(&link("a", "c", f64::NAN)).unwrap_err().to_string();
        assert!(error.starts_with("position.x of the transform a -> c is NaN"), "{error}");
        for i in 0..2000 {
            let _ = tree.add(&link("a", &format!("f{i}"), 0.0));
        }
        assert_eq!(tree.parents.len(), MAX_FRAMES);
    }
}
