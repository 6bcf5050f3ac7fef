//! A Kinect V2 at a USB port.

use super::calibration::{COLOR_SIZE, turned_back};
use super::color_packets::ColorPacket;
use super::device::{Identity, Kinect2Device};
use super::functions::UsbApi;
use super::ids::KINECT2_NAME;
use super::libusb::UsbSession;
use super::stream_thread::{StreamThread, Streamed};
use crate::camera::kinect2::packets::PackedFrame;
use crate::camera::kinect2::{DecoderConfig, DepthDecoder};
use crate::camera::native::image_pair::ImagePair;
use crate::camera::native::{DeviceEntry, Selection};
use crate::camera::pixels::color_from_raw;
use crate::camera::{
    CameraError, CameraFrame, CameraInfo, DepthCamera, PixelFormat, RawImage, StreamInfo, UsbSpeed,
};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{ColorImage, Invalid};

/// Frames per second of the Kinect V2 \[Hz\]. Source: \[Sell14\].
const RATE_HZ: f64 = 30.0;
/// Time from the middle of the exposure to the arrival of a frame \[s\]. Source: ours, assumed: one frame of readout, half an exposure, and
/// the decoding of depth. Measure the delay if it matters.
const DELAY_S: f64 = 0.06;

/// A Kinect V2 at a USB port: colour 1920 x 1080 and depth 512 x 424, not registered. This driver has never been tested with a device.
#[derive(Debug)]
pub struct Kinect2UsbCamera {
    info: CameraInfo,
    stream: StreamThread,
    decoder: DepthDecoder,
    pair: ImagePair,
}

impl Kinect2UsbCamera {
    /// Opens a Kinect V2 and starts its streams.
    ///
    /// # Errors
    /// When the camera is missing, forbidden, in use, connected by USB 2, or does not follow the protocol.
    pub fn open(api: &Arc<UsbApi>, selection: &Selection) -> Result<Self, CameraError> {
        if let Selection::File(file) = selection {
            return Err(CameraError::StreamsUnavailable {
                device: KINECT2_NAME.into(),
                wanted: format!("the recording {}", file.display()),
                remedy: "name packets in a file as kinect2-dump:FILE".into(),
            });
        }
        let device = Kinect2Device::open(&UsbSession::new(api)?, selection)?;
        tracing::warn!("{}", super::KINECT2_USB_STATE);
        let speed = device.speed();
        let (identity, stream) = StreamThread::start(device)?;
        let unusable = |problem| CameraError::IntrinsicsUnusable { stream: "depth", problem };
        let decoder = DepthDecoder::new(&identity.calibration, DecoderConfig::default()).map_err(unusable)?;
        let info = info(identity, speed).map_err(unusable)?;
        Ok(Self { info, stream, decoder, pair: ImagePair::new(RATE_HZ) })
    }

    fn depth(&mut self, packed: &PackedFrame) -> Result<RawImage, Invalid> {
        let depth = self.decoder.decode(&packed.images)?;
        let size = (depth.width(), depth.height());
        let rows = depth.data().chunks_exact(size.0);
        let bytes = rows.flat_map(|row| row.iter().rev()).flat_map(|depth| depth.to_le_bytes()).collect();
        Ok(RawImage::packed(PixelFormat::DepthF32, size, bytes, packed.stamp))
    }
}

/// The connected Kinects V2.
///
/// # Errors
/// When the library refuses, or a camera cannot be opened.
pub fn list_devices(api: &Arc<UsbApi>) -> Result<Vec<DeviceEntry>, CameraError> {
    let entry = |found: super::libusb::Found| {
        let (serial, usb) = (found.serial(), found.speed);
        found.opened?;
        Ok(DeviceEntry { name: KINECT2_NAME.into(), serial, firmware: String::new(), usb })
    };
    UsbSession::new(api)?.kinects()?.into_iter().map(entry).collect()
}

impl DepthCamera for Kinect2UsbCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let start = Instant::now();
        loop {
            match self.stream.next(timeout.saturating_sub(start.elapsed()))? {
                None => return Ok(None),
                Some(Streamed::Color(packet)) => self.pair.add_color(jpeg(packet)),
                Some(Streamed::Depth(packed)) => {
                    let depth = self.depth(&packed)?;
                    self.pair.add_depth(depth);
                }
            }
            if let Some(CameraFrame { color, depth }) = self.pair.take() {
                return Ok(Some(CameraFrame { color: turned_back_color(&color)?, depth }));
            }
        }
    }
}

fn jpeg(packet: ColorPacket) -> RawImage {
    RawImage::packed(PixelFormat::Mjpg, COLOR_SIZE, packet.jpeg, packet.stamp)
}

/// The pixels of a JPEG file, turned back left to right.
fn turned_back_color(jpeg: &RawImage) -> Result<RawImage, Invalid> {
    let mut image = ColorImage::default();
    color_from_raw(jpeg, &mut image)?;
    let rows = image.data().chunks_exact(image.width());
    let bytes = rows.flat_map(|row| row.iter().rev()).flatten().copied().collect();
    Ok(RawImage::packed(PixelFormat::Rgb8, COLOR_SIZE, bytes, jpeg.device_stamp))
}

fn info(identity: Identity, usb: Option<UsbSpeed>) -> Result<CameraInfo, Invalid> {
    let stream = |format, camera| StreamInfo { format, camera, rate_hz: RATE_HZ };
    Ok(CameraInfo {
        name: KINECT2_NAME.into(),
        serial: identity.serial,
        firmware: identity.firmware,
        usb,
        color: stream(PixelFormat::Rgb8, identity.color),
        depth: stream(PixelFormat::DepthF32, turned_back(&identity.calibration.camera)?),
        depth_unit_m: 1.0,
        color_from_depth: Some(identity.color_from_depth),
        delay_s: DELAY_S,
        is_live: true,
    })
}
