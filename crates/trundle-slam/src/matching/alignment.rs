//! Aligns matched features with the reference patches of their landmarks \[Forster14, sec. IV-B\].

use crate::frame::aligned_feature::{Aligned, raw};
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::map::landmark_map::LandmarkMap;
use crate::map::reference_patch::ReferencePatch;
use crate::matching::matched_pose::MatchedPose;
use crate::matching::point_match::PointMatch;
use std::collections::BTreeSet;
use trundle_core::{Hypotenuse, Pose3, Vector2};
use trundle_vision::Template;

/// Largest displacement of a feature by alignment: 2 px of its octave. Beyond it the patch is a different point. Source: ours.
const MAX_DISPLACEMENT_PX: f32 = 2.0;
/// Largest distance of a feature from its landmark's projection for an alignment that starts at the projection: 4 px of the octave. Beyond
/// it the pose is wrong, and the alignment starts at the feature. Source: ours.
const MAX_START_OFFSET_PX: f64 = 4.0;
/// Standard deviation added to that of an alignment: 0.3 px of the octave. The sum is at most that of an unaligned feature. Source:
/// docs/algorithms/alignment.md.
const MIN_ALIGNED_SIGMA_PX: f64 = 0.3;
/// Fewest aligned features of a frame: 20. With fewer, no feature is aligned, since they do not determine the pose alone.
/// Source: ours.
const MIN_ALIGNED_FEATURES: usize = 20;
/// Factor of the standard deviation of a feature without a reference patch among aligned ones: 6. Aligned features have errors of 0.1 px.
/// An unaligned feature has an error of 0.5 px with the same sign in every frame. Source: docs/algorithms/alignment.md.
const UNALIGNED_SIGMA_FACTOR: f64 = 6.0;

/// The image around a feature, compared with the reference patches of its landmark.
enum PatchComparison {
    Aligned(Aligned),
    Different,
    /// No reference patch was seen from a similar direction and distance.
    NoReference,
}

/// The matches with aligned features, for a camera near `visual_from_camera`. Matches whose image differs from the patch are dropped.
/// `None` if too few features can be aligned.
pub(crate) fn aligned(
    matches: &[PointMatch],
    visual_from_camera: Pose3,
    frame: &Frame,
    (map, model): (&LandmarkMap, &ObservationModel),
) -> Option<Vec<PointMatch>> {
    if frame.features.patches.is_empty() {
        return None;
    }
    let camera_from_visual = visual_from_camera.inverse();
    let compare = |m: &PointMatch| compare_patches(m, &camera_from_visual, frame, (map, model));
    let seen: Vec<PatchComparison> = matches.iter().map(compare).collect();
    let count = seen.iter().filter(|seen| matches!(seen, PatchComparison::Aligned(_))).count();
    (count >= MIN_ALIGNED_FEATURES).then_some(())?;
    let keep = |(m, seen): (&PointMatch, PatchComparison)| {
        let aligned = match seen {
            PatchComparison::Aligned(aligned) => aligned,
            PatchComparison::Different => return None,
            PatchComparison::NoReference => unaligned_match(m, frame),
        };
        Some(PointMatch { aligned: Some(aligned), ..*m })
    };
    Some(matches.iter().zip(seen).filter_map(keep).collect())
}

/// Multiplies the standard deviations of all alignments by `spread`, the scale of their residuals, if that is above 1: lens and shutter
/// differ from the calibration. The result is at most that of an unaligned feature. Returns whether a standard deviation changed.
pub(crate) fn inflate_sigmas(
    matches: &mut [PointMatch],
    spread: f64,
    frame: &Frame,
    model: &ObservationModel,
) -> bool {
    if spread <= 1.0 {
        return false;
    }
    for m in matches {
        let max_sigma = model.sigma_of(frame.octave(m.feature));
        if let Some(aligned) = m.aligned.as_mut().filter(|aligned| aligned.is_aligned) {
            aligned.sigma = (spread * aligned.sigma).min(max_sigma);
        }
    }
    true
}

/// Matches that agree before or after alignment. Those that agree only before keep their position with a small weight. Without a match,
/// their features would become duplicate landmarks in the next keyframe.
pub(crate) fn agreeing_matches(before: &MatchedPose, since: &MatchedPose, frame: &Frame) -> Vec<PointMatch> {
    let fits: BTreeSet<usize> = since.inliers().map(|m| m.feature).collect();
    let rest = before.inliers().filter(|m| !fits.contains(&m.feature));
    let rest = rest.map(|m| PointMatch { aligned: Some(unaligned_match(m, frame)), ..*m });
    since.inliers().copied().chain(rest).collect()
}

