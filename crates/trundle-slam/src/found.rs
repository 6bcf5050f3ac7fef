use crate::align::all_that_agrees;
use crate::anchor::Anchor;
use crate::ids::{KeyframeId, LandmarkId};
use crate::refine::{Fix, Known, PointMatch};
use crate::relocalisation::is_same_place;
use crate::search::Projection;
use crate::tracker::Tracker;
use std::collections::{BTreeMap, BTreeSet};
use trundle_core::{Pose3, Vector2};
use trundle_optim::ALIKE;

/// How a frame was located.
#[derive(Debug)]
pub(crate) struct Found {
    pub fix: Fix,
    /// The matches that agree, with their features where they were aligned to.
    pub seen: Vec<PointMatch>,
    /// How many features were matched, and how many of these agreed, before they were aligned: by that it is judged whether this is
    /// the place. Where in it the camera is, those that could be aligned tell better, and they are fewer.
    pub matches: usize,
    pub points: usize,
    /// Whether that contradicted the wheels.
    contradicted: bool,
    /// The landmarks that should have been seen, and where.
    pub visible: Vec<(LandmarkId, Projection)>,
    /// Whether the landmark map itself agrees, not only the last frame.
    pub by_map: bool,
    /// The keyframe that looks alike, if it was found by one.
    pub recognised: Option<KeyframeId>,
    /// Whether enough of the view shows that place, if no other one looks like it.
    pub looks_right: bool,
    /// Whether that says where in it the camera is, too.
    pub is_certain: bool,
}

impl Found {
    /// From the last frame, whose reference keyframe is `reference`, to the map. Where the map has too little to say, in
    /// a blurred or quite new view, the last frame alone must do: a little drift is better than getting lost.
    pub fn from_last(
        tracker: &Tracker,
        last: Anchor,
        reference: Option<KeyframeId>,
        predicted: Pose3,
    ) -> Option<Self> {
        let rough = tracker.by_last(last, reference, predicted)?;
        let (fix, visible) = tracker.by_map(&rough, tracker.followed());
        let by_map = fix.is_sound(tracker.config.min_inliers);
        let fix = if by_map { fix } else { rough };
        let found = Self::by_matches(fix, visible);
        Some(if by_map { found.aligned(tracker, tracker.followed()) } else { Self { by_map, ..found } })
    }

    /// From a keyframe to the map. It takes more landmarks that agree to be certain of it, and some in a good part of the view: a
    /// picture that hangs in two rooms is not the room. And they must tell where it is: nothing else does, so that errors
    /// which points of one image share are counted.
    pub fn from_keyframe(tracker: &Tracker, keyframe: KeyframeId) -> Option<Self> {
        let rough = tracker.by_words(keyframe, Known::Nothing)?;
        let (nearly, _) = tracker.searching_wider().by_map(&rough, Known::Nothing);
        let (fix, visible) = tracker.by_map(&nearly, Known::Nothing);
        let config = tracker.config;
        (fix.is_sound(config.min_inliers) && fix.is_convincing()).then_some(())?;
        let found = fix.inliers().map(|m| tracker.frame.pixels[m.feature]);
        let is_seen = seen_part(visible.iter().map(|(_, seen)| seen.pixel), found) >= config.recognised_part;
        let sigma = (fix.solution.covariance? * ALIKE).fixed_view::<3, 3>(0, 0).trace().sqrt();
        let looks_right = fix.is_sound(config.weak_inliers) && is_seen;
        let is_certain = looks_right && sigma <= config.recognised_sigma;
        let found = Self::by_matches(of_one_image(fix), visible);
        Some(Self { recognised: Some(keyframe), looks_right, is_certain, ..found })
    }

    /// How many points say that the wheels are wrong; `None` where they do not.
    pub fn against_wheels(&self) -> Option<usize> {
        let Fix { solution, .. } = &self.fix;
        let points = if self.contradicted { self.points } else { solution.inlier_count };
        solution.contradicts_prior.then_some(points)
    }

    /// By a pose on the map, followed there.
    fn by_matches(fix: Fix, visible: Vec<(LandmarkId, Projection)>) -> Self {
        Self {
            seen: fix.inliers().copied().collect(),
            matches: fix.matches.len(),
            points: fix.solution.inlier_count,
            contradicted: fix.solution.contradicts_prior,
            fix,
            visible,
            by_map: true,
            recognised: None,
            looks_right: true,
            is_certain: true,
        }
    }

    /// The same with its features aligned, where enough of them can be and they say the same place. Of a recognised place, errors that
    /// points of one image share are counted again.
    pub fn aligned(self, tracker: &Tracker, known: Known) -> Self {
        let Some(fix) = tracker.aligned(&self.fix, known) else { return self };
        let fix = if self.recognised.is_some() { of_one_image(fix) } else { fix };
        if !is_same_place(fix.visual_from_camera(), self.fix.visual_from_camera()) {
            return self;
        }
        Self { seen: all_that_agrees(&self.fix, &fix, tracker.frame), fix, ..self }
    }
}

/// With the errors counted that points of one image share.
fn of_one_image(mut fix: Fix) -> Fix {
    fix.solution.covariance = fix.solution.covariance.map(|covariance| covariance * ALIKE);
    fix
}

