//! Buffer of recent odometry and measurements, ordered by stamp, with the belief after each entry.

use crate::{
    fusion::belief::{Belief, Measurement, Motion},
    fusion::correction::Correction,
    odometry::state::OdometryState,
    planar::transported,
};
use nalgebra::Vector3;
use std::collections::VecDeque;
use trundle_core::{Odometry, Pose2, Stamp};

/// The last seconds of odometry and measurements, ordered by stamp, with the belief after each entry.
///
/// A late measurement is inserted at its stamp, and all later beliefs are computed again. The newest belief therefore uses all measurements
/// in the order of their stamps, for any order of arrival.
#[derive(Debug, Clone)]
pub(crate) struct MeasurementBuffer {
    nodes: VecDeque<Node>,
    newest_odometry: Odometry,
    min_variances: Vector3<f64>,
}

/// One entry: a reading of the odometry, or a measurement.
#[derive(Debug, Clone)]
struct Node {
    stamp: Stamp,
    odometry: OdometryState,
    /// Standard deviation of the scale of turns since the entry before.
    scale_sigma: f64,
    measurement: Option<Measurement>,
    belief: Belief,
}

/// A stamp's position in the buffer, with odometry and belief at that stamp.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    index: usize,
    stamp: Stamp,
    pub(crate) odometry: OdometryState,
    scale_sigma: f64,
    pub(crate) belief: Belief,
}

impl MeasurementBuffer {
    /// A buffer that begins with `belief` at the stamp of `odometry`; `min_variances` bound the variances after updates.
    pub(crate) fn new(odometry: &Odometry, belief: Belief, min_variances: Vector3<f64>) -> Self {
        let node = Node {
            stamp: odometry.stamp,
            odometry: odometry.into(),
            scale_sigma: 0.0,
            measurement: None,
            belief,
        };
        Self { nodes: VecDeque::from([node]), newest_odometry: *odometry, min_variances }
    }

    /// Stamp and belief of the newest entry.
    pub(crate) fn newest(&self) -> (Stamp, &Belief) {
        let node = self.nodes.back().expect("invariant: a history is never empty");
        (node.stamp, &node.belief)
    }

    pub(crate) fn newest_odometry(&self) -> &Odometry {
        &self.newest_odometry
    }

    /// Adds odometry newer than the newest, whose turns have this standard deviation of the scale, and drops entries older than `length` s.
    pub(crate) fn push(&mut self, odometry: &Odometry, scale_sigma: f64, length: f64) {
        self.newest_odometry = *odometry;
        let index = self.index_after(odometry.stamp);
        let node = Node {
            stamp: odometry.stamp,
            odometry: odometry.into(),
            scale_sigma,
            measurement: None,
            belief: self.nodes[index - 1].belief,
        };
        self.nodes.insert(index, node);
        self.recompute_from(index);
        while self.nodes.len() > 2 && odometry.stamp - self.nodes[1].stamp > length {
            self.nodes.pop_front();
        }
    }

    /// Looks up a stamp: interpolated between two readings, extrapolated at most `max_ahead` s after the last one.
    pub(crate) fn find(&self, stamp: Stamp, max_ahead: f64) -> Result<Moment, Correction> {
        let oldest = self.nodes[0].stamp;
        if stamp < oldest {
            return Err(Correction::TooOld { by: oldest - stamp });
        }
        let index = self.index_after(stamp);
        let before = &self.nodes[index - 1];
        let scale_sigma = self.nodes.get(index).unwrap_or(before).scale_sigma;
        let odometry = match self.nodes.get(index) {
            _ if before.stamp == stamp => before.odometry,
            Some(after) => {
                let fraction = (stamp - before.stamp) / (after.stamp - before.stamp);
                before.odometry.towards(&after.odometry, fraction)
            }
            None => self.extrapolated(before, stamp, max_ahead)?,
        };
        let (pose, noise) = odometry.since(&before.odometry);
        let belief = before.belief.moved(&Motion { pose, noise, scale_sigma });
        Ok(Moment { index, stamp, odometry, scale_sigma, belief })
    }

    /// Inserts a measurement at a stamp just looked up, and recomputes the later beliefs.
    pub(crate) fn insert(&mut self, moment: &Moment, measurement: Measurement) {
        let Moment { index, stamp, odometry, scale_sigma, belief } = *moment;
        let measurement = Some(measurement);
        self.nodes.insert(index, Node { stamp, odometry, scale_sigma, measurement, belief });
        self.recompute_from(index);
    }

    /// Extrapolation by the newest twist; the next odometry reading adds the noise of that motion.
    fn extrapolated(&self, last: &Node, stamp: Stamp, max_ahead: f64) -> Result<OdometryState, Correction> {
        let ahead = stamp - self.newest_odometry.stamp;
        if ahead > max_ahead {
            return Err(Correction::TooNew { by: ahead });
        }
        let motion = Pose2::IDENTITY.advance(self.newest_odometry.twist, stamp - last.stamp);
        let covariance = transported(&last.odometry.covariance, &motion);
        Ok(OdometryState { pose: last.odometry.pose * motion, covariance })
    }

    fn index_after(&self, stamp: Stamp) -> usize {
        self.nodes.partition_point(|node| node.stamp <= stamp)
    }

    fn recompute_from(&mut self, index: usize) {
        for i in index..self.nodes.len() {
            let before = &self.nodes[i - 1];
            let (pose, noise) = self.nodes[i].odometry.since(&before.odometry);
            let moved = before.belief.moved(&Motion { pose, noise, scale_sigma: self.nodes[i].scale_sigma });
            let measurement = self.nodes[i].measurement;
            self.nodes[i].belief = measurement.map_or(moved, |m| moved.corrected(&m, &self.min_variances));
        }
    }
}
