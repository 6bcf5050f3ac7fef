use crate::align::{aligned, widen};
use crate::anchor::Anchor;
use crate::frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::local_map::View;
use crate::map::LandmarkMap;
use crate::places::{Places, Worded, Words};
use crate::refine::{Fix, Known, PointMatch};
use crate::search::{Likeness, Projection, search};
use crate::sensor::Sensor;
use serde::{Deserialize, Serialize};
use std::cell::OnceCell;
use trundle_core::{Invalid, Pose3, require_in, require_positive};
use trundle_optim::{PoseConfig, PosePrior};
use trundle_vision::{Match, RansacConfig, match_mutual};

/// How the pose of a frame is found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackingConfig {
    /// Standard deviation of a keypoint of the finest octave, px, 0.01 to 100. Default 1 \[MurArtal17\].
    pub pixel_sigma: f64,
    /// How far around its prediction a point of the last frame is looked for, px of its octave, above 0; twice as far at
    /// the second try. Default 15 \[MurArtal17\].
    pub motion_window_px: f64,
    /// The same for a landmark of the map, once the pose is known from the last frame. Default 6: three standard
    /// deviations of a keypoint and as much for the map.
    pub map_window_px: f64,
    /// Highest distance of descriptors within a window, bits of 256. Default 80: unlike points differ by 128 on average.
    pub window_distance: u32,
    /// Highest quotient of the best and the next best distance within a window, above 0 to 1. Default 0.9.
    pub window_ratio: f32,
    /// Highest distance of descriptors without a window, bits. Default 64.
    pub free_distance: u32,
    /// Highest quotient of the best and the next best distance without a window, above 0 to 1. Default 0.8.
    pub free_ratio: f32,
    /// Landmarks of the map that are looked for in one frame. Default 4000.
    pub most_landmarks: usize,
    /// Fewer inliers than this and the frame is not located, 6 or more. Default 20.
    pub min_inliers: usize,
    /// Fewer inliers than this and it is located weakly; a relocalisation needs as many. Default 40.
    pub weak_inliers: usize,
    /// Keyframes that a lost camera is compared with in one frame, 1 or more, and as many of those that look like the one found.
    /// Default 5: some 20 ms, 40 when another map is asked as well.
    pub relocalisation_keyframes: usize,
    /// Part of the view, of its parts that should show landmarks, in which a relocalisation must find some, 0 to 1. Default
    /// 0.6: of 400 views of a simulated office with twin rooms, twins without a rival showed up to 0.56, and as many were recognised
    /// within 1 s as with 0.5; pictures that hang in two rooms show 0.45 and less.
    pub recognised_part: f64,
    /// Standard deviation of a relocalisation's position at most, m, above 0, with the errors counted that points of one image
    /// share. Default 0.05: then it is within 0.1 m at two of them. Views of little but what is beyond 6 m say more, and
    /// were up to 0.3 m off; 97 of 100 others say less (docs/results.md).
    pub recognised_sigma: f64,
    /// After so many frames without success, a map is begun: at the dead-reckoned pose, or without a prior one of its own.
    /// Default 30: a second.
    pub patience: usize,
    /// The solver.
    pub pose: PoseConfig,
}

impl Default for TrackingConfig {
    fn default() -> Self {
        Self {
            pixel_sigma: 1.0,
            motion_window_px: 15.0,
            map_window_px: 6.0,
            window_distance: 80,
            window_ratio: 0.9,
            free_distance: 64,
            free_ratio: 0.8,
            most_landmarks: 4000,
            min_inliers: 20,
            weak_inliers: 40,
            relocalisation_keyframes: 5,
            recognised_part: 0.6,
            recognised_sigma: 0.05,
            patience: 30,
            pose: PoseConfig::default(),
        }
    }
}

