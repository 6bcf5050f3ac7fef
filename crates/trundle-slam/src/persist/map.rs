//! One landmark map as bytes. Keyframes and landmarks are numbered anew, without gaps, in the order of their making.

use super::bytes::{Reader, Writer};
use super::error::MapFileError;
use super::{frame, look};
use crate::ids::{KeyframeId, LandmarkId};
use crate::landmark::Landmark;
use crate::map::{Keyframe, LandmarkMap};
use crate::rolled::Rolled;
use crate::sensor::Sensor;
use nalgebra::Matrix6;
use std::collections::BTreeMap;

/// The least bytes of a keyframe, a landmark and an observation.
const LEAST: (usize, usize, usize) = (8 + 4 + 7 * 8 + 72 * 8 + 1, 24 + 32 + 24 + 8 + 4 * 3 + 8 + 1, 8);

pub(super) fn write(out: &mut Writer, map: &LandmarkMap) {
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

pub(super) fn read(bytes: &mut Reader, sensor: &Sensor) -> Result<LandmarkMap, MapFileError> {
    let mut map = LandmarkMap::default();
    bytes.within = "keyframes";
    let count = bytes.count(LEAST.0)?;
    bytes.require(count > 0, "keyframes of a map", count, || "1 or more".to_owned())?;
    let mut ids = Vec::new();
    for _ in 0..count {
        ids.push(read_keyframe(bytes, &mut map, sensor, &ids)?);
    }
    map.floor = bytes.mark("mark of a floor")?.then(|| bytes.direction("axis of the floor")).transpose()?;
    bytes.within = "landmarks";
    for _ in 0..bytes.count(LEAST.1)? {
        read_landmark(bytes, &mut map, &ids)?;
    }
    ids.iter().for_each(|id| map.enter_tree(*id));
    bytes.within = "loops";
    for _ in 0..bytes.count(8)? {
        let (old, new) =
            (bytes.index("keyframe of a loop", ids.len())?, bytes.index("keyframe of a loop", ids.len())?);
        bytes.require(old < new, "keyframe of a loop", old, || format!("less than {new}"))?;
        map.tie(ids[old], ids[new]);
    }
    Ok(map)
}

fn write_keyframe(out: &mut Writer, keyframe: &Keyframe, number: impl Fn(KeyframeId) -> usize) {
    frame::write(out, &keyframe.frame);
    out.pose(&keyframe.visual_from_camera);
    out.f64s(keyframe.covariance.iter().chain(keyframe.ground.iter()).copied());
    out.u8(u8::from(keyframe.rolled.is_some()));
    if let Some(Rolled { from, from_to, covariance }) = &keyframe.rolled {
        out.count(number(*from));
        out.pose(from_to);
        out.f64s(covariance.iter().copied());
    }
}

fn read_keyframe(
    bytes: &mut Reader,
    map: &mut LandmarkMap,
    sensor: &Sensor,
    before: &[KeyframeId],
) -> Result<KeyframeId, MapFileError> {
    let frame = frame::read(bytes, sensor)?;
    let pose = bytes.pose("pose of a keyframe")?;
    let whole = read_covariance(bytes, "covariance of a keyframe")?;
    let ground = read_covariance(bytes, "covariance of a keyframe")?;
    let rolled = bytes.mark("mark of a way")?.then(|| read_rolled(bytes, before)).transpose()?;
    let id = map.add_keyframe(frame, pose);
    map.set_covariances(id, whole, ground);
    map.keyframe_mut(id).rolled = rolled;
    Ok(id)
}

/// The way to a keyframe from one of those before it.
fn read_rolled(bytes: &mut Reader, before: &[KeyframeId]) -> Result<Rolled, MapFileError> {
    let from = before[bytes.index("keyframe that a way begins at", before.len())?];
    let from_to = bytes.pose("way between keyframes")?;
    Ok(Rolled { from, from_to, covariance: read_covariance(bytes, "covariance of a way")? })
}

fn read_covariance(bytes: &mut Reader, name: &str) -> Result<Matrix6<f64>, MapFileError> {
    let mut covariance = Matrix6::zeros();
    for entry in covariance.iter_mut() {
        *entry = bytes.length(name)?;
    }
    let least = ((covariance + covariance.transpose()) / 2.0).symmetric_eigenvalues().min();
    let size = covariance.amax();
    let is_one = (covariance - covariance.transpose()).amax() <= ROUNDING * size && least >= -ROUNDING * size;
    bytes.require(is_one, name, format!("eigenvalue {least:e}"), || {
        "symmetric, eigenvalues of 0 or more".to_owned()
    })?;
    Ok(covariance)
}

/// What sums of products leave of symmetry and sign, of the largest entry.
const ROUNDING: f64 = 1e-9;

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
    look::write_all(out, &landmark.looks);
}