/// Side of the parts of the image that are looked at one by one, px.
const CELL_PX: f64 = 40.0;
/// Landmarks that should be in a part before it is missed that none is found.
const EXPECTED: usize = 3;

/// In which part of the image's parts that should show landmarks there are some, 0 to 1. How many of them are found depends
/// on how many features an image has, where they are does not.
fn seen_part(expected: impl Iterator<Item = Vector2>, found: impl Iterator<Item = Vector2>) -> f64 {
    let cell = |pixel: Vector2| ((pixel.x / CELL_PX).floor() as i32, (pixel.y / CELL_PX).floor() as i32);
    let mut counts: BTreeMap<(i32, i32), usize> = BTreeMap::new();
    expected.for_each(|pixel| *counts.entry(cell(pixel)).or_default() += 1);
    counts.retain(|_, count| *count >= EXPECTED);
    let seen: BTreeSet<(i32, i32)> = found.map(cell).filter(|cell| counts.contains_key(cell)).collect();
    seen.len() as f64 / counts.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::component::Component;
    use crate::frame::Frame;
    use crate::local_map::View;
    use crate::look::keep_looks;
    use crate::report::MapId;
    use crate::testing::{painted_frame, painted_map, painted_points, sensor};
    use crate::tracker::TrackingConfig;
    use nalgebra::Vector6;
    use std::cell::OnceCell;
    use trundle_core::DepthImage;
    use trundle_optim::PosePrior;
    use trundle_vision::Vocabulary;

    /// What a frame of the painted wall is found to be in its map by matches that are all right, for a camera of which so much is known.
    fn with_found(frame: &Frame, known: Known, check: impl FnOnce(Found, &Tracker)) {
        let (sensor, config, (mut map, keyframe)) = (sensor(), TrackingConfig::default(), painted_map());
        keep_looks(&mut map, keyframe, &sensor);
        let Component { map, places, .. } = Component::new(MapId(0), map, &Vocabulary::builtin());
        let ids = map.landmarks().enumerate();
        let matches = ids.map(|(i, (id, _))| PointMatch::of_landmark(i, id, &map).unwrap()).collect();
        let fix = Fix::by(matches, (Pose3::identity(), known), frame, &sensor, &config.pose);
        let image = DepthImage::filled(320, 240, 0.0);
        let view = View { sensor: &sensor, depth: (&image, &Default::default()), window: 6.0, most: 4000 };
        let words = OnceCell::new();
        let (map, places, sensor, config) = (&map, &places, &sensor, &config);
        let tracker =
            Tracker { map, places, sensor, view, config, frame, rolled: None, words: &words, seed: 0 };
        check(Found::by_matches(fix, vec![]), &tracker);
    }

    fn frame_of_the_wall() -> Frame {
        painted_frame(Pose3::identity(), &painted_points(), Vector2::new(0.2, -0.1))
    }

    #[test]
    fn errors_that_points_share_are_counted_once_aligned_or_not() {
        let (mut frame, recognised) = (frame_of_the_wall(), Some(KeyframeId::from_index(0)));
        with_found(&frame, Known::Nothing, |found, tracker| {
            let aligned = tracker.aligned(&found.fix, Known::Nothing).unwrap().solution.covariance.unwrap();
            let found = Found { recognised, fix: of_one_image(found.fix), ..found };
            let found = found.aligned(tracker, Known::Nothing);
            assert_eq!(found.fix.solution.covariance, Some(aligned * ALIKE));
            assert!(found.seen.iter().all(|m| m.aligned.is_some()));
        });
        frame.forget_image();
        with_found(&frame, Known::Nothing, |found, tracker| {
            let plain = found.fix.solution.covariance.unwrap();
            let found = Found { recognised, fix: of_one_image(found.fix), ..found };
            let found = found.aligned(tracker, Known::Nothing);
            assert_eq!(found.fix.solution.covariance, Some(plain * ALIKE), "nothing could be aligned");
        });
    }

    #[test]
    fn only_points_that_contradict_the_wheels_speak_against_them() {
        let frame = frame_of_the_wall();
        let elsewhere = PosePrior {
            world_from_camera: Pose3::exp(Vector6::new(0.5, 0.0, 0.0, 0.0, 0.2, 0.0)),
            covariance: nalgebra::Matrix6::identity() * 1e-6,
        };
        with_found(&frame, Known::Followed(Some(&elsewhere)), |found, _| {
            assert_eq!(found.against_wheels(), Some(found.points));
            let aligned_only = Found { contradicted: false, points: 1000, ..found };
            let aligned = aligned_only.fix.solution.inlier_count;
            assert_eq!(aligned_only.against_wheels(), Some(aligned), "the many did not say so");
        });
        with_found(&frame, Known::Followed(None), |found, _| assert_eq!(found.against_wheels(), None));
    }

    #[test]
    fn what_is_seen_in_one_corner_is_not_the_view() {
        let grid = |columns: usize| {
            (0..columns * 100).map(|i| Vector2::new((i / 10) as f64, (i % 10) as f64 * 20.0))
        };
        assert_eq!(seen_part(grid(40), grid(40)), 1.0);
        assert_eq!(seen_part(grid(40), grid(12)), 0.3);
        assert_eq!(seen_part(grid(12), grid(40)), 1.0, "what is not expected does not count");
        assert_eq!(seen_part(grid(0), grid(40)), 0.0);
    }
}