impl TrackingConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        require_in("tracking.pixel_sigma", self.pixel_sigma, "px", 0.01, 100.0)?;
        require_positive("tracking.motion_window_px", self.motion_window_px, "px")?;
        require_positive("tracking.map_window_px", self.map_window_px, "px")?;
        require_in("tracking.window_ratio", f64::from(self.window_ratio), "", 0.01, 1.0)?;
        require_in("tracking.free_ratio", f64::from(self.free_ratio), "", 0.01, 1.0)?;
        require_in("tracking.recognised_part", self.recognised_part, "", 0.0, 1.0)?;
        require_positive("tracking.recognised_sigma", self.recognised_sigma, "m")?;
        let counts = [
            ("tracking.min_inliers", self.min_inliers, 6),
            ("tracking.weak_inliers", self.weak_inliers, self.min_inliers),
            ("tracking.most_landmarks", self.most_landmarks, self.weak_inliers),
            ("tracking.relocalisation_keyframes", self.relocalisation_keyframes, 1),
        ];
        for (name, value, least) in counts {
            if value < least {
                return Err(Invalid::new(name, value, "", format!("{least} or more")));
            }
        }
        self.pose = self.pose.validated()?;
        Ok(self)
    }

    pub(crate) fn window_likeness(&self) -> Likeness {
        Likeness { max_distance: self.window_distance, ratio: self.window_ratio }
    }

    pub(crate) fn free_likeness(&self) -> Likeness {
        Likeness { max_distance: self.free_distance, ratio: self.free_ratio }
    }
}

/// Finds the pose of one frame in the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tracker<'a> {
    pub map: &'a LandmarkMap,
    pub places: &'a Places,
    pub sensor: &'a Sensor,
    pub view: View<'a>,
    pub config: &'a TrackingConfig,
    pub frame: &'a Frame,
    /// Where wheels have brought the camera since the newest keyframe.
    pub rolled: Option<PosePrior>,
    /// The frame's words, once somebody asked for them.
    pub words: &'a OnceCell<Words>,
    pub seed: u64,
}

