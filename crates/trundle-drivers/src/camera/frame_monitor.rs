//! Faults that show in the frames themselves: stuck, without depth, of another size, or with wrong intrinsics.

use super::{CameraFrame, CameraInfo, RawImage, StreamInfo, UsbSpeed};
use trundle_core::{DepthImage, Invalid, PinholeCamera, Stamp, require_in};

/// Ratio of focal length to image width \[1\]: 0.3 to 3, a field of view of 118 to 19 degrees. Outside this range, the intrinsics belong to
/// another camera or another image size. Source: ours; the depth cameras on sale have 50 to 110 degrees.
const FOCAL_PER_WIDTH_RANGE: (f64, f64) = (0.3, 3.0);
/// Place of the principal point as a share of the image's side \[1\]. Source: ours; within 0.07 of the middle for calibrated cameras.
const PRINCIPAL_POINT_RANGE: (f64, f64) = (0.25, 0.75);
/// Number of consecutive frames with equal times at which a camera counts as stuck: 5. Source: ours; 0.17 s at 30 Hz.
const MAX_SAME_STAMPS: usize = 5;
/// Number of consecutive frames with equal bytes at which a camera counts as stuck: 30. Source: ours; noise of the sensor changes bytes in
/// every frame.
const MAX_SAME_BYTES: usize = 30;
/// Number of consecutive frames without any depth at which a fault is reported: 30. Source: ours; 1 s at 30 Hz.
const MAX_EMPTY_DEPTHS: usize = 30;
/// Bytes between two bytes that enter the signature of an image. Source: ours; 64 keeps the cost below 0.1 ms for a colour image.
const SIGNATURE_STEP_BYTES: usize = 64;

/// A fault of a camera detected in its frames.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraFault {
    /// The same frame repeatedly. The camera must be reopened.
    #[error("the camera delivered the same frame {frames} times: open it anew")]
    Stuck {
        /// Identical frames in a row.
        frames: usize,
    },
    /// Frames without any depth.
    #[error(
        "the last {frames} depth images hold no depth: look for something right in front of the lens, for strong sun, or for a projector that is off"
    )]
    NoDepth {
        /// Number of such consecutive frames.
        frames: usize,
    },
    /// The size of an image differs from the declared one. The camera must be reopened.
    #[error("the {stream} image is {width} x {height} px, expected {} x {}: open the camera anew", expected.0, expected.1)]
    SizeChanged {
        /// Colour or depth.
        stream: &'static str,
        /// Columns \[px\].
        width: usize,
        /// Rows \[px\].
        height: usize,
        /// Promised columns and rows \[px\].
        expected: (usize, usize),
    },
    /// Intrinsics that no camera has.
    #[error(
        "the intrinsics of the {stream} camera are not plausible: {problem}: calibrate it, or give the intrinsics of this image size"
    )]
    Intrinsics {
        /// Colour or depth.
        stream: &'static str,
        /// The number.
        problem: Invalid,
    },
    /// The connection is slower than USB 3.
    #[error(
        "the camera is connected by {speed}, expected USB 3: frames will be missing; use a blue USB port and a USB 3 cable"
    )]
    UsbTooSlow {
        /// Speed of the connection.
        speed: UsbSpeed,
    },
}

impl CameraFault {
    /// Whether the camera must be reopened.
    pub fn needs_reopening(&self) -> bool {
        matches!(self, Self::Stuck { .. } | Self::SizeChanged { .. })
    }
}

/// Faults detected before the first frame.
pub fn faults_of_info(info: &CameraInfo) -> Vec<CameraFault> {
    let slow = info.usb.filter(|speed| *speed < UsbSpeed::Super);
    let slow = slow.map(|speed| CameraFault::UsbTooSlow { speed });
    let streams = [("colour", &info.color), ("depth", &info.depth)];
    let intrinsics = streams.into_iter().filter_map(|(stream, of)| {
        let problem = check_intrinsics(&of.camera).err()?;
        Some(CameraFault::Intrinsics { stream, problem })
    });
    slow.into_iter().chain(intrinsics).collect()
}

