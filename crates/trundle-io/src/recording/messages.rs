//! The JSON messages of a recording for the events of a body.

use super::images::ImageBytes;
use super::poses::PoseInFrame;
use super::time::Time;
use crate::codec::{EncodedEvent, EncodedRgbd};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use trundle_core::{
    Beam, BeamTimes, BodyEvent, BodyEventKind, Cliff, GyroRate, Invalid, Odometry, Pose2, Scan, Stamp, Touch,
    Twist2, Vector2, WheelTicks,
};

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

#[derive(Serialize, Deserialize)]
pub(super) struct CliffMessage {
    stamp: Time,
    over_edge: bool,
}

/// Odometry that the body computes itself.
#[derive(Serialize, Deserialize)]
pub(super) struct OdometryMessage {
    stamp: Time,
    x_m: f64,
    y_m: f64,
    theta_rad: f64,
    v_m_s: f64,
    omega_rad_s: f64,
    /// Row by row: x, y, theta.
    covariance: [[f64; 3]; 3],
}

/// An event of a body other than motion and images.
#[derive(Serialize, Deserialize)]
pub(super) struct BodyEventMessage {
    stamp: Time,
    event: BodyEventKind,
}

/// A 2-D laser's sweep: beam i points along `angle_min_rad + i * angle_increment_rad` from `origin_m`, base frame.
#[derive(Serialize, Deserialize)]
pub(super) struct ScanMessage {
    stamp: Time,
    origin_m: [f64; 2],
    angle_min_rad: f64,
    angle_increment_rad: f64,
    /// `null` if unknown.
    ranges_m: Vec<Option<f64>>,
    /// Whether an obstacle is at the range; otherwise the beam is free up to the range.
    hits: Vec<bool>,
    /// When the first beam was measured, after the stamp, and the time between beams; none if all were measured at the stamp.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    beam_times_s: Option<[f64; 2]>,
}

/// The place of an image among the events.
#[derive(Serialize, Deserialize)]
pub(super) struct ImageMessage {
    stamp: Time,
}

impl ImageMessage {
    pub fn stamp(&self) -> Result<Stamp, Invalid> {
        self.stamp.try_into()
    }
}

/// `foxglove.CompressedImage` in JSON, as recordings of version 0.1.0 hold images.
#[derive(Deserialize)]
pub(super) struct JsonImage {
    timestamp: Time,
    data: String,
}

/// The messages of a sensor event.
pub(super) enum EventMessages {
    Wheels(WheelTicksMessage),
    Gyro(GyroRateMessage),
    Touch(TouchMessage),
    Cliff(CliffMessage),
    Scan(ScanMessage),
    Odometry(OdometryMessage),
    Body(BodyEventMessage),
    Truth(PoseInFrame),
    Image(ImageMessage),
}

impl EventMessages {
    /// The message of an event; of an image only its place.
    pub fn of(event: &EncodedEvent) -> Self {
        let stamp = event.stamp().into();
        match event {
            EncodedEvent::Wheels(ticks) => {
                Self::Wheels(WheelTicksMessage { stamp, left: ticks.left, right: ticks.right })
            }
            EncodedEvent::Gyro(rate) => Self::Gyro(GyroRateMessage { stamp, omega_rad_s: rate.omega }),
            EncodedEvent::Touch(touch) => Self::Touch(TouchMessage { stamp, pressed: touch.pressed }),
            EncodedEvent::Cliff(cliff) => Self::Cliff(CliffMessage { stamp, over_edge: cliff.over_edge }),
            EncodedEvent::Scan(scan) => Self::Scan(ScanMessage::new(stamp, scan)),
            EncodedEvent::Odometry(odometry) => Self::Odometry(OdometryMessage::new(stamp, odometry)),
            EncodedEvent::Body(event) => Self::Body(BodyEventMessage { stamp, event: event.kind }),
            EncodedEvent::Truth { stamp, pose } => Self::Truth(PoseInFrame::planar(*stamp, "world", *pose)),
            EncodedEvent::Rgbd(_) => Self::Image(ImageMessage { stamp }),
        }
    }
}

