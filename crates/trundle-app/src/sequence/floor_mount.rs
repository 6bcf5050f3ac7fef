//! Height, tilt and roll of the first camera by the floor in the first images.

use crate::AppError;
use crate::sequence_input::SequenceInput;
use trundle_core::{DepthImage, PinholeCamera, Pose3, Stamp, Vector3};
use trundle_estimation::{FloorMount, FloorSearch, FloorView};
use trundle_runtime::CameraMount;

/// Number of images from which those with the floor are taken, of a camera that is fixed on a robot. Source: ours, 20 to 40 s.
const FIRST_IMAGES: usize = 600;
/// Step between two searched images of a camera that is fixed on a robot \[images\]. Source: ours.
const IMAGE_STEP: usize = 20;
/// Number of searched images of a camera that is not fixed on a robot: its pose is then still that of the first image. Source: ours.
const HAND_HELD_IMAGES: usize = 3;
/// Smallest share of the searched images that must show the same floor \[1\]. Source: ours.
const MIN_IMAGE_SHARE: f64 = 0.5;
/// Tilts from which the search starts, each good for 20 deg around it \[deg\]. A plane seen at a steeper tilt may be the wall before a camera
/// that looks up. Source: ours, cameras of robots first.
const START_TILTS_DEG: [f64; 2] = [0.0, 30.0];
/// Pixels between two samples below the floor. Source: ours.
const SAMPLE_STEP_PX: usize = 8;
/// Smallest distance below a plane at which a point shows that the plane is a table and not the floor \[m\]. Source: ours.
const BELOW_FLOOR_M: f64 = 0.1;
/// Largest share of points below the floor \[1\]: stairs and errors of depth. Source: ours.
const MAX_BELOW_SHARE: f64 = 0.05;

/// Path of the robot along the searched images from which the floor is that on which its wheels stand \[m\]: a plane that stays at the same
/// height below a camera that moves is no ramp ahead and no table. Source: ours.
const MIN_PATH_M: f64 = 0.5;

/// The pose of the first camera above the floor that the images show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FoundFloor {
    /// Height, tilt and roll; the camera is above the origin.
    pub(super) mount: CameraMount,
    /// Images that show this floor.
    pub(super) images: usize,
}

/// The search of the floor in the first images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FloorEvidence {
    /// The floor; `None` if less than half of the images show one.
    pub(super) found: Option<FoundFloor>,
    /// Images that were searched.
    pub(super) searched: usize,
    /// Images that show a level plane, which need not be the same in all of them.
    pub(super) level_planes: usize,
    /// Whether a robot moved along the searched images, whose wheels stood on the floor.
    pub(super) is_under_wheels: bool,
}

/// Searches the floor in the first images, from the tilt and roll of `given` (deg), else from usual tilts.
///
/// # Errors
/// When the images cannot be read.
pub(super) fn floor_evidence(
    input: &SequenceInput,
    given: Option<(f64, f64)>,
) -> Result<FloorEvidence, AppError> {
    let (depths, last) = first_depths(input)?;
    let camera = &input.camera.model.camera;
    let (mut found, mut level_planes) = (None, 0);
    for start in given.into_iter().chain(START_TILTS_DEG.map(|tilt| (tilt, 0.0))) {
        let tried = FloorTry::near(&depths, camera, start);
        level_planes = level_planes.max(tried.level_planes);
        found = tried.found;
        if found.is_some() {
            break;
        }
    }
    Ok(FloorEvidence {
        found,
        searched: depths.len(),
        level_planes,
        is_under_wheels: last.is_some_and(|last| path_until(input, last) >= MIN_PATH_M),
    })
}

/// Path of the robot up to an image by its odometry, m; 0 without odometry.
fn path_until(input: &SequenceInput, last: Stamp) -> f64 {
    let poses = input.odometry().unwrap_or_default();
    let until: Vec<_> = poses.iter().take_while(|(stamp, _)| *stamp <= last).collect();
    until.windows(2).map(|pair| (pair[1].1.position() - pair[0].1.position()).norm()).sum()
}

