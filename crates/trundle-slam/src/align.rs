//! Moves matched features to where what is around them fits what was around their landmarks \[Forster14, sec. IV-B\].

use crate::frame::{Frame, raw};
use crate::look::Look;
use crate::map::LandmarkMap;
use crate::refine::{Fix, PointMatch};
use crate::sensor::Sensor;
use std::collections::BTreeSet;
use trundle_core::{Pose3, Vector2};
use trundle_vision::Template;

/// How far a feature is moved at most, px of its octave: farther off it was something else.
const FARTHEST: f32 = 2.0;
/// From where the landmark should be it is looked for, unless that is farther off, px of the octave: then the pose is.
const NEAR: f64 = 4.0;
/// What an alignment is off at least, besides what it says itself, px of its octave; together no more than a feature by itself.
const SIGMA: f64 = 0.3;
/// Fewer aligned features than this do not tell the pose alone.
const ENOUGH: usize = 20;
/// How much less a feature counts than one of its kind when others are aligned and it was never seen from about here: those are
/// a tenth of a pixel off, and it half a pixel, to the same side in every frame.
const UNKNOWN: f64 = 6.0;

/// Where a feature is once its surroundings were compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aligned {
    /// Raw px.
    pub raw: Vector2,
    /// Rectified px.
    pub pixel: Vector2,
    /// Standard deviation of either coordinate, px.
    pub sigma: f64,
    /// Whether a look of the landmark fits there; else it is where it was found.
    pub is_alike: bool,
}

/// What is around a feature, against what was around the landmark that it was taken for.
enum Surroundings {
    Alike(Aligned),
    Different,
    /// It was never seen from about here.
    Unknown,
}

/// The matches with their features aligned, for a camera about at `visual_from_camera`, and without those whose surroundings tell that
/// they are something else. `None` where too few fit.
pub(crate) fn aligned(
    matches: &[PointMatch],
    visual_from_camera: Pose3,
    frame: &Frame,
    (map, sensor): (&LandmarkMap, &Sensor),
) -> Option<Vec<PointMatch>> {
    if frame.features.patches.is_empty() {
        return None;
    }
    let camera_from_visual = visual_from_camera.inverse();
    let compare = |m: &PointMatch| compared(m, &camera_from_visual, frame, (map, sensor));
    let seen: Vec<Surroundings> = matches.iter().map(compare).collect();
    let count = seen.iter().filter(|seen| matches!(seen, Surroundings::Alike(_))).count();
    (count >= ENOUGH).then_some(())?;
    let keep = |(m, seen): (&PointMatch, Surroundings)| {
        let aligned = match seen {
            Surroundings::Alike(aligned) => aligned,
            Surroundings::Different => return None,
            Surroundings::Unknown => in_place(m, frame),
        };
        Some(PointMatch { aligned: Some(aligned), ..*m })
    };
    Some(matches.iter().zip(seen).filter_map(keep).collect())
}

/// Widens all alignments by what the pose that they give leaves of them, `spread` standard deviations, where that is more
/// than they say: a lens is not quite as it was calibrated, and a shutter rolls. Not beyond what a feature says by itself. Whether
/// anything changed.
pub(crate) fn widen(matches: &mut [PointMatch], spread: f64, frame: &Frame, sensor: &Sensor) -> bool {
    if spread <= 1.0 {
        return false;
    }
    for m in matches {
        let most = sensor.sigma_of(frame.octave(m.feature));
        if let Some(aligned) = m.aligned.as_mut().filter(|aligned| aligned.is_alike) {
            aligned.sigma = (spread * aligned.sigma).min(most);
        }
    }
    true
}

/// What agreed before features were aligned, or does since: what does not fit any more is seen where it was found, and counts little. (Let go, it
/// would become a second landmark in the next keyframe.)
pub(crate) fn all_that_agrees(before: &Fix, since: &Fix, frame: &Frame) -> Vec<PointMatch> {
    let fits: BTreeSet<usize> = since.inliers().map(|m| m.feature).collect();
    let rest = before.inliers().filter(|m| !fits.contains(&m.feature));
    let rest = rest.map(|m| PointMatch { aligned: Some(in_place(m, frame)), ..*m });
    since.inliers().copied().chain(rest).collect()
}

/// The feature where it was found.
fn in_place(m: &PointMatch, frame: &Frame) -> Aligned {
    let (raw, pixel) = (raw(&frame.features.keypoints[m.feature]), frame.pixels[m.feature]);
    Aligned { raw, pixel, sigma: UNKNOWN * f64::from(frame.pixel_sigmas[m.feature]), is_alike: false }
}