/// A feature at the position where it was found.
fn unaligned_match(m: &PointMatch, frame: &Frame) -> Aligned {
    let (raw, pixel) = (raw(&frame.features.keypoints[m.feature]), frame.pixels[m.feature]);
    Aligned {
        raw,
        pixel,
        sigma: UNALIGNED_SIGMA_FACTOR * f64::from(frame.pixel_sigmas[m.feature]),
        is_aligned: false,
    }
}

fn compare_patches(
    m: &PointMatch,
    camera_from_visual: &Pose3,
    frame: &Frame,
    (map, model): (&LandmarkMap, &ObservationModel),
) -> PatchComparison {
    let octave = frame.octave(m.feature);
    let landmark = m.landmark.and_then(|id| map.landmark(id));
    let Some((landmark, patch)) = landmark.zip(frame.features.patches.get(m.feature)) else {
        return PatchComparison::NoReference;
    };
    let seen = |reference: &ReferencePatch| {
        reference.seen_from(camera_from_visual, landmark.position, octave, model)
    };
    let mut templates = landmark.reference_patches.iter().filter_map(seen).peekable();
    if templates.peek().is_none() {
        return PatchComparison::NoReference;
    }
    let scale = model.scale(octave);
    let start = predicted_offset(m, camera_from_visual, frame, model) / scale;
    let start = if start.amax() <= MAX_START_OFFSET_PX { start } else { Vector2::zeros() };
    let find = |template: Template| {
        template.find(patch, start.cast()).filter(|found| found.offset.amax() <= MAX_DISPLACEMENT_PX)
    };
    let Some(found) = templates.find_map(find) else { return PatchComparison::Different };
    let raw = raw(&frame.features.keypoints[m.feature]) + found.offset.cast() * scale;
    let sigma = MIN_ALIGNED_SIGMA_PX.hypotenuse(f64::from(found.sigma)).min(model.pixel_sigma) * scale;
    PatchComparison::Aligned(Aligned { raw, pixel: model.camera.undistort(raw), sigma, is_aligned: true })
}