impl OdometryMessage {
    fn new(stamp: Time, odometry: &Odometry) -> Self {
        let Odometry { pose, twist, covariance, .. } = odometry;
        let row = |i| [covariance[(i, 0)], covariance[(i, 1)], covariance[(i, 2)]];
        Self {
            stamp,
            x_m: pose.x,
            y_m: pose.y,
            theta_rad: pose.theta,
            v_m_s: twist.v,
            omega_rad_s: twist.omega,
            covariance: [row(0), row(1), row(2)],
        }
    }
}

impl ScanMessage {
    fn new(stamp: Time, scan: &Scan) -> Self {
        let range = |beam: &Beam| match beam {
            Beam::Hit { range } | Beam::Free { range } => Some(*range),
            Beam::Unseen => None,
        };
        Self {
            stamp,
            origin_m: scan.origin().into(),
            angle_min_rad: scan.angle_min(),
            angle_increment_rad: scan.angle_increment(),
            ranges_m: scan.beams().iter().map(range).collect(),
            hits: scan.beams().iter().map(|beam| matches!(beam, Beam::Hit { .. })).collect(),
            beam_times_s: scan.beam_times().map(|times| [times.first_s, times.step_s]),
        }
    }

    fn beams(&self) -> Result<Vec<Beam>, Invalid> {
        if self.ranges_m.len() != self.hits.len() {
            let expected = format!("{} as ranges", self.ranges_m.len());
            return Err(Invalid::new("number of hits of a scan", self.hits.len(), "", expected));
        }
        let beam = |(range, is_hit): (&Option<f64>, &bool)| match (*range, is_hit) {
            (Some(range), true) => Beam::Hit { range },
            (Some(range), false) => Beam::Free { range },
            (None, _) => Beam::Unseen,
        };
        Ok(self.ranges_m.iter().zip(&self.hits).map(beam).collect())
    }
}

impl JsonImage {
    pub fn image(&self) -> Result<ImageBytes, String> {
        let bytes = STANDARD.decode(&self.data).map_err(|error| format!("data is not base64: {error}"))?;
        let stamp = self.timestamp.try_into().map_err(|invalid: Invalid| invalid.to_string())?;
        Ok(ImageBytes { stamp, bytes })
    }
}

/// The image that a colour and a depth message make.
pub(super) fn rgbd(color: ImageBytes, depth: ImageBytes) -> Result<EncodedEvent, String> {
    let stamp = color.stamp;
    if depth.stamp != stamp {
        return Err(format!("the depth image of {} s follows the colour image of {stamp} s", depth.stamp));
    }
    Ok(EncodedEvent::Rgbd(EncodedRgbd { stamp, color_jpeg: color.bytes, depth: depth.bytes }))
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

impl TryFrom<CliffMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: CliffMessage) -> Result<Self, Invalid> {
        Ok(Self::Cliff(Cliff { stamp: m.stamp.try_into()?, over_edge: m.over_edge }))
    }
}

impl TryFrom<OdometryMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: OdometryMessage) -> Result<Self, Invalid> {
        Ok(Self::Odometry(Odometry {
            stamp: m.stamp.try_into()?,
            pose: Pose2 { x: m.x_m, y: m.y_m, theta: m.theta_rad },
            twist: Twist2 { v: m.v_m_s, omega: m.omega_rad_s },
            covariance: Matrix3::from_fn(|i, j| m.covariance[i][j]),
        }))
    }
}

impl TryFrom<BodyEventMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: BodyEventMessage) -> Result<Self, Invalid> {
        Ok(Self::Body(BodyEvent::new(m.stamp.try_into()?, m.event)))
    }
}

impl TryFrom<ScanMessage> for EncodedEvent {
    type Error = Invalid;

    fn try_from(m: ScanMessage) -> Result<Self, Invalid> {
        let (beams, origin) = (m.beams()?, Vector2::from(m.origin_m));
        let scan = Scan::new(m.stamp.try_into()?, origin, m.angle_min_rad, m.angle_increment_rad, beams)?;
        Ok(Self::Scan(match m.beam_times_s {
            Some([first_s, step_s]) => scan.with_beam_times(BeamTimes { first_s, step_s })?,
            None => scan,
        }))
    }
}
