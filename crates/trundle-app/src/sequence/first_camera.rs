//! Height, tilt and roll of the first camera: as given, by the floor in the images, or by default.

use super::floor_mount::{FloorEvidence, FoundFloor};
use trundle_runtime::CameraMount;

/// Default height of a first camera \[m\]. Source: ours, a hand-held camera.
pub(super) const DEFAULT_CAMERA_HEIGHT_M: f64 = 1.0;
/// Difference of a given height from that of the floor in the images, above which one of them is wrong \[m\]. Source: ours; of a simulated
/// Kinect V2 the map is right within 3 cm, and at 5 cm the floor is an obstacle.
const MAX_HEIGHT_ERROR_M: f64 = 0.02;
/// Difference of a given tilt or roll from that of the floor in the images, above which one of them is wrong \[deg\]. Source: ours; the floor
/// 3 m ahead is then 5 cm off. At 1.5 deg a map has 0.1 % wrong cells, at 2 deg 0.4 %. The floor in 4 images of a short drive was 0.7 deg off.
const MAX_ANGLE_ERROR_DEG: f64 = 1.0;
/// Difference of a given height from that of a plane, above which the plane is a table or another floor \[m\]. It counts only for a plane on
/// which no wheels are known to stand. Source: ours.
const MAX_OTHER_PLANE_M: f64 = 0.25;

/// Smallest number of images that show the floor, for the floor to replace a given pose. Source: ours, as `trundle calibrate mount`.
const MIN_FLOOR_IMAGES: usize = 5;

/// Pose of the first camera above the floor; `None` everywhere for the input's own.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FirstCamera {
    /// Height above the floor, m; default that of the floor in the images, else 1 m.
    pub height: Option<f64>,
    /// Downward tilt, deg; default that of the floor in the images. With another part of the pose given, it is 0 unless the floor shows more
    /// than 1 deg.
    pub tilt_deg: Option<f64>,
    /// Roll to its right, deg; default as the tilt's.
    pub roll_deg: Option<f64>,
}

/// The pose of the first camera, and its source.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FirstCameraChoice {
    /// Height, tilt and roll; the camera is above the origin.
    pub(super) mount: CameraMount,
    /// Whether a part of it is by the floor in the images.
    pub(super) is_by_floor: bool,
    /// The contradiction between the images and the given pose, and the pose that is used; `None` without one.
    pub(super) contradiction: Option<String>,
}

impl FirstCamera {
    /// Whether part of the pose is given.
    pub(super) fn is_asked(&self) -> bool {
        self.height.or(self.tilt_deg).or(self.roll_deg).is_some()
    }

    /// A whole pose.
    pub(super) fn of_mount(mount: &CameraMount) -> Self {
        Self { height: Some(mount.z), tilt_deg: Some(mount.pitch_deg), roll_deg: Some(mount.roll_deg) }
    }

    /// Tilt and roll from which the floor is searched, deg; `None` if neither is given.
    pub(super) fn search_start(&self) -> Option<(f64, f64)> {
        self.tilt_deg.or(self.roll_deg)?;
        Some((self.tilt_deg.unwrap_or_default(), self.roll_deg.unwrap_or_default()))
    }

    /// The given values, with defaults.
    pub(super) fn mount(&self) -> CameraMount {
        CameraMount {
            x: 0.0,
            y: 0.0,
            z: self.height.unwrap_or(DEFAULT_CAMERA_HEIGHT_M),
            yaw_deg: 0.0,
            pitch_deg: self.tilt_deg.unwrap_or_default(),
            roll_deg: self.roll_deg.unwrap_or_default(),
        }
    }

    /// The given values, completed by the floor in the images. A floor on which the wheels stand, seen in several images, replaces given
    /// values that contradict it.
    pub(super) fn completed_by(&self, evidence: &FloorEvidence) -> FirstCameraChoice {
        let given = FirstCameraChoice { mount: self.mount(), is_by_floor: false, contradiction: None };
        let Some(found) = evidence.found else { return given };
        let is_trusted = evidence.is_under_wheels && found.images >= MIN_FLOOR_IMAGES;
        if !is_trusted && self.height.is_some_and(|height| (height - found.mount.z).abs() > MAX_OTHER_PLANE_M)
        {
            return given;
        }
        let completed = self.filled_from(&found.mount).mount();
        let contradiction = self.contradiction(&found, evidence.searched, is_trusted);
        let mount = if contradiction.is_some() && is_trusted { found.mount } else { completed };
        FirstCameraChoice { mount, is_by_floor: mount != given.mount, contradiction }
    }