fn compared(
    m: &PointMatch,
    camera_from_visual: &Pose3,
    frame: &Frame,
    (map, sensor): (&LandmarkMap, &Sensor),
) -> Surroundings {
    let octave = frame.octave(m.feature);
    let landmark = m.landmark.and_then(|id| map.landmark(id));
    let Some((landmark, patch)) = landmark.zip(frame.features.patches.get(m.feature)) else {
        return Surroundings::Unknown;
    };
    let seen = |look: &Look| look.seen_from(camera_from_visual, landmark.position, octave, sensor);
    let mut templates = landmark.looks.iter().filter_map(seen).peekable();
    if templates.peek().is_none() {
        return Surroundings::Unknown;
    }
    let scale = sensor.scale(octave);
    let start = expected(m, camera_from_visual, frame, sensor) / scale;
    let start = if start.amax() <= NEAR { start } else { Vector2::zeros() };
    let find = |template: Template| {
        template.find(patch, start.cast()).filter(|found| found.offset.amax() <= FARTHEST)
    };
    let Some(found) = templates.find_map(find) else { return Surroundings::Different };
    let raw = raw(&frame.features.keypoints[m.feature]) + found.offset.cast() * scale;
    let sigma = SIGMA.hypot(f64::from(found.sigma)).min(sensor.pixel_sigma) * scale;
    Surroundings::Alike(Aligned { raw, pixel: sensor.camera.undistort(raw), sigma, is_alike: true })
}

