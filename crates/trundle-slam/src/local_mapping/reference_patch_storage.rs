//! Stores the image patches of a new keyframe's landmarks.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::landmark_map::LandmarkMap;
use crate::map::reference_patch::{MAX_REFERENCE_PATCHES, ReferencePatch};

/// Stores new reference patches of a keyframe's landmarks, and frees the image. The feature of a landmark's first patch gets the standard
/// deviation of an aligned feature.
pub(crate) fn store_reference_patches(map: &mut LandmarkMap, id: KeyframeId, model: &ObservationModel) {
    let median_aligned_sigma_px = map.keyframe(id).frame.median_aligned_sigma_px(model);
    for (feature, seen, look) in new_reference_patches(map, id, model) {
        let Some(landmark) = map.landmark_mut(seen) else { continue };
        // Most landmarks have one patch; reserving four would cost 2 kB.
        landmark.reference_patches.reserve_exact(1);
        landmark.reference_patches.push(look);
        if landmark.reference_patches.len() == 1 {
            let frame = &mut map.keyframe_mut(id).frame;
            frame.pixel_sigmas[feature] =
                (median_aligned_sigma_px * model.scale(frame.octave(feature))) as f32;
        }
    }
    map.keyframe_mut(id).frame.drop_image();
}

fn new_reference_patches(
    map: &LandmarkMap,
    id: KeyframeId,
    model: &ObservationModel,
) -> Vec<(usize, LandmarkId, ReferencePatch)> {
    let keyframe = map.keyframe(id);
    let pose = keyframe.visual_from_camera;
    let camera_from_visual = pose.inverse();
    let new = |(feature, seen): (usize, &Option<LandmarkId>)| {
        let landmark = map.landmark((*seen)?)?;
        let octave = keyframe.frame.octave(feature);
        let shows = |look: &ReferencePatch| {
            look.seen_from(&camera_from_visual, landmark.position, octave, model).is_some()
        };
        (landmark.reference_patches.len() < MAX_REFERENCE_PATCHES
            && !landmark.reference_patches.iter().any(shows))
        .then_some(())?;
        Some((
            feature,
            (*seen)?,
            ReferencePatch::of(&keyframe.frame, feature, (pose, landmark.position), model)?,
        ))
    };
    keyframe.landmarks.iter().enumerate().filter_map(new).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::landmark::Landmark;
    use crate::testing::{model, painted_frame, painted_map, painted_points};
    use trundle_core::{Pose3, Vector2};

    #[test]
    fn one_patch_is_kept_and_its_feature_is_as_certain_as_the_aligned_ones() {
        let ((mut map, keyframe), model) = (painted_map(), model());
        map.keyframe_mut(keyframe).frame.pixel_sigmas[7] = 0.25;
        store_reference_patches(&mut map, keyframe, &model);
        let has_one = |landmark: &Landmark| {
            landmark.reference_patches.len() == 1 && landmark.reference_patches.capacity() == 1
        };
        assert!(map.landmarks().all(|(_, landmark)| has_one(landmark)));
        let frame = &map.keyframe(keyframe).frame;
        assert!(frame.pixel_sigmas.iter().all(|sigma| *sigma == 0.25) && frame.features.patches.is_empty());
        let frame = painted_frame(Pose3::identity(), &painted_points(), Vector2::zeros());
        let again = map.add_keyframe(frame, Pose3::identity());
        for (feature, id) in map.landmarks().map(|(id, _)| id).collect::<Vec<_>>().into_iter().enumerate() {
            map.observe(id, again, feature);
        }
        store_reference_patches(&mut map, again, &model);
        assert!(map.landmarks().all(|(_, landmark)| landmark.reference_patches.len() == 1));
        assert_eq!(map.keyframe(again).frame.pixel_sigmas[3], 1.0);
    }
}