    /// The given values, and those of the floor where none is given and the default is off.
    fn filled_from(&self, floor: &CameraMount) -> Self {
        let level = |given: Option<f64>, floor_deg: f64| {
            given.or_else(|| (floor_deg.abs() > MAX_ANGLE_ERROR_DEG).then_some(floor_deg))
        };
        Self {
            height: self.height.or(Some(floor.z)),
            tilt_deg: level(self.tilt_deg, floor.pitch_deg),
            roll_deg: level(self.roll_deg, floor.roll_deg),
        }
    }

    /// The contradiction between the floor and the given values, in words; `None` without one.
    pub(super) fn contradiction(
        &self,
        found: &FoundFloor,
        searched: usize,
        is_replaced: bool,
    ) -> Option<String> {
        let (mount, seen) = (&found.mount, found.images);
        let parts = [
            ("height", "m", self.height, mount.z, MAX_HEIGHT_ERROR_M),
            ("tilt", "deg", self.tilt_deg, mount.pitch_deg, MAX_ANGLE_ERROR_DEG),
            ("roll", "deg", self.roll_deg, mount.roll_deg, MAX_ANGLE_ERROR_DEG),
        ];
        let against = parts.into_iter().filter_map(|(name, unit, given, found, bound)| {
            let is_off = |given: &f64| (given - found).abs() > bound;
            let given = given.filter(is_off)?;
            Some(format!("{name} {given} {unit} is given, and the floor shows {found:.3} {unit} (at most {bound} {unit} apart expected)"))
        });
        let against: Vec<String> = against.collect();
        let done = match is_replaced {
            true => "the floor's height, tilt and roll are used",
            false => "the given pose is used: leave it out to use the floor's",
        };
        (!against.is_empty())
            .then(|| format!("{}, in {seen} of {searched} images; {done}", against.join("; ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evidence(is_under_wheels: bool) -> FloorEvidence {
        let mount = FirstCamera { height: Some(0.449), tilt_deg: Some(7.98), roll_deg: Some(-0.02) }.mount();
        let found = Some(FoundFloor { mount, images: 28 });
        FloorEvidence { found, searched: 30, level_planes: 29, is_under_wheels }
    }

    fn given(height: f64, tilt_deg: f64) -> FirstCamera {
        FirstCamera { height: Some(height), tilt_deg: Some(tilt_deg), roll_deg: None }
    }

    #[test]
    fn a_height_5_cm_off_is_replaced_by_the_floor_under_the_wheels_and_both_are_named() {
        let seen = evidence(true);
        let choice = given(0.5, 8.0).completed_by(&seen);
        assert_eq!(choice.mount, seen.found.unwrap().mount);
        let message = choice.contradiction.unwrap();
        for part in
            ["height 0.5 m is given", "shows 0.449 m", "28 of 30", "floor's height, tilt and roll are used"]
        {
            assert!(message.contains(part), "{part} in {message}");
        }
        assert!(!message.contains("tilt 8"), "{message}");
        let tilt = given(0.45, 10.0).completed_by(&seen);
        assert!(tilt.contradiction.unwrap().contains("tilt 10 deg is given"));
    }

    #[test]
    fn a_pose_near_that_of_the_floor_is_used_as_given_and_completed() {
        let choice = given(0.45, 8.0).completed_by(&evidence(true));
        assert_eq!(choice.mount, given(0.45, 8.0).mount(), "a camera that is level within the floor's error");
        assert!(!choice.is_by_floor && choice.contradiction.is_none());
        let height = FirstCamera { height: Some(0.45), ..FirstCamera::default() };
        assert_eq!(height.completed_by(&evidence(false)).mount.pitch_deg, 7.98, "the tilt is found");
    }

    #[test]
    fn a_plane_without_wheels_replaces_nothing_and_a_table_is_not_mentioned() {
        let choice = given(0.5, 8.0).completed_by(&evidence(false));
        assert_eq!(choice.mount.z, 0.5);
        assert!(choice.contradiction.unwrap().contains("the given pose is used: leave it out"));
        let table = given(1.4, 8.0).completed_by(&evidence(false));
        assert_eq!(
            table,
            FirstCameraChoice { mount: given(1.4, 8.0).mount(), is_by_floor: false, contradiction: None }
        );
        let few = FloorEvidence {
            found: evidence(true).found.map(|found| FoundFloor { images: 4, ..found }),
            ..evidence(true)
        };
        assert_eq!(given(0.5, 8.0).completed_by(&few).mount.z, 0.5, "a floor in few images replaces nothing");
        let unseen = FloorEvidence { found: None, ..evidence(true) };
        assert_eq!(given(0.5, 8.0).completed_by(&unseen).mount.z, 0.5);
    }
}
