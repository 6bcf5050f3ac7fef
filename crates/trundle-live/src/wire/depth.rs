//! A depth image as bytes.
//!
//! | bytes | content |
//! |---|---|
//! | 1 | kind |
//! | 1 | bit 0: the camera and its pose are known |
//! | 2 | width \[px\] |
//! | 4 | number of maps that an operator has replaced: if it changes, the page drops the points of earlier depth images |
//! | 4, 4, 4, 4 | camera of this picture: focal lengths x, y, principal point x, y \[px\] |
//! | 4 each | its lens distortion: k1, k2, p1, p2, k3 |
//! | 4 each | `map_from_camera` at the time of the image: three rows of the rotation, each with its part of the translation \[m\] |
//! | 1 each | depth of a pixel, row by row; 0: not measured; n: (n - 1) to n times 4 cm; 255: 10.16 m or more |
//!
//! Numbers of 4 bytes are of kind f32, except for the number of maps. Without a known pose those of camera and pose are 0.

use super::Kind;
use trundle_app::operator::{DepthPicture, DepthViewpoint};
use trundle_core::{Distortion, PinholeCamera, Pose3};

/// Bit of a known camera with a known pose.
const POSE_BIT: u8 = 1;
/// Bytes of the numbers of camera, lens and pose.
const VIEWPOINT_BYTES: usize = 84;

/// The message of a depth image that was taken from `viewpoint`, with the number of replaced maps.
pub fn depth_message(depth: &DepthPicture, viewpoint: Option<DepthViewpoint>, map_number: u64) -> Vec<u8> {
    let known = viewpoint.and_then(|known| Some((depth.camera(&known.camera)?, known.map_from_camera?)));
    let numbers = known.map(|(camera, pose)| viewpoint_bytes(&camera, &pose));
    let mut bytes = vec![Kind::Depth as u8, if known.is_some() { POSE_BIT } else { 0 }];
    bytes.extend((depth.width as u16).to_le_bytes());
    bytes.extend((map_number as u32).to_le_bytes());
    bytes.extend(numbers.unwrap_or_else(|| vec![0; VIEWPOINT_BYTES]));
    bytes.extend(&depth.pixels);
    bytes
}

fn viewpoint_bytes(camera: &PinholeCamera, map_from_camera: &Pose3) -> Vec<u8> {
    let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
    let lens = [camera.fx(), camera.fy(), camera.cx(), camera.cy(), k1, k2, p1, p2, k3];
    let (turn, at) = (map_from_camera.rotation_matrix(), map_from_camera.translation);
    let rows = [0, 1, 2].map(|row| [turn[(row, 0)], turn[(row, 1)], turn[(row, 2)], at[row]]);
    lens.iter().chain(rows.as_flattened()).flat_map(|number| (*number as f32).to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DepthImage, Pose2, Vector3};
    use trundle_runtime::CameraMount;

    /// Bytes before the pixels.
    const HEADER_BYTES: usize = 8 + VIEWPOINT_BYTES;

    fn number(bytes: &[u8], i: usize) -> f64 {
        let at = 8 + 4 * i;
        f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()).into()
    }

    /// The point of a pixel, map frame, as the page computes it for a lens without distortion.
    fn point(bytes: &[u8], x: usize, y: usize) -> Vector3 {
        let width = usize::from(u16::from_le_bytes([bytes[2], bytes[3]]));
        let depth = (f64::from(bytes[HEADER_BYTES + y * width + x]) - 0.5) * DepthPicture::UNIT_M;
        let [fx, fy, cx, cy] = [0, 1, 2, 3].map(|i| number(bytes, i));
        let ray = [(x as f64 - cx) / fx * depth, (y as f64 - cy) / fy * depth, depth, 1.0];
        let along = |row: usize| (0..4).map(|i| number(bytes, 9 + 4 * row + i) * ray[i]).sum::<f64>();
        Vector3::new(along(0), along(1), along(2))
    }

    fn viewpoint(map_from_camera: Option<Pose3>) -> Option<DepthViewpoint> {
        Some(DepthViewpoint { camera: PinholeCamera::kinect_v2(), map_from_camera })
    }

    #[test]
    fn width_map_and_pixels_are_sent() {
        let depth = DepthPicture { width: 2, stride: 1, pixels: vec![0, 50, 255, 1] };
        let bytes = depth_message(&depth, None, 7);
        assert_eq!(bytes[..8], [8, 0, 2, 0, 7, 0, 0, 0]);
        assert!(bytes[8..HEADER_BYTES].iter().all(|byte| *byte == 0));
        assert_eq!(bytes[HEADER_BYTES..], [0, 50, 255, 1]);
    }

    #[test]
    fn without_a_pose_or_with_another_camera_the_pose_is_unknown() {
        let here = Some(Pose3::identity());
        let [whole, other] = [(512, 424), (320, 240)].map(|(w, h)| DepthImage::filled(w, h, 2.0));
        for (image, pose, flags) in [(&whole, here, 1), (&whole, None, 0), (&other, here, 0)] {
            assert_eq!(depth_message(&DepthPicture::of(image), viewpoint(pose), 0)[1], flags, "{pose:?}");
        }
    }

    #[test]
    fn a_known_point_comes_back_to_its_place_within_the_step_of_its_depth() {
        let camera = PinholeCamera::kinect_v2();
        let mount = CameraMount { yaw_deg: 20.0, ..CameraMount::default() };
        let pose = Pose3::from_pose2(Pose2::new(3.0, -2.0, 2.1)) * mount.base_from_camera();
        for (x, y, depth) in [(0, 0, 0.81), (100, 60, 2.345), (127, 105, 9.99)] {
            let mut image = DepthImage::filled(512, 424, 0.0);
            image[(4 * x, 4 * y)] = depth;
            let (x_px, y_px) = (4.0 * x as f64, 4.0 * y as f64);
            let ray = camera.unproject(trundle_core::Vector2::new(x_px, y_px), 1.0);
            let truth = pose.transform(ray * f64::from(depth));
            let bytes = depth_message(&DepthPicture::of(&image), viewpoint(Some(pose)), 0);
            let error = (point(&bytes, x, y) - truth).norm();
            let limit = 0.5 * DepthPicture::UNIT_M * ray.norm() + 1e-5;
            assert!(error <= limit, "({x}, {y}): {error} m, at most {limit} m");
        }
    }
}
