//! Messages about the pose of the first camera.

use super::first_camera::{DEFAULT_CAMERA_HEIGHT_M, FirstCamera, FirstCameraChoice};
use super::floor_mount::{FloorEvidence, FoundFloor};
use crate::sequence_input::SequenceInput;

/// The remedy of an unknown pose.
const REMEDY: &str = "give --height (m), --tilt and --roll (deg)";

/// Logs the source of the first camera's pose: a warning if the pose may be wrong.
pub(super) fn log_choice(
    input: &SequenceInput,
    given: &FirstCamera,
    choice: &FirstCameraChoice,
    evidence: &FloorEvidence,
) {
    let (path, mount) = (input.path.display(), &choice.mount);
    let pose = format!("{:.3} m, tilt {:.2} deg, roll {:.2} deg", mount.z, mount.pitch_deg, mount.roll_deg);
    let searched = evidence.searched;
    if let Some(contradiction) = &choice.contradiction {
        return tracing::warn!("{path}: first camera at {pose}: {contradiction}");
    }
    match evidence.found {
        None if given.is_asked() || searched == 0 => {}
        None => tracing::warn!(
            "{path}: {}, so the height of the first camera is taken as {DEFAULT_CAMERA_HEIGHT_M} m and its tilt as 0 deg: {REMEDY} for a \
             level map",
            why_none(evidence)
        ),
        Some(FoundFloor { images, .. }) if input.odometry().is_some() => {
            tracing::info!("{path}: first camera at {pose}, by the floor in {images} of {searched} images");
        }
        Some(_) if given.is_asked() => {}
        Some(_) => tracing::warn!(
            "{path}: first camera at {pose}, by the lowest plane in the first {searched} images: {REMEDY} if this plane is a table"
        ),
    }
}

/// Why no floor was found.
fn why_none(evidence: &FloorEvidence) -> String {
    let FloorEvidence { level_planes, searched, .. } = evidence;
    if *level_planes == 0 {
        return "the first images show no floor".to_owned();
    }
    format!(
        "{level_planes} of {searched} searched images show a level plane, but not the same one, or not the lowest (a ramp, stairs, a table)"
    )
}
