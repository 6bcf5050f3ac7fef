//! `sensor_msgs/CameraInfo`.

use super::stamp;
use crate::generated::sensor_msgs::CameraInfoMessage;
use trundle_core::{Distortion, Invalid, PinholeCamera, Stamp};

/// Distortion of OpenCV's five parameters \[REP 104\].
const PLUMB_BOB: &str = "plumb_bob";
/// Distortion of OpenCV's eight parameters, the last three of which are 0 in a lens that five describe.
const RATIONAL: &str = "rational_polynomial";

/// Whether images are rectified: then the projection matrix `p` counts, else `k` and the distortion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rectification {
    /// Image with lens distortion.
    Raw,
    /// Image without lens distortion.
    Rectified,
}

impl Rectification {
    /// The kind by the name of an image's topic, as in `image_pipeline`: `image_rect`, `image_rect_color`, `depth/image_rect_raw`.
    #[must_use]
    pub fn of_topic(topic: &str) -> Self {
        if topic.contains("rect") { Self::Rectified } else { Self::Raw }
    }
}

/// The camera of the images that come with `info`.
///
/// # Errors
/// When the matrix was never set, a number is not finite, or the lens is of another model.
pub fn from_ros(info: &CameraInfoMessage, rectification: Rectification) -> Result<PinholeCamera, Invalid> {
    let size = (info.width as usize, info.height as usize);
    let CameraInfoMessage { k, p, .. } = info;
    let (fx, fy, cx, cy) = match rectification {
        Rectification::Raw => (k[0], k[4], k[2], k[5]),
        Rectification::Rectified => (p[0], p[5], p[2], p[6]),
    };
    if fx == 0.0 {
        let name = if rectification == Rectification::Raw { "k" } else { "p" };
        return Err(Invalid::new(name, "0", "", "the focal lengths of the camera: calibrate it"));
    }
    let distortion = match rectification {
        Rectification::Raw => distortion(info)?,
        Rectification::Rectified => Distortion::default(),
    };
    PinholeCamera::new(size, (fx, fy), (cx, cy), distortion)
}

fn distortion(info: &CameraInfoMessage) -> Result<Distortion, Invalid> {
    let is_known = [PLUMB_BOB, RATIONAL].contains(&info.distortion_model.as_str());
    let is_flat = info.d.iter().all(|value| *value == 0.0);
    if !is_known && !is_flat {
        let value = format!("'{}'", info.distortion_model);
        return Err(Invalid::new(
            "distortion_model",
            value,
            "",
            "plumb_bob: use rectified images (image_rect)",
        ));
    }
    if info.d.iter().skip(5).any(|value| *value != 0.0) {
        let expected = "0 from the sixth on: use rectified images (image_rect)";
        return Err(Invalid::new("d", format!("{:?}", info.d), "", expected));
    }
    let d = |i: usize| info.d.get(i).copied().unwrap_or_default();
    Ok(Distortion { k1: d(0), k2: d(1), p1: d(2), p2: d(3), k3: d(4) })
}

/// The camera as a message.
#[must_use]
pub fn to_ros(camera: &PinholeCamera, at: Stamp, frame: &str) -> CameraInfoMessage {
    let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
    let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
    CameraInfoMessage {
        header: stamp::header(at, frame),
        height: camera.height() as u32,
        width: camera.width() as u32,
        distortion_model: PLUMB_BOB.to_owned(),
        d: vec![k1, k2, p1, p2, k3],
        k: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        ..CameraInfoMessage::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_go_there_and_back() {
        let own = PinholeCamera::kinect_v1();
        let message = to_ros(&own, Stamp::default(), "camera");
        assert_eq!(from_ros(&message, Rectification::Raw).unwrap(), own);
        assert_eq!(from_ros(&message, Rectification::of_topic("/camera/image_rect")).unwrap(), own);
    }

    #[test]
    fn cameras_that_were_never_calibrated_and_fish_eyes_are_refused() {
        let refused = |info: &CameraInfoMessage| from_ros(info, Rectification::Raw).unwrap_err().to_string();
        assert!(
            refused(&CameraInfoMessage { width: 640, height: 480, ..CameraInfoMessage::default() })
                .starts_with("k is 0")
        );
        let mut message = to_ros(&PinholeCamera::kinect_v1(), Stamp::default(), "camera");
        message.d[0] = 0.1;
        message.distortion_model = "equidistant".to_owned();
        assert!(refused(&message).starts_with("distortion_model is 'equidistant'"));
        message.distortion_model = RATIONAL.to_owned();
        message.d = vec![0.1; 8];
        assert!(refused(&message).starts_with("d is ["));
        message.k[0] = f64::NAN;
        message.d.clear();
        assert!(refused(&message).contains("NaN"));
    }
}
