use crate::anchor::Anchor;
use crate::closing::{LoopCloser, LoopClosure};
use crate::config::SlamConfig;
use crate::found::Found;
use crate::frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::keyframe_policy::with_depth;
use crate::local_map::View;
use crate::map::LandmarkMap;
use crate::mapping::Mapper;
use crate::motion::{Belief, carried};
use crate::places::Places;
use crate::relocalisation::relocalise;
use crate::report::{SeenFeature, TrackReport, Tracking};
use crate::search::Projection;
use crate::sensor::Sensor;
use crate::tracker::Tracker;
use crate::trajectory::Anchored;
use nalgebra::Matrix6;
use std::cell::OnceCell;
use std::sync::Arc;
use trundle_core::{DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Stamp, Vector3, gray_from_color};
use trundle_vision::{Features, OrbExtractor, Vocabulary};

/// RGB-D SLAM: one image in, the camera's pose out; keeps the landmark map. See the crate's documentation.
///
/// Synchronous and deterministic: the same images, priors and configuration give the same bits.
#[derive(Debug)]
pub struct RgbdSlam {
    config: SlamConfig,
    sensor: Sensor,
    extractor: OrbExtractor,
    map: LandmarkMap,
    places: Places,
    belief: Belief,
    /// The last frame that was located.
    last: Option<Located>,
    /// Frames since then.
    misses: usize,
    history: Vec<(Anchored, Tracking)>,
    seen: Vec<SeenFeature>,
}

/// A frame whose pose was found.
#[derive(Debug)]
struct Located {
    frame: Frame,
    landmarks: Vec<Option<LandmarkId>>,
    anchored: Anchored,
}

impl RgbdSlam {
    /// An empty map for images of this camera. The first keyframe is at the identity.
    ///
    /// # Errors
    /// When the configuration is invalid.
    pub fn new(camera: PinholeCamera, config: SlamConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let extractor = OrbExtractor::new(config.orb.clone())?;
        let scale_factors = extractor.scale_factors().to_vec();
        let sensor = Sensor::new(camera, scale_factors, config.tracking.pixel_sigma);
        Ok(Self {
            config,
            sensor,
            extractor,
            map: LandmarkMap::default(),
            places: Places::new(Vocabulary::builtin()),
            belief: Belief::at(Pose3::identity()),
            last: None,
            misses: 0,
            history: vec![],
            seen: vec![],
        })
    }

    /// The same with another vocabulary; call it before the first image.
    #[must_use]
    pub fn with_vocabulary(mut self, vocabulary: Arc<Vocabulary>) -> Self {
        self.places = Places::new(vocabulary);
        self.places.follow(&self.map);
        self
    }

    /// The same with the camera at `visual_from_camera` at the start; call it before the first image.
    #[must_use]
    pub fn starting_at(mut self, visual_from_camera: Pose3) -> Self {
        self.belief = Belief::at(visual_from_camera);
        self
    }

    /// Locates one image. `prior` is the motion since the last image given, `previous_camera_from_camera`, as wheels and
    /// gyro know it; without it the camera is taken to go on as it went. An image of another size than the camera's, or
    /// with nothing in it, is an image without features: the report says that it was not located.
    pub fn step(&mut self, image: &RgbdImage, prior: Option<Pose3>) -> TrackReport {
        let camera = &self.sensor.camera;
        let fits = image.color().width() == camera.width() && image.color().height() == camera.height();
        let features =
            if fits { self.extractor.extract(&gray_from_color(image.color())) } else { Features::default() };
        self.step_with_features(image.stamp(), features, image.depth(), prior)
    }

    /// The same with features found elsewhere, by an extractor of the same configuration: in another thread, say.
    pub fn step_with_features(
        &mut self,
        stamp: Stamp,
        features: Features,
        depth: &DepthImage,
        prior: Option<Pose3>,
    ) -> TrackReport {
        let prior = prior.filter(Pose3::is_finite);
        let frame = Frame::new(stamp, features, depth, &self.sensor, &self.config.depth);
        match self.locate(&frame, depth, prior) {
            Some(found) => self.accept(frame, found),
            None => self.miss(frame, depth, prior),
        }
    }

