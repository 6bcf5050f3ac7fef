//! `/camera`: the newest colour image.

use super::{CAMERA_FRAME, timestamp};
use foxglove::messages::CompressedImage;
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// The image of a view.
pub fn message(view: &RunView) -> Option<(Stamp, CompressedImage)> {
    let image = view.perception.image.as_ref()?;
    let message = CompressedImage {
        timestamp: Some(timestamp(image.stamp)),
        frame_id: CAMERA_FRAME.to_owned(),
        data: image.jpeg.clone().into(),
        format: "jpeg".to_owned(),
    };
    Some((image.stamp, message))
}
