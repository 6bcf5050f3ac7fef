//! Sensor events with compressed images, in the form in which they are sent and recorded.

use super::{CodecError, JPEG_QUALITY, decode_color, decode_depth, encode_color, encode_depth_rvl};
use trundle_core::{
    BodyEvent, Cliff, GyroRate, Odometry, Pose2, RgbdImage, Scan, SensorEvent, Stamp, Touch, WheelTicks,
};

/// An RGB-D image as sent and recorded: colour as JPEG, depth in millimetres as RVL.
#[derive(Debug, Clone, PartialEq)]
pub struct EncodedRgbd {
    /// Stamp of the image.
    pub stamp: Stamp,
    /// The bytes of a JPEG.
    pub color_jpeg: Vec<u8>,
    /// Width, height and stream of RVL; of earlier recordings the bytes of a 16-bit PNG.
    pub depth: Vec<u8>,
}

impl EncodedRgbd {
    /// Encodes an image at [`JPEG_QUALITY`]; depth is rounded to millimetres.
    ///
    /// # Errors
    /// When a side is 0 or above 65,535 px.
    pub fn encode(image: &RgbdImage) -> Result<Self, CodecError> {
        Ok(Self {
            stamp: image.stamp(),
            color_jpeg: encode_color(image.color(), JPEG_QUALITY)?,
            depth: encode_depth_rvl(image.depth())?,
        })
    }

    /// Encodes an image with the JPEG from which its colour was decoded.
    ///
    /// # Errors
    /// When a side is 0 or above 65,535 px.
    pub fn with_jpeg(color_jpeg: Vec<u8>, image: &RgbdImage) -> Result<Self, CodecError> {
        Ok(Self { stamp: image.stamp(), color_jpeg, depth: encode_depth_rvl(image.depth())? })
    }

    /// The decoded image: the robot and a replay receive this one.
    ///
    /// # Errors
    /// When the bytes are not images or the image sizes differ.
    pub fn decode(&self) -> Result<RgbdImage, CodecError> {
        let (color, depth) = (decode_color(&self.color_jpeg)?, decode_depth(&self.depth)?);
        Ok(RgbdImage::new(self.stamp, color, depth)?)
    }
}

/// A [`SensorEvent`] in its recorded form. Give the robot the result of `encode` and then `decode`, and a replay of
/// the recording feeds it the very same.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum EncodedEvent {
    /// Wheel encoders.
    Wheels(WheelTicks),
    /// Gyro.
    Gyro(GyroRate),
    /// Camera.
    Rgbd(EncodedRgbd),
    /// Bumper.
    Touch(Touch),
    /// Cliff sensors.
    Cliff(Cliff),
    /// A 2-D laser's sweep.
    Scan(Scan),
    /// Odometry that the body computes itself.
    Odometry(Odometry),
    /// Power, wheel drop, buttons, links, silence.
    Body(BodyEvent),
    /// Ground truth, `world_from_base`, for evaluation only.
    Truth {
        /// Time of the pose.
        stamp: Stamp,
        /// `world_from_base`.
        pose: Pose2,
    },
}

impl EncodedEvent {
    /// Encodes an event; only images change.
    ///
    /// # Errors
    /// As [`EncodedRgbd::encode`].
    pub fn encode(event: &SensorEvent) -> Result<Self, CodecError> {
        Ok(match event {
            SensorEvent::Wheels(ticks) => Self::Wheels(*ticks),
            SensorEvent::Gyro(rate) => Self::Gyro(*rate),
            SensorEvent::Rgbd(image) => Self::Rgbd(EncodedRgbd::encode(image)?),
            SensorEvent::Touch(touch) => Self::Touch(*touch),
            SensorEvent::Cliff(cliff) => Self::Cliff(*cliff),
            SensorEvent::Scan(scan) => Self::Scan(scan.clone()),
            SensorEvent::Odometry(odometry) => Self::Odometry(*odometry),
            SensorEvent::Body(event) => Self::Body(*event),
            SensorEvent::Truth { stamp, pose } => Self::Truth { stamp: *stamp, pose: *pose },
            other => return Err(CodecError::UnknownEvent { stamp: other.stamp() }),
        })
    }

    /// The event again.
    ///
    /// # Errors
    /// As [`EncodedRgbd::decode`].
    pub fn decode(&self) -> Result<SensorEvent, CodecError> {
        Ok(match self {
            Self::Wheels(ticks) => SensorEvent::Wheels(*ticks),
            Self::Gyro(rate) => SensorEvent::Gyro(*rate),
            Self::Rgbd(encoded) => SensorEvent::Rgbd(encoded.decode()?),
            Self::Touch(touch) => SensorEvent::Touch(*touch),
            Self::Cliff(cliff) => SensorEvent::Cliff(*cliff),
            Self::Scan(scan) => SensorEvent::Scan(scan.clone()),
            Self::Odometry(odometry) => SensorEvent::Odometry(*odometry),
            Self::Body(event) => SensorEvent::Body(*event),
            Self::Truth { stamp, pose } => SensorEvent::Truth { stamp: *stamp, pose: *pose },
        })
    }

    /// Stamp of the event.
    pub fn stamp(&self) -> Stamp {
        match self {
            Self::Wheels(ticks) => ticks.stamp,
            Self::Gyro(rate) => rate.stamp,
            Self::Rgbd(image) => image.stamp,
            Self::Touch(touch) => touch.stamp,
            Self::Cliff(cliff) => cliff.stamp,
            Self::Scan(scan) => scan.stamp(),
            Self::Odometry(odometry) => odometry.stamp,
            Self::Body(event) => event.stamp,
            Self::Truth { stamp, .. } => *stamp,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::DepthImage;

    #[test]
    fn the_wire_is_exact_from_the_second_pass_on_in_depth_and_stamp() {
        let color = crate::codec::tests::test_image(64, 48);
        let depth = DepthImage::from_fn(64, 48, |x, y| 0.5 + (x * y) as f32 * 0.00137);
        let image = RgbdImage::new(Stamp::from_nanos(5), color, depth).unwrap();
        let encoded = EncodedRgbd::encode(&image).unwrap();
        let seen = encoded.decode().unwrap();
        assert_eq!(seen, encoded.decode().unwrap());
        assert_eq!(encoded.depth, EncodedRgbd::encode(&seen).unwrap().depth);
        assert_eq!(EncodedEvent::encode(&SensorEvent::Rgbd(image)).unwrap().stamp(), seen.stamp());
    }

    #[test]
    fn images_of_different_sizes_are_refused() {
        let encoded = EncodedRgbd {
            stamp: Stamp::default(),
            color_jpeg: encode_color(&crate::codec::tests::test_image(64, 48), 90).unwrap(),
            depth: crate::encode_depth(&DepthImage::filled(32, 24, 1.0)).unwrap(),
        };
        let error = encoded.decode().unwrap_err().to_string();
        assert_eq!(error, "depth image size is 32 x 24 px, expected 64 x 48 as the colour image");
    }
}
