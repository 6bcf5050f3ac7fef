//! Place and time of a sensor: its pose on the base, and whether its clock is that of the odometry.

use crate::ros::contents::Contents;
use crate::ros::frames::NoTransform;
use trundle_core::{Pose3, Stamp};

/// Frames on the floor below the base; the first existing one is used. Source: REP 105, REP 120.
const BASE_FRAMES: [&str; 2] = ["base_footprint", "base_link"];
/// Time before and after the odometry from which on a stamp is of another clock \[s\]. Source: ours; drivers start within seconds.
const MAX_TIME_BESIDE_S: f64 = 10.0;

/// The names of the base's frame, the usual ones first; `own` is that of the odometry.
pub(in crate::ros) fn bases(own: Option<&str>) -> impl Iterator<Item = &str> {
    BASE_FRAMES.into_iter().chain(own)
}

/// Frames and time of the base.
#[derive(Clone, Copy)]
pub(in crate::ros) struct BasePlace<'a> {
    /// The transforms.
    pub(in crate::ros) contents: &'a Contents,
    /// The frame whose pose the odometry is.
    pub(in crate::ros) base: Option<&'a str>,
    /// Stamps of the first and the last odometry.
    pub(in crate::ros) times: (Stamp, Stamp),
}

impl BasePlace<'_> {
    /// The pose of a sensor's frame on the base.
    ///
    /// # Errors
    /// With a sentence: when no transform gives the pose.
    pub(super) fn base_from(&self, frame: &str) -> Result<Pose3, String> {
        let mut broken = None;
        for base in bases(self.base) {
            match self.contents.transform(base, frame) {
                Ok(pose) => return Ok(pose),
                Err(NoTransform::Broken(problem)) => broken = Some(problem),
                Err(NoTransform::Unconnected) => {}
            }
        }
        let base = self.base.unwrap_or("base_link");
        Err(broken.unwrap_or_else(|| {
            format!("no transform leads from {base} to its frame '{frame}', expected one on /tf_static")
        }))
    }

    /// Refuses a stamp of another clock than the odometry's.
    ///
    /// # Errors
    /// With a sentence that has the stamp and the time of the odometry.
    pub(super) fn require_clock(&self, stamp: Stamp) -> Result<(), String> {
        let (first, last) = self.times;
        if first - stamp <= MAX_TIME_BESIDE_S && stamp - last <= MAX_TIME_BESIDE_S {
            return Ok(());
        }
        Err(format!(
            "its stamp is {stamp} s, the odometry is from {first} s to {last} s, expected one clock for both"
        ))
    }
}
