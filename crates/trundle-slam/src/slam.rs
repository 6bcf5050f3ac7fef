mod accept;
mod begun;
mod doubts;
mod graph;
mod locate;
mod look_back;
mod merge;
mod miss;
mod saving;

use crate::anchor::Anchor;
use crate::claim::Claim;
use crate::closing::{LoopClosure, Search};
use crate::component::Component;
use crate::config::SlamConfig;
use crate::contradiction::Contradiction;
use crate::diagnosis::{SettingsCheck, Suspicion};
use crate::floor::Floor;
use crate::frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::keyframe_culling::cull_keyframes;
use crate::local_map::View;
use crate::map::LandmarkMap;
use crate::mapping::Mapper;
use crate::motion::{Belief, is_within};
use crate::report::{MapId, Mode, SeenFeature, TrackReport, Tracking};
use crate::rolled::Rolled;
use crate::sensor::Sensor;
use crate::trajectory::Anchored;
use begun::Begun;
use doubts::Doubts;
use std::collections::VecDeque;
use std::sync::Arc;
use trundle_core::{
    CameraMotion, DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Stamp, Vector3, gray_from_color,
};
use trundle_vision::{Features, OrbExtractor, Vocabulary};

/// RGB-D SLAM: one image in, the camera's pose out; keeps the landmark map. See the crate's documentation.
///
/// Synchronous and deterministic: the same images, priors and configuration give the same bits.
#[derive(Debug)]
pub struct RgbdSlam {
    config: SlamConfig,
    mode: Mode,
    sensor: Sensor,
    extractor: OrbExtractor,
    /// Room for the features of the next image, half a megabyte that is not to be found anew thirty times a second.
    spare: Features,
    /// The map that the camera is in, or was last.
    active: Component,
    /// The other ones, by rising id.
    resting: Vec<Component>,
    /// The highest number that a map ever had.
    newest_map: u32,
    belief: Belief,
    /// Whether the belief says anything about where in the active map the camera is.
    placed: bool,
    /// Whether nothing told how the camera moved since it was last located.
    blind: bool,
    /// Whether what it should see next was gone at once: it was carried, or something stands before the lens.
    torn: bool,
    /// The last frame that was located.
    last: Option<Located>,
    /// Frames since then.
    misses: usize,
    /// The last frame, if it was not located.
    missed: Option<Frame>,
    /// Places that look right, and are not believed yet.
    doubts: Doubts,
    /// How the newest map began, where that was behind a way in the dark.
    begun: Option<Begun>,
    /// Another map that the last keyframe recognised.
    recognition: Option<Claim<MapId>>,
    /// Tracked poses against the wheels.
    contradiction: Contradiction,
    /// A place of the active map that it recognised farther off than it should be.
    surprise: Option<Claim<()>>,
    /// The newest frames, the last one behind.
    history: VecDeque<Past>,
    /// How many frames there were in all.
    frames: u64,
    /// The way since the newest keyframe, as long as wheels know it.
    rolled: Option<Rolled>,
    /// What the priors say of a floor.
    floor: Floor,
    /// The newest keyframes whose places are still to be looked for among the old ones.
    searches: VecDeque<Search>,
    /// How refining the map moved the camera, before the frame at hand.
    refined: Option<Pose3>,
    /// The loop that was closed before the frame at hand.
    closed_loop: Option<LoopClosure>,
    seen: Vec<SeenFeature>,
    check: SettingsCheck,
}

/// A frame whose pose was found.
#[derive(Debug)]
struct Located {
    frame: Frame,
    landmarks: Vec<Option<LandmarkId>>,
    anchored: Anchored,
}