/// The depth of some of the first images, and the stamp of the last of them.
fn first_depths(input: &SequenceInput) -> Result<(Vec<DepthImage>, Option<Stamp>), AppError> {
    let is_fixed = input.odometry().is_some();
    let (count, step) = if is_fixed { (FIRST_IMAGES, IMAGE_STEP) } else { (HAND_HELD_IMAGES, 1) };
    let (mut depths, mut last) = (Vec::new(), None);
    for frame in input.frames()?.take(count).step_by(step) {
        if let Ok(image) = frame?.decode() {
            last = Some(image.stamp());
            depths.push(image.into_images().1);
        }
    }
    Ok((depths, last))
}

/// The floor of a camera with about one tilt and roll.
struct FloorTry {
    found: Option<FoundFloor>,
    level_planes: usize,
}

impl FloorTry {
    /// Searches from a tilt and roll, deg.
    fn near(depths: &[DepthImage], camera: &PinholeCamera, (pitch_deg, roll_deg): (f64, f64)) -> Self {
        let level = CameraMount { x: 0.0, y: 0.0, z: 0.0, yaw_deg: 0.0, pitch_deg, roll_deg };
        let mut search = FloorSearch::new(up_of(&level.base_from_camera()));
        depths.iter().for_each(|depth| search.add(depth, camera));
        Self { found: common_floor(&search, depths, camera), level_planes: search.proposals() }
    }
}

/// The floor that most of the images show and that has nothing below.
fn common_floor(search: &FloorSearch, depths: &[DepthImage], camera: &PinholeCamera) -> Option<FoundFloor> {
    let views = search.views();
    let floor = FloorMount::of(&views, None)?;
    let mount = CameraMount {
        x: 0.0,
        y: 0.0,
        z: floor.height.value,
        yaw_deg: 0.0,
        pitch_deg: floor.pitch.value.to_degrees(),
        roll_deg: floor.roll.value.to_degrees(),
    };
    let plane = FloorView { up: up_of(&mount.base_from_camera()), height: mount.z };
    let is_lowest = depths.iter().all(|depth| share_below(&plane, depth, camera) <= MAX_BELOW_SHARE);
    let is_common = views.len() as f64 >= MIN_IMAGE_SHARE * depths.len() as f64;
    (is_lowest && is_common).then_some(FoundFloor { mount, images: views.len() })
}

/// Upward axis in the camera frame.
fn up_of(base_from_camera: &Pose3) -> Vector3 {
    base_from_camera.inverse().rotate(Vector3::z())
}

