//! A Kinect V2 played back from a dump: depth, with the infrared image in place of colour.

use super::decoder::{DecoderConfig, DepthDecoder};
use super::dump::DumpReader;
use super::packets::PackedFrame;
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, PixelFormat, RawImage, StreamInfo};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::Duration;

/// Frames per second of the Kinect V2 \[Hz\]. Source: \[Sell14\].
const FRAME_RATE_HZ: f64 = 30.0;
/// Amplitude that is shown white \[1\]: 4096. Source: ours; a white wall at 0.9 m in the test's model.
const WHITE_AMPLITUDE: f32 = 4096.0;
/// Time from exposure to arrival \[s\]: 0, since a recording has no arrival. Source: ours.
const RECORDING_DELAY_S: f64 = 0.0;

/// A Kinect V2 played back from a dump. Its colour image is the infrared image, with the geometry of depth.
#[derive(Debug)]
pub struct DumpCamera {
    info: CameraInfo,
    place: String,
    reader: DumpReader<BufReader<File>>,
    decoder: DepthDecoder,
    has_ended: bool,
}

impl DumpCamera {
    /// Opens a dump.
    ///
    /// # Errors
    /// When the file cannot be read, or its header, its camera or a setting is not valid.
    pub fn open(path: &Path, config: DecoderConfig) -> Result<Self, CameraError> {
        let place = path.display().to_string();
        let failed = |source| CameraError::Io { place: place.clone(), source };
        let reader = DumpReader::new(BufReader::new(File::open(path).map_err(failed)?)).map_err(failed)?;
        let decoder = DepthDecoder::new(reader.calibration(), config).map_err(|problem| {
            CameraError::BadHeader { place: place.clone(), problem: problem.to_string() }
        })?;
        let camera = reader.calibration().camera;
        let stream = |format| StreamInfo { format, camera, rate_hz: FRAME_RATE_HZ };
        let info = CameraInfo {
            name: format!("Kinect V2 from {place}"),
            serial: String::new(),
            firmware: String::new(),
            usb: None,
            color: stream(PixelFormat::Gray8),
            depth: stream(PixelFormat::DepthF32),
            depth_unit_m: 1.0,
            color_from_depth: None,
            delay_s: RECORDING_DELAY_S,
            is_live: false,
        };
        Ok(Self { info, place, reader, decoder, has_ended: false })
    }

    /// Frames dropped since a packet was missing.
    pub fn dropped(&self) -> u64 {
        self.reader.dropped()
    }

    fn frame(&mut self, packed: &PackedFrame) -> Result<CameraFrame, CameraError> {
        let depth = self.decoder.decode(&packed.images)?;
        let size = (depth.width(), depth.height());
        let depth = depth.data().iter().flat_map(|depth| depth.to_le_bytes()).collect();
        let gray = |amplitude: &f32| (255.0 * (amplitude / WHITE_AMPLITUDE).sqrt()).min(255.0) as u8;
        let color = self.decoder.amplitude().data().iter().map(gray).collect();
        let image = |format, bytes| RawImage::packed(format, size, bytes, packed.stamp);
        Ok(CameraFrame {
            color: image(PixelFormat::Gray8, color),
            depth: image(PixelFormat::DepthF32, depth),
        })
    }
}

impl DepthCamera for DumpCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    /// The next frame of the dump, without waiting.
    fn next_frame(&mut self, _timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let failed = |source| CameraError::Io { place: self.place.clone(), source };
        match self.reader.next_frame().map_err(failed)? {
            Some(packed) => self.frame(&packed).map(Some),
            None => {
                self.has_ended = true;
                Ok(None)
            }
        }
    }

    fn has_ended(&self) -> bool {
        self.has_ended
    }
}
