//! Image patch of a landmark from one viewpoint.

use crate::frame::aligned_feature::raw;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use nalgebra::{Matrix2, UnitQuaternion};
use trundle_core::{Pose3, Vector2, Vector3};
use trundle_vision::{ImagePatch, Template};

/// Smallest cosine of the angle between the patch's viewing direction and the present one: 0.8 (37 deg). At larger angles the surroundings
/// of a point are not a plane. Source: ours.
const MIN_DIRECTION_COSINE: f64 = 0.8;
/// Largest magnification of a patch, as root mean square of its sides: 1.8. Beyond it the patch is too coarse. Source: ours.
const MAX_MAGNIFICATION: f64 = 1.8;

/// Maximum number of reference patches of a landmark: 4, each from another direction or distance. Source: ours.
pub(crate) const MAX_REFERENCE_PATCHES: usize = 4;

/// The image around a landmark, on the plane measured by the depth camera.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReferencePatch {
    pub image: ImagePatch,
    /// Vectors of one px of the patch to the right and down, on that plane, visual frame, m.
    pub right: Vector3,
    pub down: Vector3,
    /// Direction from the landmark to the camera, unit length.
    pub toward_camera: Vector3,
}

impl ReferencePatch {
    /// The patch of the landmark at `position` (visual frame, m), seen as feature `i` of a frame at `visual_from_camera`. `None` if the
    /// frame has no image.
    pub fn of(
        frame: &Frame,
        i: usize,
        (visual_from_camera, position): (Pose3, Vector3),
        model: &ObservationModel,
    ) -> Option<Self> {
        let image = *frame.features.patches.get(i)?;
        let p_camera = visual_from_camera.inverse().transform(position);
        let plane = Plane {
            middle: raw(&frame.features.keypoints[i]),
            inverse: 1.0 / p_camera.z,
            slope: frame.slopes.get(i).copied().unwrap_or_default(),
        };
        let px = model.scale(frame.octave(i));
        let tangent = |step: Vector2| {
            let tangent = (plane.at(step, model)? - plane.at(-step, model)?) / 2.0;
            Some(visual_from_camera.rotate(tangent))
        };
        Some(Self {
            image,
            right: tangent(Vector2::new(px, 0.0))?,
            down: tangent(Vector2::new(0.0, px))?,
            toward_camera: (visual_from_camera.translation - position).try_normalize(1e-9)?,
        })
    }

    /// The patch warped to a camera on an octave, for the landmark at `position`; `None` if direction or distance differ too much.
    pub fn seen_from(
        &self,
        camera_from_visual: &Pose3,
        position: Vector3,
        octave: u8,
        model: &ObservationModel,
    ) -> Option<Template> {
        let ray = camera_from_visual.inverse().translation - position;
        if ray.dot(&self.toward_camera) < MIN_DIRECTION_COSINE * ray.norm() {
            return None;
        }
        let at = |point: Vector3| {
            let pixel = model.camera.project(camera_from_visual.transform(point))?;
            Some(model.camera.distort(pixel) / model.scale(octave))
        };
        let step = |tangent: Vector3| Some((at(position + tangent)? - at(position - tangent)?) / 2.0);
        let warp = Matrix2::from_columns(&[step(self.right)?, step(self.down)?]);
        let is_near = warp.norm_squared() <= 2.0 * MAX_MAGNIFICATION * MAX_MAGNIFICATION;
        Template::new(&self.image, is_near.then_some(warp)?.cast())
    }

    /// Rotates the patch with the map.
    pub fn turn(&mut self, rotation: UnitQuaternion<f64>) {
        for direction in [&mut self.right, &mut self.down, &mut self.toward_camera] {
            *direction = rotation * *direction;
        }
    }
}

/// Depth around a feature: on a plane, the inverse depth is affine in the pixel.
struct Plane {
    /// Raw px.
    middle: Vector2,
    /// 1/m.
    inverse: f64,
    /// 1/(m px).
    slope: Vector2,
}

impl Plane {
    /// Point of the plane `offset` px from the feature, camera frame, m; `None` behind the camera.
    fn at(&self, offset: Vector2, model: &ObservationModel) -> Option<Vector3> {
        let inverse = self.inverse + self.slope.dot(&offset);
        let pixel = model.camera.undistort(self.middle + offset);
        (inverse > 0.0).then(|| model.camera.unproject(pixel, 1.0 / inverse))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{model, painted_frame, painted_points};
    use nalgebra::Vector6;

    fn look_of_the_first() -> ReferencePatch {
        let points = painted_points();
        let frame = painted_frame(Pose3::identity(), &points, Vector2::zeros());
        ReferencePatch::of(&frame, 0, (Pose3::identity(), points[0]), &model()).unwrap()
    }

    /// Alignment error of the first point from this camera pose, px; `None` if the patch is not usable.
    fn off_from(look: &ReferencePatch, visual_from_camera: Pose3) -> Option<f32> {
        let point = painted_points()[0];
        let template = look.seen_from(&visual_from_camera.inverse(), point, 0, &model())?;
        let frame = painted_frame(visual_from_camera, &[point], Vector2::new(0.9, -0.7));
        let found = template.find(&frame.features.patches[0], nalgebra::Vector2::zeros()).unwrap();
        Some((found.offset - nalgebra::Vector2::new(-0.9, 0.7)).norm())
    }

    #[test]
    fn a_patch_is_found_from_nearer_and_from_the_side() {
        let look = look_of_the_first();
        for motion in [
            Vector6::zeros(),
            Vector6::new(0.0, 0.0, 0.5, 0.0, 0.0, 0.0),
            Vector6::new(0.5, 0.1, 0.2, 0.0, -0.3, 0.1),
            Vector6::new(-0.8, 0.0, -0.5, 0.1, 0.4, -0.2),
        ] {
            let off = off_from(&look, Pose3::exp(motion)).unwrap();
            assert!(off < 0.1, "{off} px off after {motion:?}");
        }
    }

    #[test]
    fn a_patch_is_not_used_from_far_aside_or_much_nearer() {
        let look = look_of_the_first();
        assert_eq!(off_from(&look, Pose3::exp(Vector6::new(0.0, 0.0, 1.2, 0.0, 0.0, 0.0))), None);
        let aside =
            Pose3::new(UnitQuaternion::from_euler_angles(0.0, -0.9, 0.0), Vector3::new(1.6, 0.0, 0.3));
        assert_eq!(off_from(&look, aside), None);
    }

    #[test]
    fn a_patch_turns_with_the_map() {
        let (mut look, point) = (look_of_the_first(), painted_points()[0]);
        let new_from_old = Pose3::exp(Vector6::new(1.0, 2.0, 3.0, 0.3, 2.0, -1.0));
        look.turn(new_from_old.rotation);
        let camera = new_from_old * Pose3::exp(Vector6::new(0.3, 0.0, 0.2, 0.0, -0.2, 0.0));
        let template = look.seen_from(&camera.inverse(), new_from_old.transform(point), 0, &model()).unwrap();
        let frame = painted_frame(new_from_old.inverse() * camera, &[point], Vector2::zeros());
        let found = template.find(&frame.features.patches[0], nalgebra::Vector2::zeros()).unwrap();
        assert!(found.offset.norm() < 0.1, "{found:?}");
    }
}