/// How far from its feature the landmark should be seen, px; nothing where it should not.
fn expected(m: &PointMatch, camera_from_visual: &Pose3, frame: &Frame, sensor: &Sensor) -> Vector2 {
    let seen = sensor.project(camera_from_visual.transform(m.point));
    seen.map_or_else(Vector2::zeros, |(pixel, _)| pixel - frame.pixels[m.feature])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::keep_looks;
    use crate::refine::Known;
    use crate::testing::{painted_frame, painted_map, painted_points, sensor};
    use nalgebra::Vector6;
    use trundle_optim::PoseConfig;

    /// A map of a wall with all looks, and matches of a frame with features 1 px off, from nearer and aside.
    fn tracked() -> (LandmarkMap, Frame, Pose3, Vec<PointMatch>) {
        let (mut map, keyframe) = painted_map();
        keep_looks(&mut map, keyframe, &sensor());
        let pose = Pose3::exp(Vector6::new(0.2, 0.0, 0.3, 0.0, -0.1, 0.05));
        let frame = painted_frame(pose, &painted_points(), Vector2::new(0.8, -0.6));
        let ids = map.landmarks().enumerate();
        let matches = ids.map(|(i, (id, _))| PointMatch::of_landmark(i, id, &map).unwrap()).collect();
        (map, frame, pose, matches)
    }

    #[test]
    fn features_go_where_their_landmarks_are() {
        let ((map, frame, pose, matches), sensor) = (tracked(), sensor());
        let about = pose * Pose3::exp(Vector6::new(0.004, 0.0, 0.0, 0.0, 0.003, 0.0));
        let found = aligned(&matches, about, &frame, (&map, &sensor)).unwrap();
        assert_eq!(found.len(), matches.len());
        for m in &found {
            let truth = sensor.project(pose.inverse().transform(m.point)).unwrap().0;
            let aligned = m.aligned.unwrap();
            assert!((aligned.pixel - truth).norm() < 0.1 && aligned.is_alike, "{aligned:?} is not {truth}");
            assert!((0.3..0.4).contains(&aligned.sigma));
        }
        let moved = found.iter().filter_map(|m| Some((m.feature, m.aligned?)));
        let (first, there) = (frame.pixels[0], found[0].aligned.unwrap());
        let frame = frame.with_aligned(moved, &sensor);
        assert!(
            frame.near(there.pixel, 0.05, (0, 0)).eq([0]) && frame.near(first, 0.5, (0, 0)).next().is_none()
        );
        assert!((frame.sharpness(&sensor) - 0.3).abs() < 0.02);
    }

    #[test]
    fn what_looks_different_goes_and_what_is_unknown_counts_little() {
        let ((mut map, frame, pose, mut matches), sensor) = (tracked(), sensor());
        matches[5] = PointMatch { feature: matches[6].feature, ..matches[5] };
        map.landmark_mut(matches[9].landmark.unwrap()).unwrap().looks.clear();
        let found = aligned(&matches, pose, &frame, (&map, &sensor)).unwrap();
        assert!(found.iter().all(|m| m.landmark != matches[5].landmark));
        let unknown = found.iter().find(|m| m.landmark == matches[9].landmark).unwrap().aligned.unwrap();
        assert_eq!((unknown.pixel, unknown.sigma, unknown.is_alike), (frame.pixels[9], UNKNOWN, false));
    }

    #[test]
    fn what_fits_no_look_is_still_seen_and_counts_little() {
        let ((map, frame, pose, matches), sensor) = (tracked(), sensor());
        let solve = |matches| {
            let known = Known::Followed(None);
            Fix::by(matches, (pose, known), &frame, &sensor, &PoseConfig::default())
        };
        let before = solve(matches.clone());
        assert_eq!(before.solution.inlier_count, matches.len());
        let mut fitting = aligned(&matches, pose, &frame, (&map, &sensor)).unwrap();
        fitting.remove(3);
        let seen = all_that_agrees(&before, &solve(fitting), &frame);
        assert_eq!(seen.len(), matches.len());
        let again = seen.iter().find(|m| m.landmark == matches[3].landmark).unwrap().aligned.unwrap();
        assert_eq!((again.pixel, again.is_alike), (frame.pixels[matches[3].feature], false));
        assert!(seen.iter().filter(|m| m.aligned.unwrap().is_alike).count() == matches.len() - 1);
    }

    #[test]
    fn few_do_not_tell_alone() {
        let ((map, mut frame, pose, matches), sensor) = (tracked(), sensor());
        assert!(aligned(&matches[..ENOUGH], pose, &frame, (&map, &sensor)).is_some());
        assert_eq!(aligned(&matches[1..ENOUGH], pose, &frame, (&map, &sensor)), None);
        frame.forget_image();
        assert_eq!(aligned(&matches, pose, &frame, (&map, &sensor)), None);
    }

    #[test]
    fn they_are_as_good_as_the_pose_shows_and_no_better() {
        let ((map, frame, pose, matches), sensor) = (tracked(), sensor());
        let mut found = aligned(&matches, pose, &frame, (&map, &sensor)).unwrap();
        let sigma = |found: &[PointMatch]| found[0].aligned.unwrap().sigma;
        let said = sigma(&found);
        assert!(!widen(&mut found, 0.7, &frame, &sensor) && sigma(&found) == said);
        assert!(widen(&mut found, 2.0, &frame, &sensor) && sigma(&found) == 2.0 * said);
        assert!(widen(&mut found, 99.0, &frame, &sensor) && sigma(&found) == 1.0);
    }

    #[test]
    fn where_features_are_sharp_the_aligned_are_as_sharp() {
        let ((map, frame, pose, matches), mut sharp) = (tracked(), sensor());
        sharp.pixel_sigma = 0.1;
        let frame = frame.unaligned(&sharp);
        let mut found = aligned(&matches, pose, &frame, (&map, &sharp)).unwrap();
        let is_sharp = |found: &[PointMatch]| {
            found.iter().all(|m| m.aligned.is_some_and(|aligned| aligned.sigma <= 0.1))
        };
        assert!(is_sharp(&found) && widen(&mut found, 9.0, &frame, &sharp) && is_sharp(&found));
    }

    #[test]
    fn every_look_that_serves_is_asked() {
        let ((mut map, frame, pose, matches), sensor) = (tracked(), sensor());
        let (id, other) = (matches[5].landmark.unwrap(), matches[30].landmark.unwrap());
        let wrong = map.landmark(other).unwrap().looks[0].clone();
        map.landmark_mut(id).unwrap().looks.insert(0, wrong);
        let find = |map: &LandmarkMap| {
            let found = aligned(&matches, pose, &frame, (map, &sensor)).unwrap();
            found.into_iter().find(|m| m.landmark == Some(id))
        };
        let truth = sensor.project(pose.inverse().transform(matches[5].point)).unwrap().0;
        let there = find(&map).unwrap().aligned.unwrap();
        assert!(there.is_alike && (there.pixel - truth).norm() < 0.1, "{there:?} is not {truth}");
        map.landmark_mut(id).unwrap().looks.truncate(1);
        assert_eq!(find(&map), None, "the wrong look serves and does not fit");
    }
}
