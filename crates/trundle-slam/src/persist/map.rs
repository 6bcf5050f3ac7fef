//! One landmark map as bytes. Keyframes and landmarks are renumbered without gaps, in the order of their creation.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::keyframe::Keyframe;
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use crate::motion::uncertain_pose::UncertainPose;
use crate::persist::bytes::{Reader, Writer};
use crate::persist::error::MapFileError;
use crate::persist::{frame, reference_patch};
use nalgebra::Matrix6;
use std::collections::BTreeMap;

/// Fewest bytes of a keyframe: a count beyond the rest of the bytes is refused before memory is reserved. Source: the layout that this file
/// writes.
const MIN_KEYFRAME_BYTES: usize = 8 + 4 + 7 * 8 + 72 * 8 + 1;
/// Fewest bytes of a landmark. Source: the layout that this file writes.
const MIN_LANDMARK_BYTES: usize = 24 + 32 + 24 + 8 + 4 * 3 + 8 + 1;
/// Bytes of an observation. Source: the layout that this file writes.
const OBSERVATION_BYTES: usize = 8;

pub(crate) fn write(out: &mut Writer, map: &LandmarkMap) {
    let numbers: BTreeMap<KeyframeId, usize> = map.keyframes().map(|(id, _)| id).zip(0..).collect();
    out.count(numbers.len());
    for (_, keyframe) in map.keyframes() {
        write_keyframe(out, keyframe, |id| numbers[&id]);
    }
    out.u8(u8::from(map.floor.is_some()));
    out.f64s(map.floor.iter().flat_map(|axis| axis.iter().copied()));
    out.count(map.landmark_count());
    for (_, landmark) in map.landmarks() {
        write_landmark(out, landmark, |id| numbers[&id]);
    }
    let loops: Vec<(KeyframeId, KeyframeId)> = map.loops().collect();
    out.count(loops.len());
    for (old, new) in loops {
        out.count(numbers[&old]);
        out.count(numbers[&new]);
    }
}

pub(crate) fn read(bytes: &mut Reader, model: &ObservationModel) -> Result<LandmarkMap, MapFileError> {
    let mut map = LandmarkMap::default();
    bytes.within = "keyframes";
    let count = bytes.count(MIN_KEYFRAME_BYTES)?;
    bytes.require(count > 0, "keyframes of a map", count, || "1 or more".to_owned())?;
    let mut ids = Vec::new();
    for _ in 0..count {
        ids.push(read_keyframe(bytes, &mut map, model, &ids)?);
    }
    map.floor = bytes.mark("mark of a floor")?.then(|| bytes.direction("axis of the floor")).transpose()?;
    bytes.within = "landmarks";
    for _ in 0..bytes.count(MIN_LANDMARK_BYTES)? {
        read_landmark(bytes, &mut map, &ids)?;
    }
    ids.iter().for_each(|id| map.add_to_spanning_tree(*id));
    bytes.within = "loops";
    for _ in 0..bytes.count(8)? {
        let (old, new) =
            (bytes.index("keyframe of a loop", ids.len())?, bytes.index("keyframe of a loop", ids.len())?);
        bytes.require(old < new, "keyframe of a loop", old, || format!("less than {new}"))?;
        map.add_loop_edge(ids[old], ids[new]);
    }
    Ok(map)
}

fn write_keyframe(out: &mut Writer, keyframe: &Keyframe, number: impl Fn(KeyframeId) -> usize) {
    frame::write(out, &keyframe.frame);
    out.pose(&keyframe.visual_from_camera);
    out.f64s(keyframe.covariance.iter().chain(keyframe.map_covariance.iter()).copied());
    out.u8(u8::from(keyframe.odometry.is_some()));
    if let Some(OdometryFactor { from, from_to: UncertainPose { pose, covariance } }) = &keyframe.odometry {
        out.count(number(*from));
        out.pose(pose);
        out.f64s(covariance.iter().copied());
    }
}

fn read_keyframe(
    bytes: &mut Reader,
    map: &mut LandmarkMap,
    model: &ObservationModel,
    before: &[KeyframeId],
) -> Result<KeyframeId, MapFileError> {
    let frame = frame::read(bytes, model)?;
    let pose = bytes.pose("pose of a keyframe")?;
    let whole = read_covariance(bytes, "covariance of a keyframe")?;
    let map_covariance = read_covariance(bytes, "covariance of a keyframe")?;
    let odometry =
        bytes.mark("mark of an odometry factor")?.then(|| read_odometry(bytes, before)).transpose()?;
    let id = map.add_keyframe(frame, pose);
    map.set_covariances(id, whole, map_covariance);
    map.keyframe_mut(id).odometry = odometry;
    Ok(id)
}

/// The odometry to a keyframe from one of those before it.
fn read_odometry(bytes: &mut Reader, before: &[KeyframeId]) -> Result<OdometryFactor, MapFileError> {
    let from = before[bytes.index("first keyframe of an odometry factor", before.len())?];
    let pose = bytes.pose("pose of an odometry factor")?;
    let covariance = read_covariance(bytes, "covariance of an odometry factor")?;
    Ok(OdometryFactor { from, from_to: UncertainPose { pose, covariance } })
}