fn read_landmark(bytes: &mut Reader, map: &mut LandmarkMap, ids: &[KeyframeId]) -> Result<(), MapFileError> {
    let id = map.add_landmark(bytes.vector("position of a landmark")?);
    let descriptor = bytes.descriptor()?;
    let toward_camera = bytes.vector("direction of a landmark")?;
    let distance_at_octave_0 = bytes.f64_in("distance of a landmark at octave 0", 0.0, 1e9)?;
    let (visible, found) = (bytes.u32()?, bytes.u32()?);
    let observations = bytes.count(LEAST.2)?;
    bytes.require(observations > 0, "observations of a landmark", 0, || "1 or more".to_owned())?;
    for _ in 0..observations {
        read_observation(bytes, map, ids, id)?;
    }
    let looks = look::read_all(bytes)?;
    if let Some(landmark) = map.landmark_mut(id) {
        *landmark = Landmark {
            descriptor,
            toward_camera,
            distance_at_octave_0,
            looks,
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
    use crate::motion::MotionConfig;
    use crate::testing::{blank_frame, sensor};
    use nalgebra::Vector6;
    use trundle_core::{Pose3, Vector3};

    /// Two keyframes with the way between them by the wheels, on a floor.
    fn rolled_map() -> (LandmarkMap, Rolled) {
        let mut map = LandmarkMap::default();
        let ids = [0.0, 0.1]
            .map(|x| map.add_keyframe(blank_frame(3), Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0))));
        let step = Pose3::exp(Vector6::new(0.1, 0.0, 0.02, 0.0, 0.3, 0.0));
        let rolled = Rolled::at(ids[0]).on(step.into(), 0.1, &MotionConfig::default()).unwrap();
        map.keyframe_mut(ids[1]).rolled = Some(rolled);
        map.floor = Some(Vector3::y());
        (map, rolled)
    }

    #[test]
    fn the_ways_by_the_wheels_and_the_floor_come_back() {
        let (map, rolled) = rolled_map();
        let mut out = Writer::default();
        write(&mut out, &map);
        let read = read(&mut Reader::new(&out.0, "map"), &sensor()).unwrap();
        let ways: Vec<Option<Rolled>> = read.keyframes().map(|(_, keyframe)| keyframe.rolled).collect();
        assert_eq!(ways, vec![None, Some(rolled)]);
        assert_eq!(read.floor, Some(Vector3::y()));
    }

    #[test]
    fn a_way_from_what_comes_later_is_refused() {
        let (mut map, rolled) = rolled_map();
        let last = map.newest_keyframe().unwrap();
        map.keyframe_mut(last).rolled = Some(Rolled { from: last, ..rolled });
        let mut out = Writer::default();
        write(&mut out, &map);
        let error = read(&mut Reader::new(&out.0, "map"), &sensor()).unwrap_err().to_string();
        assert!(error.ends_with("keyframe that a way begins at is 1, expected less than 1"), "{error}");
    }
}