/// What became of a frame.
#[derive(Debug, Clone, Copy)]
struct Past {
    anchored: Anchored,
    map: MapId,
    tracking: Tracking,
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
            mode: Mode::default(),
            sensor,
            extractor,
            spare: Features::default(),
            active: Component::new(MapId(0), LandmarkMap::default(), &Vocabulary::builtin()),
            resting: vec![],
            newest_map: 0,
            belief: Belief::at(Pose3::identity()),
            placed: true,
            blind: false,
            torn: false,
            last: None,
            misses: 0,
            missed: None,
            doubts: Doubts::default(),
            begun: None,
            recognition: None,
            contradiction: Contradiction::default(),
            surprise: None,
            history: VecDeque::new(),
            frames: 0,
            rolled: None,
            floor: Floor::default(),
            searches: VecDeque::new(),
            refined: None,
            closed_loop: None,
            seen: vec![],
            check: SettingsCheck::default(),
        })
    }

    /// The same with another vocabulary than that of the program; call it before the first image.
    #[must_use]
    pub fn with_vocabulary(mut self, vocabulary: &Arc<Vocabulary>) -> Self {
        self.resting.iter_mut().chain([&mut self.active]).for_each(|map| map.describe_by(vocabulary));
        self
    }

    /// The same with the camera at `visual_from_camera` at the start; call it before the first image. In a loaded map, it
    /// is looked for there first.
    #[must_use]
    pub fn starting_at(mut self, visual_from_camera: Pose3) -> Self {
        self.belief = Belief::at(visual_from_camera);
        self.placed = true;
        self
    }

    /// Forgets where the camera is: it was carried away. It counts as lost, whatever the wheels say, until it recognises a
    /// place.
    pub fn kidnapped(&mut self) {
        let stamp = self.belief.stamp;
        self.belief = Belief { stamp, ..Belief::anywhere() };
        (self.placed, self.last, self.misses, self.doubts) = (false, None, 0, Doubts::default());
        self.forget_the_way();
    }

    /// Drops what belongs to the keyframes before this: they are of another map, or far away.
    fn forget_the_way(&mut self) {
        self.searches.clear();
        (self.rolled, self.contradiction) = (None, Contradiction::default());
    }

    /// Goes on mapping, or only locates and leaves the maps as they are.
    pub fn set_mode(&mut self, mode: Mode) {
        self.mode = mode;
    }

    /// Whether it maps.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Locates one image. `prior` is the motion since the last image given, `previous_camera_from_camera`, as wheels and
    /// gyro know it; without it, or where it is one that no robot makes in that time, the camera is taken to go on as it went.
    /// An image of another size than the camera's, or with nothing in it, is an image without features: the report says that
    /// it was not located.
    pub fn step(&mut self, image: &RgbdImage, prior: Option<CameraMotion>) -> TrackReport {
        let camera = &self.sensor.camera;
        let fits = image.color().width() == camera.width() && image.color().height() == camera.height();
        let gray = gray_from_color(image.color());
        let mut features = Features::default();
        if fits {
            features = std::mem::take(&mut self.spare);
            self.extractor.extract_into(&gray, &mut features);
        }
        self.check.note_image(&gray, image.depth());
        self.step_with_features(image.stamp(), features, image.depth(), prior)
    }

    /// The same with features found elsewhere, by an extractor of the same configuration: in another thread, say.
    pub fn step_with_features(
        &mut self,
        stamp: Stamp,
        features: Features,
        depth: &DepthImage,
        prior: Option<CameraMotion>,
    ) -> TrackReport {
        let seconds = self.belief.seconds_until(stamp);
        let told = prior.filter(|told| told.is_finite() && is_within(told.motion, AT_ONCE, FASTEST, seconds));
        let prior = told.map(|told| told.motion);
        let turn = self.belief.turn_rate(stamp, prior) * self.config.motion.readout;
        let frame = Frame::new(stamp, features, depth, turn, (&self.sensor, &self.config.depth));
        self.check.note_frame(&frame, depth, prior, &self.sensor, &self.config.depth);
        self.roll(stamp, told);
        self.tidy_up(self.config.mapping.work_per_frame);
        match self.locate(&frame, depth, prior) {
            Some(sighting) => self.accept(frame, sighting),
            None => self.miss(frame, depth, told),
        }
    }

    /// Does all that is left of refining the map, which `step` does in slices between frames: before it is saved, say, or
    /// when the camera stands still for long.
    pub fn finish_refining(&mut self) {
        let is_due = |slam: &Self| !slam.searches.is_empty() || slam.active.map.is_being_refined();
        while self.mode == Mode::Mapping && is_due(self) {
            self.tidy_up(usize::MAX);
        }
    }

    /// Takes note of what wheels say of the way since the last frame.
    fn roll(&mut self, stamp: Stamp, prior: Option<CameraMotion>) {
        let seconds = self.belief.seconds_until(stamp);
        self.rolled =
            self.rolled.zip(prior).and_then(|(way, step)| way.on(step, seconds, &self.config.motion));
        if let Some(step) = prior {
            self.floor.note(step.motion);
        }
    }

    /// What is done between frames: looks for a loop, else goes on refining the map.
    fn tidy_up(&mut self, work: usize) {
        (self.refined, self.closed_loop) = (None, None);
        if self.mode == Mode::Localisation || self.look_back() {
            return;
        }
        if self.active.map.refine(&self.sensor, &self.config.mapping, work) {
            self.refined = self.follow_the_map();
        }
    }

    /// The camera moves along with the map that has changed; how it moved, `new_from_old` in the visual frame.
    fn follow_the_map(&mut self) -> Option<Pose3> {
        let past = self.history.back().filter(|past| past.map == self.active.id)?;
        let pose = past.anchored.visual_from_camera(&self.active.map);
        let correction = pose * self.belief.visual_from_camera.inverse();
        self.belief.visual_from_camera = pose;
        Some(correction)
    }

    /// Pose of every frame that was not lost, of the newest [`SlamConfig::kept_frames`] that were not forgotten, in the order of
    /// `step`: `visual_from_camera` by the map as it is now. Of several maps that of the last frame; the others have frames of their own.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose3)> {
        let is_here = |past: &&Past| past.map == self.active.id && past.tracking != Tracking::Lost;
        let pose = |past: &Past| (past.anchored.stamp, past.anchored.visual_from_camera(&self.active.map));
        self.history.iter().filter(is_here).map(pose).collect()
    }

    /// Lets go the poses of all frames but the last one and those `wanted`: a robot wants those where something was drawn, and an
    /// hour has a hundred thousand.
    pub fn forget_frames(&mut self, wanted: impl Fn(Stamp) -> bool) {
        let last = self.history.back().map(|past| past.anchored.stamp);
        self.history.retain(|past| Some(past.anchored.stamp) == last || wanted(past.anchored.stamp));
    }

    /// All landmarks of the map that the camera is in, visual frame, m, in the order of their making.
    pub fn landmarks(&self) -> impl Iterator<Item = Vector3> + '_ {
        self.active.map.landmarks().map(|(_, landmark)| landmark.position)
    }

    /// Its keyframes: when, and `visual_from_camera`, in the order of their making.
    pub fn keyframes(&self) -> impl Iterator<Item = (KeyframeId, Stamp, Pose3)> + '_ {
        self.active.map.keyframes().map(|(id, k)| (id, k.frame.stamp, k.visual_from_camera))
    }

    /// All maps there are, by rising number; more than one when the camera got lost and has not recognised the others.
    pub fn maps(&self) -> Vec<MapId> {
        let mut ids: Vec<MapId> = self.resting.iter().chain([&self.active]).map(|map| map.id).collect();
        ids.sort_unstable();
        ids
    }

    /// The features of the last image.
    pub fn last_features(&self) -> &[SeenFeature] {
        &self.seen
    }

    /// Settings that are probably wrong, as the first images tell; empty where nothing speaks against them.
    pub fn suspicions(&self) -> &[Suspicion] {
        self.check.suspicions()
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

    /// Of the samples drawn for this frame.
    fn seed(&self) -> u64 {
        self.config.seed.wrapping_add(self.frames)
    }

    fn mapper<'a>(sensor: &'a Sensor, config: &'a SlamConfig) -> Mapper<'a> {
        let SlamConfig { mapping, tracking, .. } = config;
        let (likeness, window) = (tracking.window_likeness(), tracking.map_window_px);
        Mapper { sensor, config: mapping, likeness, window }
    }

    fn insert(&mut self, frame: Frame, pose: Pose3, tracked: &[Option<LandmarkId>]) -> KeyframeId {
        let mapper = Self::mapper(&self.sensor, &self.config);
        self.active.map.floor = self.floor.axis_after(self.active.map.floor);
        let rolled = self.rolled.filter(|rolled| self.active.map.live_keyframe(rolled.from).is_some());
        let keyframe = mapper.insert(&mut self.active.map, frame, pose, (tracked, rolled));
        self.rolled = Some(Rolled::at(keyframe));
        cull_keyframes(&mut self.active.map, keyframe, &self.config.keyframes);
        self.active.follow();
        keyframe
    }

    /// Goes on from a frame; the one before leaves its room to the next image's features.
    fn go_on_from(&mut self, located: Located) {
        if let Some(before) = self.last.replace(located) {
            self.spare = before.frame.features;
        }
    }

    fn show(&mut self, frame: &Frame, landmarks: &[Option<LandmarkId>]) {
        self.seen.clear();
        let keypoints = frame.features.keypoints.iter().zip(landmarks);
        self.seen.extend(keypoints.map(|(k, l)| SeenFeature { keypoint: *k, tracked: l.is_some() }));
    }

    fn remember(&mut self, stamp: Stamp, reference: Option<KeyframeId>, tracking: Tracking) -> Anchored {
        let pose = self.belief.visual_from_camera;
        let anchored = Anchored::new(stamp, reference, pose, &self.active.map);
        if self.history.len() == self.config.kept_frames {
            self.history.pop_front();
        }
        self.history.push_back(Past { anchored, map: self.active.id, tracking });
        self.frames += 1;
        anchored
    }

    /// Of the frame remembered last.
    fn report(&self, features: usize) -> TrackReport {
        let Past { anchored, map, tracking } =
            *self.history.back().expect("invariant: the frame was remembered");
        TrackReport {
            stamp: anchored.stamp,
            tracking,
            map,
            visual_from_camera: self.belief.visual_from_camera,
            covariance: self.belief.covariance,
            features,
            matches: 0,
            inliers: 0,
            relocalised: false,
            new_keyframe: false,
            closed_loop: self.closed_loop,
            merged: None,
            refined: self.refined,
            keyframes: self.active.map.keyframe_count(),
            landmarks: self.active.map.landmark_count(),
        }
    }
}

/// Faster than this no robot moves, m/s, and turns, rad/s: its odometry has jumped.
const FASTEST: (f64, f64) = (10.0, 20.0);
/// And farther than this in no time at all, m and rad.
const AT_ONCE: f64 = 0.2;

impl Located {
    fn anchor(&self, map: &LandmarkMap) -> Anchor<'_> {
        let visual_from_camera = self.anchored.visual_from_camera(map);
        Anchor { frame: &self.frame, landmarks: &self.landmarks, visual_from_camera }
    }
}