fn read_covariance(bytes: &mut Reader, name: &str) -> Result<Matrix6<f64>, MapFileError> {
    let mut covariance = Matrix6::zeros();
    for entry in covariance.iter_mut() {
        *entry = bytes.length(name)?;
    }
    let min = ((covariance + covariance.transpose()) / 2.0).symmetric_eigenvalues().min();
    let size = covariance.amax();
    let is_semidefinite =
        (covariance - covariance.transpose()).amax() <= MAX_ASYMMETRY * size && min >= -MAX_ASYMMETRY * size;
    bytes.require(is_semidefinite, name, format!("eigenvalue {min:e}"), || {
        "symmetric, eigenvalues of 0 or more".to_owned()
    })?;
    Ok(covariance)
}

/// Largest asymmetry and most negative eigenvalue of a covariance, as a fraction of its largest entry: 1e-9, the rounding of sums
/// of products. Source: ours.
const MAX_ASYMMETRY: f64 = 1e-9;

fn write_landmark(out: &mut Writer, landmark: &Landmark, number: impl Fn(KeyframeId) -> usize) {
    out.f64s(landmark.position.iter().copied());
    out.descriptor(&landmark.descriptor);
    out.f64s(landmark.toward_camera.iter().copied());
    out.f64(landmark.distance_at_octave_0);
    out.u32(landmark.visible);
    out.u32(landmark.found);
    out.count(landmark.observations.len());
    for (keyframe, feature) in &landmark.observations {
        out.count(number(*keyframe));
        out.count(*feature);
    }
    reference_patch::write_all(out, &landmark.reference_patches);
}

fn read_landmark(bytes: &mut Reader, map: &mut LandmarkMap, ids: &[KeyframeId]) -> Result<(), MapFileError> {
    let id = map.add_landmark(bytes.vector("position of a landmark")?);
    let descriptor = bytes.descriptor()?;
    let toward_camera = bytes.vector("direction of a landmark")?;
    let distance_at_octave_0 = bytes.f64_in("distance of a landmark at octave 0", 0.0, 1e9)?;
    let (visible, found) = (bytes.u32()?, bytes.u32()?);
    let observations = bytes.count(OBSERVATION_BYTES)?;
    bytes.require(observations > 0, "observations of a landmark", 0, || "1 or more".to_owned())?;
    for _ in 0..observations {
        read_observation(bytes, map, ids, id)?;
    }
    let reference_patches = reference_patch::read_all(bytes)?;
    if let Some(landmark) = map.landmark_mut(id) {
        *landmark = Landmark {
            descriptor,
            toward_camera,
            distance_at_octave_0,
            reference_patches,
            visible,
            found,
            ..std::mem::replace(landmark, Landmark::new(landmark.position))
        };
    }
    Ok(())
}

fn read_observation(
    bytes: &mut Reader,
    map: &mut LandmarkMap,
    ids: &[KeyframeId],
    landmark: LandmarkId,
) -> Result<(), MapFileError> {
    let keyframe = ids[bytes.index("keyframe of an observation", ids.len())?];
    let features = map.keyframe(keyframe).frame.len();
    let feature = bytes.index("feature of an observation", features)?;
    let is_new = map.observe(landmark, keyframe, feature);
    bytes.require(is_new, "feature of an observation", feature, || {
        "one landmark a feature, one feature a landmark".to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::motion_model::MotionModelConfig;
    use crate::testing::{blank_frame, model};
    use nalgebra::Vector6;
    use trundle_core::{Pose3, Vector3};

    /// Two keyframes with odometry between them, on a floor.
    fn map_with_odometry() -> (LandmarkMap, OdometryFactor) {
        let mut map = LandmarkMap::default();
        let ids = [0.0, 0.1]
            .map(|x| map.add_keyframe(blank_frame(3), Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0))));
        let step = Pose3::exp(Vector6::new(0.1, 0.0, 0.02, 0.0, 0.3, 0.0));
        let odometry =
            OdometryFactor::at(ids[0]).extended_by(step.into(), 0.1, &MotionModelConfig::default()).unwrap();
        map.keyframe_mut(ids[1]).odometry = Some(odometry);
        map.floor = Some(Vector3::y());
        (map, odometry)
    }

    #[test]
    fn odometry_factors_and_the_floor_come_back() {
        let (map, odometry) = map_with_odometry();
        let mut out = Writer::default();
        write(&mut out, &map);
        let read = read(&mut Reader::new(&out.0, "map"), &model()).unwrap();
        let factors: Vec<Option<OdometryFactor>> =
            read.keyframes().map(|(_, keyframe)| keyframe.odometry).collect();
        assert_eq!(factors, vec![None, Some(odometry)]);
        assert_eq!(read.floor, Some(Vector3::y()));
    }

    #[test]
    fn odometry_from_a_later_keyframe_is_refused() {
        let (mut map, odometry) = map_with_odometry();
        let last = map.newest_keyframe().unwrap();
        map.keyframe_mut(last).odometry = Some(OdometryFactor { from: last, ..odometry });
        let mut out = Writer::default();
        write(&mut out, &map);
        let error = read(&mut Reader::new(&out.0, "map"), &model()).unwrap_err().to_string();
        assert!(
            error.ends_with("first keyframe of an odometry factor is 1, expected less than 1"),
            "{error}"
        );
    }
}
