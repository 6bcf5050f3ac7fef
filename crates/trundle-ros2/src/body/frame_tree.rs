//! The tree of coordinate frames that `tf` and `tf_static` describe.

use crate::convert::transform;
use crate::generated::geometry_msgs::TransformStamped;
use std::collections::BTreeMap;
use trundle_core::{Invalid, Pose3};

/// Maximum number of frames between a frame and its root: more indicate a loop. Source: ours.
const MAX_DEPTH: usize = 64;
/// Largest number of frames: a robot has some 50. Source: ours.
const MAX_FRAMES: usize = 1000;

/// Difference up to which a repeated static transform counts as the same \[m\]. Source: ours, a tenth of a cell of the map.
const SAME_POSITION_M: f64 = 0.005;
/// Difference up to which a repeated static transform counts as the same \[rad\]. Source: ours; it moves a point at 2 m by a fifth of a cell.
const SAME_ROTATION_RAD: f64 = 0.005;

/// The pose of each frame in its parent's frame: the first one of a static frame, the newest one of others.
#[derive(Debug, Default)]
pub struct FrameTree {
    /// By the child.
    parents: BTreeMap<String, Link>,
}

#[derive(Debug)]
struct Link {
    parent: String,
    parent_from_child: Pose3,
    is_static: bool,
}

impl FrameTree {
    /// Takes a transform of `/tf` up. The stamp has no meaning.
    ///
    /// # Errors
    /// When its numbers are not finite, its rotation was never set, the number of frames is at its limit, or its frame is static elsewhere.
    pub fn add(&mut self, stamped: &TransformStamped) -> Result<(), Invalid> {
        self.insert(stamped, false)
    }

    /// Takes a transform of `/tf_static` up. The stamp has no meaning.
    ///
    /// # Errors
    /// As [`FrameTree::add`].
    pub fn add_static(&mut self, stamped: &TransformStamped) -> Result<(), Invalid> {
        self.insert(stamped, true)
    }

    fn insert(&mut self, stamped: &TransformStamped, is_static: bool) -> Result<(), Invalid> {
        let (parent, child) = (bare(&stamped.header.frame_id), bare(&stamped.child_frame_id));
        let named = |error: Invalid| Invalid {
            field: format!("{} of the transform {parent} -> {child}", error.field),
            ..error
        };
        let parent_from_child = transform::from_ros(&stamped.transform).map_err(named)?;
        let link = Link { parent: parent.to_owned(), parent_from_child, is_static };
        if let Some(first) = self.parents.get(child).filter(|first| first.is_static) {
            return first.require_same(&link, child);
        }
        if self.parents.len() >= MAX_FRAMES && !self.parents.contains_key(child) {
            return Err(Invalid::new(
                "number of frames",
                self.parents.len() + 1,
                "",
                format!("at most {MAX_FRAMES}"),
            ));
        }
        self.parents.insert(child.to_owned(), link);
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
            let Some(link) = self.parents.get(at) else { return Some((at, pose)) };
            pose = link.parent_from_child * pose;
            at = &link.parent;
        }
        None
    }
}

impl Link {
    /// Accepts another transform of this static frame if it is the same.
    fn require_same(&self, other: &Self, child: &str) -> Result<(), Invalid> {
        let Self { parent, .. } = self;
        let change = self.parent_from_child.inverse() * other.parent_from_child;
        let (moved, turned) = (change.translation.norm(), change.angle());
        let value = if *parent != other.parent {
            format!("from {} now", other.parent)
        } else if moved > SAME_POSITION_M || turned > SAME_ROTATION_RAD {
            format!("{moved:.3} m and {:.1} deg off its first value", turned.to_degrees())
        } else {
            return Ok(());
        };
        let expected =
            "no change: the first one is used; restart trundle after a sensor was mounted elsewhere";
        Err(Invalid::new(format!("static transform {parent} -> {child}"), value, "", expected))
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
    fn a_static_transform_keeps_its_first_pose_and_a_moving_one_its_newest() {
        let mut tree = FrameTree::default();
        let laser = |tree: &FrameTree| tree.pose("base", "laser").unwrap().translation.x;
        tree.add(&link("base", "laser", 0.1)).unwrap();
        tree.add(&link("base", "laser", 0.2)).unwrap();
        assert_eq!(laser(&tree), 0.2);
        tree.add_static(&link("base", "laser", 0.3)).unwrap();
        tree.add_static(&link("base", "laser", 0.304)).unwrap();
        let error = tree.add_static(&link("base", "laser", 0.4)).unwrap_err().to_string();
        let beginning =
            "static transform base -> laser is 0.100 m and 0.0 deg off its first value, expected no change";
        assert!(error.starts_with(beginning), "{error}");
        assert!(tree.add(&link("base", "laser", 50.0)).is_err());
        assert!(
            tree.add_static(&link("plate", "laser", 0.3))
                .unwrap_err()
                .to_string()
                .contains("is from plate now")
        );
        let mut turned = link("base", "laser", 0.3);
        turned.transform =
            transform::planar_to_ros(&Pose2::new(0.3, 0.0, 0.1), Stamp::default(), "", "").transform;
        assert!(tree.add_static(&turned).unwrap_err().to_string().contains("0.000 m and 5.7 deg off"));
        assert_eq!(laser(&tree), 0.3);
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