/// Share of the points of an image below a plane.
fn share_below(plane: &FloorView, depth: &DepthImage, camera: &PinholeCamera) -> f64 {
    let (mut below, mut all) = (0_usize, 0_usize);
    for point in camera.points(depth, SAMPLE_STEP_PX) {
        all += 1;
        below += usize::from(plane.up.dot(&point) + plane.height < -BELOW_FLOOR_M);
    }
    below as f64 / all.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    /// Depth of a floor under a camera, up to a wall 3 m ahead, with a table of `table` m height over a part of the view.
    fn scene(mount: &CameraMount, table: Option<f64>) -> DepthImage {
        let camera = PinholeCamera::kinect_v2();
        let base_from_camera = mount.base_from_camera();
        DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
            let direction = base_from_camera.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
            let wall = 3.0 / direction.x;
            let down = |height: f64| {
                if direction.z < 0.0 { (height - mount.z) / direction.z } else { f64::INFINITY }
            };
            let top = table
                .map(down)
                .filter(|at| (1.0..2.0).contains(&(at * direction.x)) && direction.y.abs() < 0.6);
            top.unwrap_or_else(|| down(0.0)).min(wall) as f32
        })
    }

    fn floor_near(depths: &[DepthImage], camera: &PinholeCamera, start: (f64, f64)) -> Option<FoundFloor> {
        FloorTry::near(depths, camera, start).found
    }

    /// Depth of a floor under a camera with a ramp of `slope` from 1 m ahead on, in millimetres as cameras give it.
    fn before_ramp(mount: &CameraMount, slope: f64) -> DepthImage {
        let camera = PinholeCamera::kinect_v2();
        let base_from_camera = mount.base_from_camera();
        DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
            let direction = base_from_camera.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
            let floor = if direction.z < 0.0 { -mount.z / direction.z } else { f64::INFINITY };
            let ramp = (mount.z + slope) / (slope * direction.x - direction.z);
            let depth = if floor * direction.x <= 1.0 { floor } else { ramp };
            if (0.0..4.5).contains(&depth) { ((1e3 * depth).round() / 1e3) as f32 } else { 0.0 }
        })
    }

    #[test]
    fn a_ramp_1_m_ahead_is_not_taken_for_the_floor_before_it() {
        let camera = PinholeCamera::kinect_v2();
        let truth = mount(0.45, 8.0, 0.0);
        for slope_deg in [3.0_f64, 4.8, 8.0, 12.0] {
            let depths = vec![before_ramp(&truth, slope_deg.to_radians().tan()); 3];
            let found = floor_near(&depths, &camera, (0.0, 0.0)).unwrap_or_else(|| panic!("{slope_deg}"));
            assert!((found.mount.z - truth.z).abs() < 5e-3, "{slope_deg}: {found:?}");
            assert!((found.mount.pitch_deg - truth.pitch_deg).abs() < 0.5, "{slope_deg}: {found:?}");
        }
        let down = vec![before_ramp(&truth, (-4.0_f64).to_radians().tan()); 3];
        assert_eq!(floor_near(&down, &camera, (0.0, 0.0)), None, "what is below may be the floor");
    }

    fn mount(z: f64, pitch_deg: f64, roll_deg: f64) -> CameraMount {
        CameraMount { x: 0.0, y: 0.0, z, yaw_deg: 0.0, pitch_deg, roll_deg }
    }

    #[test]
    fn height_tilt_and_roll_are_found_from_a_start_20_degrees_off() {
        let camera = PinholeCamera::kinect_v2();
        for (truth, tilt) in [(mount(0.45, 8.0, 0.0), 0.0), (mount(1.4, 35.0, 5.0), 30.0)] {
            let depths = vec![scene(&truth, None); 3];
            let found = floor_near(&depths, &camera, (tilt, 0.0)).unwrap();
            assert!((found.mount.z - truth.z).abs() < 2e-3, "{found:?}");
            assert!((found.mount.pitch_deg - truth.pitch_deg).abs() < 0.1, "{found:?}");
            assert!((found.mount.roll_deg - truth.roll_deg).abs() < 0.1, "{found:?}");
            assert_eq!(found.images, 3);
        }
    }

    #[test]
    fn a_wall_is_no_floor_and_neither_is_a_table_with_floor_below() {
        let camera = PinholeCamera::kinect_v2();
        for up_deg in [0.0, 9.0, 13.0, 20.0] {
            let looks_up = mount(2.5, -up_deg, 0.0).base_from_camera();
            let wall = DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
                let direction = looks_up.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
                (2.0 / direction.x) as f32
            });
            for tilt in START_TILTS_DEG {
                assert_eq!(
                    floor_near(std::slice::from_ref(&wall), &camera, (tilt, 0.0)),
                    None,
                    "{up_deg} {tilt}"
                );
            }
        }
        let above_table = scene(&mount(1.3, 30.0, 0.0), Some(0.7));
        if let Some(found) = floor_near(&[above_table], &camera, (30.0, 0.0)) {
            assert!((found.mount.z - 1.3).abs() < 0.01, "the table is not the floor: {found:?}");
        }
    }
}
