use super::{RgbdSlam, doubts::Doubts};
use crate::component::Component;
use crate::contradiction::Contradiction;
use crate::found::Found;
use crate::frame::Frame;
use crate::motion::{FASTEST_CAMERA, is_within};
use crate::places::Words;
use crate::refine::Known;
use crate::relocalisation::{Placed, relocalise, unrivalled};
use crate::report::MapId;
use crate::tracker::Tracker;
use nalgebra::Matrix6;
use std::cell::OnceCell;
use trundle_core::{DepthImage, Pose3, Stamp};

/// How far off a belief may be: the chi-square of six at the chance of five standard deviations.
const MOST_CHI2: f64 = 37.0;
/// Standard deviation of a belief whatever it says: m and rad.
const LEAST_SIGMA: f64 = 0.1;
/// What it may be off besides: m and rad.
const LEAST_REACH: f64 = 0.3;
/// So many frames must say the same of where a camera is that nobody told about: one showed a twin room in 0.7 of its view.
const SAID: usize = 2;

/// A frame found in a map.
#[derive(Debug)]
pub(super) struct Sighting {
    pub map: MapId,
    pub found: Found,
}

/// How far a camera can be from where it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reach {
    /// Nothing is known of where it is.
    Anywhere,
    /// Told how it moved: as far as that is uncertain.
    Told,
    /// As far as it gets in so many seconds.
    For(f64),
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
        self.doubts.pass(frame.stamp, prior.is_some());
        let words = OnceCell::new();
        let predicted = self.belief.predict(frame.stamp, prior);
        let reach = self.reach(frame.stamp, prior);
        let here = self.tracker(&self.active, frame, depth, &words);
        let tracked = self.last.as_ref().and_then(|last| {
            let reference = last.anchored.reference.map(|id| here.map.resolve(id).0);
            Found::from_last(&here, last.anchor(here.map), reference, predicted)
        });
        let is_believed = |found: &Found| self.may_be(reach, predicted, found.pose());
        if let Some(found) = tracked.filter(is_believed) {
            self.doubts = Doubts::default();
            let is_believed = self.contradiction.believes(frame.stamp, found.against_wheels());
            return is_believed.then_some(Sighting { map: self.active.id, found });
        }
        let (map, recognised) = (self.active.id, relocalise(&here));
        self.contradiction = Contradiction::default();
        if let Some(found) = self.believable(map, recognised, predicted, reach) {
            let found = found.aligned(&self.tracker(&self.active, frame, depth, &words), Known::Nothing);
            return Some(Sighting { map, found });
        }
        let other = self.frames as usize % self.resting.len().max(1);
        let component = self.resting.get(other).filter(|_| reach != Reach::Told)?;
        let (map, recognised) = (component.id, relocalise(&self.tracker(component, frame, depth, &words)));
        let found = self.believable(map, recognised, predicted, Reach::Anywhere)?;
        let found = found.aligned(&self.tracker(&self.resting[other], frame, depth, &words), Known::Nothing);
        Some(Sighting { map, found })
    }

    fn tracker<'a>(
        &'a self,
        component: &'a Component,
        frame: &'a Frame,
        depth: &'a DepthImage,
        words: &'a OnceCell<Words>,
    ) -> Tracker<'a> {
        let is_active = component.id == self.active.id;
        Tracker {
            map: &component.map,
            places: &component.places,
            sensor: &self.sensor,
            view: self.view(depth),
            config: &self.config.tracking,
            frame,
            rolled: self.rolled.filter(|_| is_active).and_then(|rolled| rolled.prior(&component.map)),
            words,
            seed: self.seed(),
        }
    }

    /// What the camera can have moved by since it was last located.
    fn reach(&self, now: Stamp, prior: Option<Pose3>) -> Reach {
        let is_first = self.belief.stamp.is_none();
        let elapsed = self.last.as_ref().map_or(f64::INFINITY, |last| (now - last.anchored.stamp).max(0.0));
        match prior {
            _ if !self.placed => Reach::Anywhere,
            None if is_first => Reach::Told,
            Some(_) if !self.blind => Reach::Told,
            _ => Reach::For(elapsed),
        }
    }

    /// Which of the places of a map that look right to believe, for a camera that should be at `predicted`: one in reach, if a second
    /// frame says it too where wheels do not, or one that as many frames say as it takes to be at a loss. Wheels that know where they
    /// went outweigh a room that looks like another one, not a robot that was carried. Frames that show no place do not count.
    fn believable(
        &mut self,
        map: MapId,
        mut recognised: Vec<Found>,
        predicted: Pose3,
        reach: Reach,
    ) -> Option<Found> {
        let is_near = |found: &Found| self.may_be(reach, predicted, found.pose());
        let needed = if !recognised.iter().any(|found| found.is_certain && is_near(found)) {
            // What is near and doubtful makes what is far off doubtful too.
            self.config.tracking.patience
        } else {
            recognised.retain(is_near);
            if reach == Reach::Told { 1 } else { SAID }
        };
        let found = unrivalled(recognised)?;
        let times = self.doubts.note(map, (found.pose(), predicted));
        (times >= needed).then_some(found)
    }

    /// Whether a camera that should be at `predicted` can be at `pose`.
    fn may_be(&self, reach: Reach, predicted: Pose3, pose: Pose3) -> bool {
        let offset = predicted.inverse() * pose;
        match reach {
            Reach::Anywhere => true,
            Reach::Told => self.is_uncertain_by(offset),
            Reach::For(elapsed) => is_within(offset, LEAST_REACH, FASTEST_CAMERA, elapsed),
        }
    }

    /// Whether the uncertainty of the belief lets the camera be off by so much, by its chi-square.
    fn is_uncertain_by(&self, offset: Pose3) -> bool {
        let off = offset.log();
        let covariance = self.belief.covariance + Matrix6::identity() * LEAST_SIGMA.powi(2);
        let information = covariance.try_inverse();
        information.is_some_and(|information| off.dot(&(information * off)) <= MOST_CHI2)
    }
}
