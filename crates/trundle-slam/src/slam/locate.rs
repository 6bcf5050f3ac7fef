use super::RgbdSlam;
use crate::claim::Claim;
use crate::component::Component;
use crate::found::Found;
use crate::frame::Frame;
use crate::places::Words;
use crate::relocalisation::{Placed, relocalise, unrivalled};
use crate::report::MapId;
use crate::tracker::Tracker;
use nalgebra::Matrix6;
use std::cell::OnceCell;
use trundle_core::{DepthImage, Pose3};

/// How far off a belief may be: the chi-square of six at the chance of five standard deviations.
const MOST_CHI2: f64 = 37.0;
/// Standard deviation of a belief whatever it says: m and rad.
const LEAST_SIGMA: f64 = 0.1;

/// A frame found in a map.
#[derive(Debug)]
pub(super) struct Sighting {
    pub map: MapId,
    pub found: Found,
}

impl RgbdSlam {
    /// Where `frame` is: by the last frame and the map; else by keyframes of that map which look alike; else by those of
    /// one of the other maps, which take turns.
    pub(super) fn locate(
        &mut self,
        frame: &Frame,
        depth: &DepthImage,
        prior: Option<Pose3>,
    ) -> Option<Sighting> {
        let words = OnceCell::new();
        let predicted = self.belief.predict(frame.stamp, prior);
        let is_first = self.belief.stamp.is_none();
        let is_blind = self.blind || !self.placed || (prior.is_none() && !is_first);
        let here = self.tracker(&self.active, frame, depth, &words);
        let tracked = self.last.as_ref().and_then(|last| {
            let reference = last.anchored.reference.map(|id| here.map.resolve(id).0);
            Found::from_last(&here, last.anchor(here.map), reference, predicted)
        });
        let is_believed = |found: &Found| is_blind || self.may_be_at(predicted, found.pose());
        if let Some(found) = tracked.filter(is_believed) {
            return Some(Sighting { map: self.active.id, found });
        }
        let recognised = relocalise(&here);
        if let Some(found) = self.believable(recognised, predicted, is_blind) {
            return Some(Sighting { map: self.active.id, found });
        }
        let other = self.resting.get(self.misses % self.resting.len().max(1)).filter(|_| is_blind)?;
        let found = unrivalled(relocalise(&self.tracker(other, frame, depth, &words)))?;
        Some(Sighting { map: other.id, found })
    }

    fn tracker<'a>(
        &'a self,
        component: &'a Component,
        frame: &'a Frame,
        depth: &'a DepthImage,
        words: &'a OnceCell<Words>,
    ) -> Tracker<'a> {
        Tracker {
            map: &component.map,
            places: &component.places,
            sensor: &self.sensor,
            view: self.view(depth),
            config: &self.config.tracking,
            frame,
            words,
            seed: self.seed(),
        }
    }

    /// Which of the places that look right to believe, for a camera that should be at `predicted`: one as near as the
    /// uncertainty lets it be, or one said by as many frames in a row as it takes to be at a loss. Wheels that know where
    /// they went outweigh a room that looks like another one, not a robot that was carried.
    fn believable(&mut self, recognised: Vec<Found>, predicted: Pose3, is_blind: bool) -> Option<Found> {
        let said_before = self.doubt.take();
        let is_near = |found: &Found| is_blind || self.may_be_at(predicted, found.pose());
        let (near, far): (Vec<Found>, Vec<Found>) = recognised.into_iter().partition(is_near);
        if !near.is_empty() {
            return unrivalled(near);
        }
        let found = unrivalled(far)?;
        self.doubt = said_before;
        let times = Claim::note(&mut self.doubt, (), found.pose() * predicted.inverse());
        (times >= self.config.tracking.patience).then_some(found)
    }

    /// Whether the uncertainty of the belief lets the camera be at `pose`, by its chi-square.
    fn may_be_at(&self, predicted: Pose3, pose: Pose3) -> bool {
        let off = (predicted.inverse() * pose).log();
        let covariance = self.belief.covariance + Matrix6::identity() * LEAST_SIGMA.powi(2);
        let information = covariance.try_inverse();
        information.is_some_and(|information| off.dot(&(information * off)) <= MOST_CHI2)
    }
}