/// Offset of the landmark's projection from its feature, px; zero if the landmark is out of view.
fn predicted_offset(
    m: &PointMatch,
    camera_from_visual: &Pose3,
    frame: &Frame,
    model: &ObservationModel,
) -> Vector2 {
    let seen = model.project(camera_from_visual.transform(m.point));
    seen.map_or_else(Vector2::zeros, |(pixel, _)| pixel - frame.pixels[m.feature])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local_mapping::reference_patch_storage::store_reference_patches;
    use crate::matching::matched_pose::PosePriorKind;
    use crate::testing::{model, painted_frame, painted_map, painted_points};
    use nalgebra::Vector6;
    use trundle_optim::PoseConfig;

    /// A map of a wall with reference patches, and a frame from a nearer position to the side, with features 1 px off.
    fn tracked() -> (LandmarkMap, Frame, Pose3, Vec<PointMatch>) {
        let (mut map, keyframe) = painted_map();
        store_reference_patches(&mut map, keyframe, &model());
        let pose = Pose3::exp(Vector6::new(0.2, 0.0, 0.3, 0.0, -0.1, 0.05));
        let frame = painted_frame(pose, &painted_points(), Vector2::new(0.8, -0.6));
        let ids = map.landmarks().enumerate();
        let matches = ids.map(|(i, (id, _))| PointMatch::of_landmark(i, id, &map).unwrap()).collect();
        (map, frame, pose, matches)
    }

    #[test]
    fn features_are_aligned_to_their_landmarks() {
        let ((map, frame, pose, matches), model) = (tracked(), model());
        let about = pose * Pose3::exp(Vector6::new(0.004, 0.0, 0.0, 0.0, 0.003, 0.0));
        let found = aligned(&matches, about, &frame, (&map, &model)).unwrap();
        assert_eq!(found.len(), matches.len());
        for m in &found {
            let truth = model.project(pose.inverse().transform(m.point)).unwrap().0;
            let aligned = m.aligned.unwrap();
            assert!((aligned.pixel - truth).norm() < 0.1 && aligned.is_aligned, "{aligned:?} is not {truth}");
            assert!((0.3..0.4).contains(&aligned.sigma));
        }
        let moved = found.iter().filter_map(|m| Some((m.feature, m.aligned?)));
        let (first, there) = (frame.pixels[0], found[0].aligned.unwrap());
        let frame = frame.with_aligned(moved, &model);
        assert!(
            frame.near(there.pixel, 0.05, (0, 0)).eq([0]) && frame.near(first, 0.5, (0, 0)).next().is_none()
        );
        assert!((frame.median_aligned_sigma_px(&model) - 0.3).abs() < 0.02);
    }

    #[test]
    fn different_patches_are_dropped_and_features_without_reference_weigh_little() {
        let ((mut map, frame, pose, mut matches), model) = (tracked(), model());
        matches[5] = PointMatch { feature: matches[6].feature, ..matches[5] };
        map.landmark_mut(matches[9].landmark.unwrap()).unwrap().reference_patches.clear();
        let found = aligned(&matches, pose, &frame, (&map, &model)).unwrap();
        assert!(found.iter().all(|m| m.landmark != matches[5].landmark));
        let unknown = found.iter().find(|m| m.landmark == matches[9].landmark).unwrap().aligned.unwrap();
        assert_eq!(
            (unknown.pixel, unknown.sigma, unknown.is_aligned),
            (frame.pixels[9], UNALIGNED_SIGMA_FACTOR, false)
        );
    }

    #[test]
    fn matches_that_no_longer_fit_are_kept_with_little_weight() {
        let ((map, frame, pose, matches), model) = (tracked(), model());
        let solve = |matches| {
            let prior = PosePriorKind::Tracked(None);
            MatchedPose::by(matches, (pose, prior), &frame, &model, &PoseConfig::default())
        };
        let before = solve(matches.clone());
        assert_eq!(before.solution.inlier_count, matches.len());
        let mut fitting = aligned(&matches, pose, &frame, (&map, &model)).unwrap();
        fitting.remove(3);
        let seen = agreeing_matches(&before, &solve(fitting), &frame);
        assert_eq!(seen.len(), matches.len());
        let again = seen.iter().find(|m| m.landmark == matches[3].landmark).unwrap().aligned.unwrap();
        assert_eq!((again.pixel, again.is_aligned), (frame.pixels[matches[3].feature], false));
        assert!(seen.iter().filter(|m| m.aligned.unwrap().is_aligned).count() == matches.len() - 1);
    }

    #[test]
    fn too_few_aligned_features_are_not_used() {
        let ((map, mut frame, pose, matches), model) = (tracked(), model());
        assert!(aligned(&matches[..MIN_ALIGNED_FEATURES], pose, &frame, (&map, &model)).is_some());
        assert_eq!(aligned(&matches[1..MIN_ALIGNED_FEATURES], pose, &frame, (&map, &model)), None);
        frame.drop_image();
        assert_eq!(aligned(&matches, pose, &frame, (&map, &model)), None);
    }

    #[test]
    fn sigmas_are_inflated_to_the_residuals_and_never_reduced() {
        let ((map, frame, pose, matches), model) = (tracked(), model());
        let mut found = aligned(&matches, pose, &frame, (&map, &model)).unwrap();
        let sigma = |found: &[PointMatch]| found[0].aligned.unwrap().sigma;
        let reported = sigma(&found);
        assert!(!inflate_sigmas(&mut found, 0.7, &frame, &model) && sigma(&found) == reported);
        assert!(inflate_sigmas(&mut found, 2.0, &frame, &model) && sigma(&found) == 2.0 * reported);
        assert!(inflate_sigmas(&mut found, 99.0, &frame, &model) && sigma(&found) == 1.0);
    }

    #[test]
    fn aligned_sigmas_never_exceed_those_of_plain_features() {
        let ((map, frame, pose, matches), mut sharp) = (tracked(), model());
        sharp.pixel_sigma = 0.1;
        let frame = frame.unaligned(&sharp);
        let mut found = aligned(&matches, pose, &frame, (&map, &sharp)).unwrap();
        let is_sharp = |found: &[PointMatch]| {
            found.iter().all(|m| m.aligned.is_some_and(|aligned| aligned.sigma <= 0.1))
        };
        assert!(is_sharp(&found) && inflate_sigmas(&mut found, 9.0, &frame, &sharp) && is_sharp(&found));
    }

    #[test]
    fn every_usable_reference_patch_is_tried() {
        let ((mut map, frame, pose, matches), model) = (tracked(), model());
        let (id, other) = (matches[5].landmark.unwrap(), matches[30].landmark.unwrap());
        let wrong = map.landmark(other).unwrap().reference_patches[0].clone();
        map.landmark_mut(id).unwrap().reference_patches.insert(0, wrong);
        let find = |map: &LandmarkMap| {
            let found = aligned(&matches, pose, &frame, (map, &model)).unwrap();
            found.into_iter().find(|m| m.landmark == Some(id))
        };
        let truth = model.project(pose.inverse().transform(matches[5].point)).unwrap().0;
        let there = find(&map).unwrap().aligned.unwrap();
        assert!(there.is_aligned && (there.pixel - truth).norm() < 0.1, "{there:?} is not {truth}");
        map.landmark_mut(id).unwrap().reference_patches.truncate(1);
        assert_eq!(find(&map), None, "the wrong patch is usable and does not fit");
    }
}