impl Tracker<'_> {
    /// The pose from the last frame: its points looked for around where `predicted` puts them, then wider; then by what
    /// looks like its reference keyframe, and like itself, anywhere. The first of these by which most matches agree, else
    /// the one with the most agreeing.
    pub fn by_last(&self, last: Anchor, reference: Option<KeyframeId>, predicted: Pose3) -> Option<Fix> {
        let tries: [&dyn Fn() -> Option<Fix>; 4] = [
            &|| self.by_motion(last, predicted, 1.0),
            &|| self.by_motion(last, predicted, 2.0),
            &|| self.by_words(reference?, self.followed()),
            &|| self.by_likeness(last),
        ];
        let mut best: Option<Fix> = None;
        for attempt in tries {
            let Some(fix) = attempt() else { continue };
            if fix.is_convincing() {
                return Some(fix);
            }
            if best.as_ref().is_none_or(|b| fix.solution.inlier_count > b.solution.inlier_count) {
                best = Some(fix);
            }
        }
        best.filter(|fix| fix.is_sound(self.config.weak_inliers))
    }

    /// What is known of a camera that was followed from frame to frame.
    pub fn followed(&self) -> Known<'_> {
        Known::Followed(self.rolled.as_ref())
    }

    /// The frame's words.
    pub fn words(&self) -> &Words {
        self.words.get_or_init(|| Words::of(self.frame, self.places.vocabulary()))
    }

    fn by_motion(&self, last: Anchor, predicted: Pose3, wider: f64) -> Option<Fix> {
        let likeness = self.config.window_likeness();
        let window = wider * self.config.motion_window_px;
        let matches = last.match_by_motion(self.frame, predicted, window, likeness, (self.map, self.sensor));
        self.refined(matches, predicted, self.followed())
    }

    /// The pose from what looks alike in a keyframe, feature by feature under the same node of the vocabulary.
    pub fn by_words(&self, keyframe: KeyframeId, known: Known) -> Option<Fix> {
        let own = Worded { frame: self.frame, words: self.words() };
        let pairs = self.places.worded(self.map, keyframe)?.matches(own, self.config.free_likeness());
        self.located(self.map.keyframe(keyframe).into(), &pairs, known)
    }

    /// The pose from what looks alike in `last`, wherever it is in the image.
    fn by_likeness(&self, last: Anchor) -> Option<Fix> {
        let Likeness { max_distance, ratio } = self.config.free_likeness();
        let (there, here) = (&last.frame.features.descriptors, &self.frame.features.descriptors);
        let pairs = match_mutual(there, here, max_distance, ratio);
        self.located(last, &pairs, self.followed())
    }

    fn located(&self, anchor: Anchor, pairs: &[Match], known: Known) -> Option<Fix> {
        let (pose, matches) = anchor.locate(self.frame, pairs, self.seed, (self.map, self.sensor))?;
        self.refined(matches, pose, known)
    }

    /// The final pose: against all landmarks of the map that a camera at the pose of `rough` should see. What `rough` has
    /// matched with a landmark stays matched. Also which landmarks should have been seen.
    pub fn by_map(&self, rough: &Fix, known: Known) -> (Fix, Vec<(LandmarkId, Projection)>) {
        let pose = rough.visual_from_camera();
        let mut matches: Vec<PointMatch> =
            rough.inliers().filter(|m| m.landmark.is_some()).copied().collect();
        let mut free = vec![true; self.frame.len()];
        matches.iter().for_each(|m| free[m.feature] = false);
        let mut matched: Vec<LandmarkId> = matches.iter().filter_map(|m| m.landmark).collect();
        matched.sort_unstable();
        let visible = self.view.landmarks(self.map, pose);
        let is_sought =
            |(id, seen): &&(LandmarkId, Projection)| seen.is_findable && matched.binary_search(id).is_err();
        let sought: Vec<_> = visible.iter().filter(is_sought).collect();
        let projections: Vec<Projection> = sought.iter().map(|(_, projection)| *projection).collect();
        let found = search(self.frame, &free, &projections, self.config.window_likeness());
        let taken = |(feature, i): (usize, usize)| PointMatch::of_landmark(feature, sought[i].0, self.map);
        matches.extend(found.into_iter().filter_map(taken));
        let fix = Fix::by(matches, (pose, known), self.frame, self.sensor, &self.config.pose);
        (fix, visible)
    }

    /// The pose of `found` again, from features that lie where what is around them fits; `None` where too few do.
    pub fn aligned(&self, found: &Fix, known: Known) -> Option<Fix> {
        let solve =
            |matches, pose| Fix::by(matches, (pose, known), self.frame, self.sensor, &self.config.pose);
        let pose = found.visual_from_camera();
        let matches = aligned(&found.matches, pose, self.frame, (self.map, self.sensor))?;
        let mut fix = solve(matches, pose);
        let spread = fix.spread(self.sensor);
        if widen(&mut fix.matches, spread, self.frame, self.sensor) {
            let pose = fix.visual_from_camera();
            fix = solve(fix.matches, pose);
        }
        fix.is_sound(self.config.min_inliers).then_some(fix)
    }

    /// The same for a camera whose pose is known roughly.
    pub fn searching_wider(&self) -> Self {
        Self { view: View { window: self.config.motion_window_px, ..self.view }, ..*self }
    }

    fn refined(&self, matches: Vec<PointMatch>, start: Pose3, known: Known) -> Option<Fix> {
        let least = match known {
            Known::Followed(_) => self.config.min_inliers,
            // They do not agree by chance, and the map is asked next.
            Known::Nothing => RansacConfig::default().min_inliers,
        };
        if matches.len() < least {
            return None;
        }
        let fix = Fix::by(matches, (start, known), self.frame, self.sensor, &self.config.pose);
        fix.is_sound(least).then_some(fix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_sigma_is_a_sensible_one() {
        let is_valid =
            |pixel_sigma| TrackingConfig { pixel_sigma, ..TrackingConfig::default() }.validated().is_ok();
        let expected = [(0.0, false), (0.009, false), (0.01, true), (100.0, true), (101.0, false)];
        expected.iter().for_each(|(sigma, valid)| assert_eq!(is_valid(*sigma), *valid, "{sigma}"));
        assert!(!is_valid(f64::NAN));
    }
}