    /// Pose of every frame that was not lost, in the order of `step`: `visual_from_camera` by the map as it is now.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose3)> {
        let kept = self.history.iter().filter(|(_, tracking)| *tracking != Tracking::Lost);
        kept.map(|(frame, _)| (frame.stamp, frame.visual_from_camera(&self.map))).collect()
    }

    /// All landmarks, visual frame, m, in the order of their making.
    pub fn landmarks(&self) -> impl Iterator<Item = Vector3> + '_ {
        self.map.landmarks().map(|(_, landmark)| landmark.position)
    }

    /// All keyframes: when, and `visual_from_camera`, in the order of their making.
    pub fn keyframes(&self) -> impl Iterator<Item = (KeyframeId, Stamp, Pose3)> + '_ {
        self.map.keyframes().map(|(id, k)| (id, k.frame.stamp, k.visual_from_camera))
    }

    /// The features of the last image.
    pub fn last_features(&self) -> &[SeenFeature] {
        &self.seen
    }

    fn view<'a>(&'a self, depth: &'a DepthImage) -> View<'a> {
        let tracking = &self.config.tracking;
        View {
            sensor: &self.sensor,
            depth: (depth, &self.config.depth),
            window: tracking.map_window_px,
            most: tracking.most_landmarks,
        }
    }

    /// Where `frame` is, by the last frame and the map, or by keyframes that look alike.
    fn locate(&self, frame: &Frame, depth: &DepthImage, prior: Option<Pose3>) -> Option<Found> {
        let words = OnceCell::new();
        let tracker = Tracker {
            map: &self.map,
            places: &self.places,
            sensor: &self.sensor,
            view: self.view(depth),
            config: &self.config.tracking,
            frame,
            words: &words,
            seed: self.config.seed.wrapping_add(self.history.len() as u64),
        };
        let by_last = self.last.as_ref().and_then(|last| {
            let reference = last.anchored.reference.map(|id| self.map.resolve(id).0);
            let predicted = self.belief.predict(frame.stamp, prior);
            Found::from_last(&tracker, last.anchor(&self.map), reference, predicted)
        });
        by_last.or_else(|| relocalise(&tracker, |_| true))
    }

    /// Takes a found pose over: counts landmarks, makes a keyframe where one is wanted.
    fn accept(&mut self, frame: Frame, found: Found) -> TrackReport {
        let mut landmarks = vec![None; frame.len()];
        for inlier in found.fix.inliers() {
            landmarks[inlier.feature] = inlier.landmark;
        }
        self.count(&found.visible, &landmarks);
        let mut pose = found.fix.visual_from_camera();
        let mut reference = self.reference(&landmarks);
        let tracked = landmarks.iter().flatten().count();
        let shown = found.visible.iter().map(|(_, projection)| projection.pixel);
        let new_keyframe = self.config.keyframes.wants(&frame, pose, tracked, shown, &self.map);
        self.show(&frame, &landmarks);
        let mut covariance = self.covariance(&found, reference);
        let mut closed_loop = None;
        if new_keyframe {
            reference = self.insert(frame.clone(), pose, &landmarks);
            self.map.set_covariance(reference, covariance);
            closed_loop = self.close_loop(reference);
            covariance = self.map.keyframe(reference).covariance;
            let keyframe = self.map.keyframe(reference);
            (pose, landmarks) = (keyframe.visual_from_camera, keyframe.landmarks.clone());
        }
        let enough = found.by_map && found.fix.solution.inlier_count >= self.config.tracking.weak_inliers;
        let tracking = if enough { Tracking::Ok } else { Tracking::Weak };
        let before = self.last.as_ref().filter(|_| self.misses == 0);
        let before = before.map(|last| last.anchored.visual_from_camera(&self.map));
        self.belief.located(frame.stamp, pose, covariance, before);
        self.misses = 0;
        let anchored = self.remember(frame.stamp, Some(reference), tracking);
        let matches = (found.fix.matches.len(), found.fix.solution.inlier_count);
        let report = self.report(frame.len(), matches, new_keyframe, found.relocalised);
        let report = TrackReport { closed_loop, ..report };
        self.last = Some(Located { frame, landmarks, anchored });
        report
    }

    /// Goes on without a found pose; begins a map at the believed pose where there is none to be found again.
    fn miss(&mut self, frame: Frame, depth: &DepthImage, prior: Option<Pose3>) -> TrackReport {
        self.belief.missed(frame.stamp, prior, &self.config.motion);
        self.misses += 1;
        let none = vec![None; frame.len()];
        self.show(&frame, &none);
        let first = self.map.keyframe_count() == 0;
        let begins = with_depth(&frame).count() >= self.config.mapping.min_points
            && (first || prior.is_some() && self.is_beyond_the_map(depth));
        let reference = begins.then(|| self.insert(frame.clone(), self.belief.visual_from_camera, &none));
        let tracking = match prior {
            _ if first && begins => Tracking::Ok,
            Some(_) => Tracking::DeadReckoning,
            None => Tracking::Lost,
        };
        if first && begins {
            self.belief.covariance = Matrix6::zeros();
        }
        if let Some(id) = reference {
            self.map.set_covariance(id, self.belief.covariance);
        }
        let features = frame.len();
        let reference = reference.or_else(|| self.last.as_ref().and_then(|last| last.anchored.reference));
        let anchored = self.remember(frame.stamp, reference, tracking);
        if begins {
            let landmarks = reference.map_or(none, |id| self.map.keyframe(id).landmarks.clone());
            self.last = Some(Located { frame, landmarks, anchored });
            self.misses = 0;
        }
        self.report(features, (0, 0), begins, false)
    }

    /// Whether there is no use in waiting to see a known landmark again: none should be in view, or none was found for
    /// too long.
    fn is_beyond_the_map(&self, depth: &DepthImage) -> bool {
        let config = &self.config.tracking;
        let expected = self.view(depth).landmarks(&self.map, self.belief.visual_from_camera).len();
        expected < config.min_inliers || self.misses >= config.patience
    }

    fn insert(&mut self, frame: Frame, pose: Pose3, tracked: &[Option<LandmarkId>]) -> KeyframeId {
        let mapper = Mapper {
            sensor: &self.sensor,
            config: &self.config.mapping,
            likeness: self.config.tracking.window_likeness(),
            window: self.config.tracking.map_window_px,
        };
        let keyframe = mapper.insert(&mut self.map, frame, pose, tracked);
        self.places.follow(&self.map);
        keyframe
    }

    fn close_loop(&mut self, keyframe: KeyframeId) -> Option<LoopClosure> {
        let closer = LoopCloser {
            places: &self.places,
            sensor: &self.sensor,
            config: &self.config.loops,
            tracking: &self.config.tracking,
            mapping: &self.config.mapping,
            seed: self.config.seed.wrapping_add(self.history.len() as u64),
        };
        closer.close(&mut self.map, keyframe)
    }

    /// Counts which landmarks should have been seen, and which were.
    fn count(&mut self, visible: &[(LandmarkId, Projection)], found: &[Option<LandmarkId>]) {
        for (id, _) in visible {
            if let Some(landmark) = self.map.landmark_mut(*id) {
                landmark.visible += 1;
            }
        }
        for id in found.iter().flatten() {
            if let Some(landmark) = self.map.landmark_mut(*id) {
                landmark.found += 1;
            }
        }
    }

    /// Of a found pose: that against the map, and that of the keyframe which holds this part of the map.
    fn covariance(&self, found: &Found, reference: KeyframeId) -> Matrix6<f64> {
        let keyframe = self.map.keyframe(reference);
        let offset = keyframe.visual_from_camera.inverse() * found.fix.visual_from_camera();
        let local = found.fix.solution.covariance().unwrap_or_else(Matrix6::identity);
        carried(&keyframe.covariance, offset) + local
    }

    /// The keyframe that shares most landmarks with the frame; the last one's where none does.
    fn reference(&self, landmarks: &[Option<LandmarkId>]) -> KeyframeId {
        let seeing = self.map.keyframes_seeing(landmarks.iter().flatten().copied());
        let last = || Some(self.map.resolve(self.last.as_ref()?.anchored.reference?).0);
        let newest = || self.map.newest_keyframe().expect("invariant: what is tracked was mapped");
        seeing.first().map(|(id, _)| *id).or_else(last).unwrap_or_else(newest)
    }

    fn show(&mut self, frame: &Frame, landmarks: &[Option<LandmarkId>]) {
        self.seen.clear();
        let keypoints = frame.features.keypoints.iter().zip(landmarks);
        self.seen.extend(keypoints.map(|(k, l)| SeenFeature { keypoint: *k, tracked: l.is_some() }));
    }

    fn remember(&mut self, stamp: Stamp, reference: Option<KeyframeId>, tracking: Tracking) -> Anchored {
        let anchored = Anchored::new(stamp, reference, self.belief.visual_from_camera, &self.map);
        self.history.push((anchored, tracking));
        anchored
    }

    fn report(
        &self,
        features: usize,
        (matches, inliers): (usize, usize),
        new_keyframe: bool,
        relocalised: bool,
    ) -> TrackReport {
        let (frame, tracking) = self.history.last().expect("invariant: the frame was remembered");
        TrackReport {
            stamp: frame.stamp,
            tracking: *tracking,
            visual_from_camera: self.belief.visual_from_camera,
            covariance: self.belief.covariance,
            features,
            matches,
            inliers,
            relocalised,
            new_keyframe,
            closed_loop: None,
            keyframes: self.map.keyframe_count(),
            landmarks: self.map.landmark_count(),
        }
    }
}

impl Located {
    fn anchor(&self, map: &LandmarkMap) -> Anchor<'_> {
        let visual_from_camera = self.anchored.visual_from_camera(map);
        Anchor { frame: &self.frame, landmarks: &self.landmarks, visual_from_camera }
    }
}
