use crate::codec::{EncodedEvent, EncodedRgbd};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};
use trundle_core::{GyroRate, Invalid, Pose2, Pose3, Stamp, Touch, WheelTicks};

/// A stamp as Foxglove writes it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Time {
    sec: i64,
    nsec: u32,
}

impl From<Stamp> for Time {
    fn from(stamp: Stamp) -> Self {
        let nsec = stamp.nanos.rem_euclid(1_000_000_000) as u32; // below 1e9 by rem_euclid
        Self { sec: stamp.nanos.div_euclid(1_000_000_000), nsec }
    }
}

impl TryFrom<Time> for Stamp {
    type Error = Invalid;

    fn try_from(time: Time) -> Result<Self, Invalid> {
        let nanos = time.sec.checked_mul(1_000_000_000).and_then(|n| n.checked_add(i64::from(time.nsec)));
        let nanos = nanos.filter(|_| time.nsec < 1_000_000_000);
        let invalid =
            || Invalid::new("time", format!("{} s + {} ns", time.sec, time.nsec), "", "nsec below 1e9");
        nanos.map(Self::from_nanos).ok_or_else(invalid)
    }
}

#[derive(Serialize, Deserialize)]
pub(super) struct WheelTicksMessage {
    stamp: Time,
    left: u16,
    right: u16,
}

#[derive(Serialize, Deserialize)]
pub(super) struct GyroRateMessage {
    stamp: Time,
    omega_rad_s: f64,
}

#[derive(Serialize, Deserialize)]
pub(super) struct TouchMessage {
    stamp: Time,
    pressed: bool,
}

/// `foxglove.CompressedImage`.
#[derive(Serialize, Deserialize)]
pub(super) struct CompressedImage {
    timestamp: Time,
    frame_id: String,
    data: String,
    format: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Xyz {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Xyzw {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct PoseMessage {
    position: Xyz,
    orientation: Xyzw,
}

impl From<Pose3> for PoseMessage {
    fn from(pose: Pose3) -> Self {
        let [x, y, z, i, j, k, w] = pose.into();
        Self { position: Xyz { x, y, z }, orientation: Xyzw { x: i, y: j, z: k, w } }
    }
}

/// A message of the schema `foxglove.PoseInFrame`, with the heading beside it where the pose is planar, because a
/// heading does not survive its quaternion to the last bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PoseInFrame {
    timestamp: Time,
    frame_id: String,
    pose: PoseMessage,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    theta: Option<f64>,
}

impl PoseInFrame {
    /// The name of its schema.
    pub const SCHEMA: &str = "foxglove.PoseInFrame";

    /// A pose in space: `frame_from_body`, m.
    pub fn new(stamp: Stamp, frame_id: &str, pose: Pose3) -> Self {
        Self { timestamp: stamp.into(), frame_id: frame_id.to_owned(), pose: pose.into(), theta: None }
    }

    /// A pose in the plane: `frame_from_body`, m and rad.
    pub fn planar(stamp: Stamp, frame_id: &str, pose: Pose2) -> Self {
        Self { theta: Some(pose.theta), ..Self::new(stamp, frame_id, Pose3::from_pose2(pose)) }
    }

    /// The planar pose again, exact; `None` when it was made of a pose in space.
    pub fn pose2(&self) -> Option<Pose2> {
        let Xyz { x, y, .. } = self.pose.position;
        self.theta.map(|theta| Pose2 { x, y, theta })
    }
}

/// A message of the schema `foxglove.PosesInFrame`: a path or trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PosesInFrame {
    timestamp: Time,
    frame_id: String,
    poses: Vec<PoseMessage>,
}

impl PosesInFrame {
    /// The name of its schema.
    pub const SCHEMA: &str = "foxglove.PosesInFrame";

    /// Poses in the plane: `frame_from_body` each.
    pub fn planar(stamp: Stamp, frame_id: &str, poses: impl IntoIterator<Item = Pose2>) -> Self {
        let poses = poses.into_iter().map(|pose| Pose3::from_pose2(pose).into()).collect();
        Self { timestamp: stamp.into(), frame_id: frame_id.to_owned(), poses }
    }
}

/// A sensor event as the messages that stand for it.
pub(super) enum EventMessages {
    Wheels(WheelTicksMessage),
    Gyro(GyroRateMessage),
    Touch(TouchMessage),
    Truth(PoseInFrame),
    Rgbd { color: CompressedImage, depth: CompressedImage },
}

impl From<&EncodedEvent> for EventMessages {
    fn from(event: &EncodedEvent) -> Self {
        let stamp = event.stamp().into();
        match event {
            EncodedEvent::Wheels(ticks) => {
                Self::Wheels(WheelTicksMessage { stamp, left: ticks.left, right: ticks.right })
            }
            EncodedEvent::Gyro(rate) => Self::Gyro(GyroRateMessage { stamp, omega_rad_s: rate.omega }),
            EncodedEvent::Touch(touch) => Self::Touch(TouchMessage { stamp, pressed: touch.pressed }),
            EncodedEvent::Truth { stamp, pose } => Self::Truth(PoseInFrame::planar(*stamp, "world", *pose)),
            EncodedEvent::Rgbd(image) => Self::Rgbd {
                color: CompressedImage::new(stamp, &image.color_jpeg),
                depth: CompressedImage::new(stamp, &image.depth_png),
            },
        }
    }
}

impl CompressedImage {
    fn new(timestamp: Time, bytes: &[u8]) -> Self {
        let format = if bytes.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
        Self {
            timestamp,
            frame_id: "camera".to_owned(),
            data: STANDARD.encode(bytes),
            format: format.to_owned(),
        }
    }

    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        STANDARD.decode(&self.data).map_err(|error| format!("data is no base64: {error}"))
    }

    pub fn stamp(&self) -> Result<Stamp, String> {
        self.timestamp.try_into().map_err(|invalid: Invalid| invalid.to_string())
    }
}

/// The image that a colour and a depth message make.
pub(super) fn rgbd(color: &CompressedImage, depth: &CompressedImage) -> Result<EncodedEvent, String> {
    let stamp = color.stamp()?;
    if depth.stamp()? != stamp {
        return Err(format!("the depth image of {} s follows the colour image of {stamp} s", depth.stamp()?));
    }
    Ok(EncodedEvent::Rgbd(EncodedRgbd { stamp, color_jpeg: color.bytes()?, depth_png: depth.bytes()? }))
}

impl TryFrom<WheelTicksMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: WheelTicksMessage) -> Result<Self, Invalid> {
        Ok(Self::Wheels(WheelTicks { stamp: m.stamp.try_into()?, left: m.left, right: m.right }))
    }
}

impl TryFrom<GyroRateMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: GyroRateMessage) -> Result<Self, Invalid> {
        Ok(Self::Gyro(GyroRate { stamp: m.stamp.try_into()?, omega: m.omega_rad_s }))
    }
}

impl TryFrom<TouchMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: TouchMessage) -> Result<Self, Invalid> {
        Ok(Self::Touch(Touch { stamp: m.stamp.try_into()?, pressed: m.pressed }))
    }
}

impl TryFrom<PoseInFrame> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: PoseInFrame) -> Result<Self, Invalid> {
        let pose = m.pose2().ok_or_else(|| Invalid::new("theta", "absent", "", "a number"))?;
        Ok(Self::Truth { stamp: m.timestamp.try_into()?, pose })
    }
}