/// Refuses intrinsics that no camera has.
///
/// # Errors
/// When a focal length or the principal point is implausible.
pub fn check_intrinsics(camera: &PinholeCamera) -> Result<(), Invalid> {
    let (width, height) = (camera.width() as f64, camera.height() as f64);
    let (low, high) = FOCAL_PER_WIDTH_RANGE;
    require_in("fx", camera.fx(), "px", low * width, high * width)?;
    require_in("fy", camera.fy(), "px", low * width, high * width)?;
    let (low, high) = PRINCIPAL_POINT_RANGE;
    require_in("cx", camera.cx(), "px", low * width, high * width)?;
    require_in("cy", camera.cy(), "px", low * height, high * height)?;
    Ok(())
}

/// Watches the frames of one camera.
#[derive(Debug, Clone)]
pub struct FrameMonitor {
    color: StreamInfo,
    depth: StreamInfo,
    expects_noise: bool,
    last_stamps: Option<(Stamp, Stamp)>,
    same_stamps: usize,
    last_signature: Option<u64>,
    same_bytes: usize,
    empty_depths: usize,
}

impl FrameMonitor {
    /// A monitor for the frames of a camera. `expects_noise` is `false` for rendered images, which are equal if no object moves.
    pub fn new(info: &CameraInfo, expects_noise: bool) -> Self {
        Self {
            color: info.color,
            depth: info.depth,
            expects_noise,
            last_stamps: None,
            same_stamps: 0,
            last_signature: None,
            same_bytes: 0,
            empty_depths: 0,
        }
    }

    /// This monitor after another opening of the camera whose last frame had these stamps: it may begin with that frame again.
    #[must_use]
    pub fn following(self, last_stamps: Option<(Stamp, Stamp)>) -> Self {
        Self { last_stamps, ..self }
    }

    /// Stamps of the newest frame.
    pub fn last_stamps(&self) -> Option<(Stamp, Stamp)> {
        self.last_stamps
    }

    /// Whether the newest frame has the stamps of the previous one.
    pub fn is_repeated(&self) -> bool {
        self.same_stamps > 0
    }

    /// Checks a frame; returns a new fault. A lasting fault is reported once per limit's number of frames.
    pub fn on_frame(&mut self, frame: &CameraFrame) -> Option<CameraFault> {
        let size = size_fault("colour", &frame.color, &self.color);
        let size = size.or_else(|| size_fault("depth", &frame.depth, &self.depth));
        let stamps = Some((frame.color.device_stamp, frame.depth.device_stamp));
        let signature =
            self.expects_noise.then(|| signature(&frame.color) ^ signature(&frame.depth).rotate_left(32));
        let by_stamp = repeats(self.last_stamps == stamps, &mut self.same_stamps, MAX_SAME_STAMPS);
        let is_same = signature.is_some() && self.last_signature == signature;
        let by_bytes = repeats(is_same, &mut self.same_bytes, MAX_SAME_BYTES);
        (self.last_stamps, self.last_signature) = (stamps, signature);
        size.or(by_stamp.or(by_bytes).map(|frames| CameraFault::Stuck { frames }))
    }

    /// Checks the converted depth image of a frame; returns a fault after many images without depth.
    pub fn on_depth(&mut self, depth: &DepthImage) -> Option<CameraFault> {
        let is_empty = !depth.data().iter().any(|depth| *depth > 0.0);
        self.empty_depths = if is_empty { self.empty_depths + 1 } else { 0 };
        let frames = self.empty_depths;
        (is_empty && frames.is_multiple_of(MAX_EMPTY_DEPTHS)).then_some(CameraFault::NoDepth { frames })
    }
}

/// Counts frames equal to the previous one; returns their number each time `limit` is reached.
fn repeats(is_same: bool, count: &mut usize, limit: usize) -> Option<usize> {
    *count = if is_same { *count + 1 } else { 0 };
    let frames = *count + 1;
    (is_same && frames.is_multiple_of(limit)).then_some(frames)
}

fn size_fault(stream: &'static str, image: &RawImage, info: &StreamInfo) -> Option<CameraFault> {
    let expected = (info.camera.width(), info.camera.height());
    let (width, height) = (image.width, image.height);
    ((width, height) != expected).then_some(CameraFault::SizeChanged { stream, width, height, expected })
}

/// A number that differs between images of different bytes: FNV-1a over every 64th byte and its successor.
fn signature(image: &RawImage) -> u64 {
    let mix = |hash: u64, byte: &u8| (hash ^ *byte as u64).wrapping_mul(0x0000_0100_0000_01b3);
    let samples = image.bytes.chunks(SIGNATURE_STEP_BYTES).flat_map(|chunk| chunk.iter().take(2));
    samples.fold(0xcbf2_9ce4_8422_2325, mix)
}
