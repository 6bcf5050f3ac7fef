use crate::{
    Correction, Odometer,
    belief::{Belief, Measurement},
    planar::carried,
};
use nalgebra::Vector3;
use std::collections::VecDeque;
use trundle_core::{Odometry, Pose2, Stamp};

/// The last seconds of odometry and measurements, by time, with the belief after each.
///
/// A measurement that comes late is put in its place, and everything after it is reckoned again: the belief is that of
/// all measurements in the order of their stamps, whatever the order in which they came.
#[derive(Debug, Clone)]
pub(crate) struct History {
    nodes: VecDeque<Node>,
    newest_odometry: Odometry,
    least: Vector3<f64>,
}

/// One moment: of a reading of the odometry, or of a measurement.
#[derive(Debug, Clone)]
struct Node {
    stamp: Stamp,
    odometer: Odometer,
    measurement: Option<Measurement>,
    belief: Belief,
}

/// Where in the history a moment lies, and what was believed then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    index: usize,
    stamp: Stamp,
    pub(crate) odometer: Odometer,
    pub(crate) belief: Belief,
}

impl History {
    /// A history that begins with `belief` at the time of `odometry`; no update brings a variance below `least`.
    pub(crate) fn new(odometry: &Odometry, belief: Belief, least: Vector3<f64>) -> Self {
        let node = Node { stamp: odometry.stamp, odometer: odometry.into(), measurement: None, belief };
        Self { nodes: VecDeque::from([node]), newest_odometry: *odometry, least }
    }

    /// The belief at the newest moment, and that moment.
    pub(crate) fn newest(&self) -> (Stamp, &Belief) {
        let node = self.nodes.back().expect("invariant: a history is never empty");
        (node.stamp, &node.belief)
    }

    pub(crate) fn newest_odometry(&self) -> &Odometry {
        &self.newest_odometry
    }

    /// Takes in odometry newer than the newest, and forgets what is older than `length` s.
    pub(crate) fn push(&mut self, odometry: &Odometry, length: f64) {
        self.newest_odometry = *odometry;
        let index = self.index_after(odometry.stamp);
        let node = Node {
            stamp: odometry.stamp,
            odometer: odometry.into(),
            measurement: None,
            belief: self.nodes[index - 1].belief,
        };
        self.nodes.insert(index, node);
        self.reckon_from(index);
        while self.nodes.len() > 2 && odometry.stamp - self.nodes[1].stamp > length {
            self.nodes.pop_front();
        }
    }

    /// Finds a moment: between two readings on the arc between them, at most `most_ahead` s after the last.
    pub(crate) fn find(&self, stamp: Stamp, most_ahead: f64) -> Result<Moment, Correction> {
        let oldest = self.nodes[0].stamp;
        if stamp < oldest {
            return Err(Correction::TooOld { by: oldest - stamp });
        }
        let index = self.index_after(stamp);
        let before = &self.nodes[index - 1];
        let odometer = match self.nodes.get(index) {
            _ if before.stamp == stamp => before.odometer,
            Some(after) => {
                let fraction = (stamp - before.stamp) / (after.stamp - before.stamp);
                before.odometer.towards(&after.odometer, fraction)
            }
            None => self.extrapolated(before, stamp, most_ahead)?,
        };
        let (motion, noise) = odometer.since(&before.odometer);
        Ok(Moment { index, stamp, odometer, belief: before.belief.moved(&motion, &noise) })
    }

    /// Puts a measurement in at a moment just found, and reckons again what comes after.
    pub(crate) fn insert(&mut self, moment: &Moment, measurement: Measurement) {
        let Moment { index, stamp, odometer, belief } = *moment;
        self.nodes.insert(index, Node { stamp, odometer, measurement: Some(measurement), belief });
        self.reckon_from(index);
    }

    /// On with the newest twist; the noise of that way is counted when odometry tells of it.
    fn extrapolated(&self, last: &Node, stamp: Stamp, most_ahead: f64) -> Result<Odometer, Correction> {
        let ahead = stamp - self.newest_odometry.stamp;
        if ahead > most_ahead {
            return Err(Correction::TooNew { by: ahead });
        }
        let motion = Pose2::IDENTITY.advance(self.newest_odometry.twist, stamp - last.stamp);
        let covariance = carried(&last.odometer.covariance, &motion);
        Ok(Odometer { pose: last.odometer.pose * motion, covariance })
    }

    fn index_after(&self, stamp: Stamp) -> usize {
        self.nodes.partition_point(|node| node.stamp <= stamp)
    }

    fn reckon_from(&mut self, index: usize) {
        for i in index..self.nodes.len() {
            let before = &self.nodes[i - 1];
            let (motion, noise) = self.nodes[i].odometer.since(&before.odometer);
            let moved = before.belief.moved(&motion, &noise);
            let measurement = self.nodes[i].measurement;
            self.nodes[i].belief = measurement.map_or(moved, |m| moved.corrected(&m, &self.least));
        }
    }
}
