//! Log events of the robot: changes of state, corrections of the pose, dropped images. Times are those of the data.

use super::sensor_watch::SensorChange;
use crate::behaviour::drive_state::DriveState;
use crate::operator::{PoseGuess, RunSetting};
use crate::reason::{Reason, TransitionReason};
use trundle_control::MotionHold;
use trundle_core::{
    BodyEvent, BodyEventKind, Button, GridGeometry, Invalid, MapAnnotations, Pose2, Stamp,
    difference_of_angles,
};
use trundle_estimation::{VisualVerdict, WheelCounts, WheelReport};

/// Smallest correction of the pose estimate that is logged \[m\]. Source: ours, the size of a grid cell.
const LOGGED_CORRECTION_M: f64 = 0.05;

/// Reason for a dropped image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DroppedImage {
    /// A newer image arrived before a worker was free.
    Replaced,
    /// No wheel reading arrived before the image.
    NoOdometry,
    /// The camera repeats its last image.
    Frozen,
    /// The run is over.
    RunOver,
}

impl DroppedImage {
    fn text(self) -> &'static str {
        match self {
            Self::Replaced => "a newer image replaces it",
            Self::NoOdometry => "no wheel reading came before it",
            Self::Frozen => "the camera repeats its last image",
            Self::RunOver => "the run is over",
        }
    }
}

/// Logs a silent fault of wheels or gyro, or its end. `count`: number of the fault.
pub(super) fn sensor_change(at: Stamp, (change, count): (SensorChange, u32)) {
    let times = if count > 1 { format!(" ({count} times so far)") } else { String::new() };
    tracing::warn!("{:.3} s: {}{times}", at.as_secs(), change.text());
}

/// Logs impossible readings of the wheels: the first, the second, the fourth and so on.
pub(super) fn encoder_jump(at: Stamp, report: WheelReport, counts: WheelCounts) {
    let at = at.as_secs();
    match report {
        WheelReport::TooFast { speed } if counts.too_fast.is_power_of_two() => tracing::warn!(
            "{at:.3} s: the encoders jump: the wheels would drive {speed:.1} m/s, more than odometry.max_speed; the reading is dropped, \
             {} so far; check the encoders and the base's cable",
            counts.too_fast
        ),
        WheelReport::Restarted if counts.restarts.is_power_of_two() => tracing::warn!(
            "{at:.3} s: the encoders count on from another value, {} times so far: the motion in between is unknown",
            counts.restarts
        ),
        _ => {}
    }
}

/// Logs a pose given by an operator.
pub(super) fn pose_given(at: Stamp, guess: &PoseGuess) {
    let (at, pose, sigma) = (at.as_secs(), guess.pose, guess.position_sigma);
    let heading = pose.theta.to_degrees();
    tracing::info!(
        "{at:.3} s: the operator gives the pose ({:.2} m, {:.2} m, {heading:.0} deg), standard deviation {sigma:.2} m",
        pose.x,
        pose.y
    );
}

/// Logs a map given by an operator, with the reason of a refusal.
pub(super) fn map_given(at: Stamp, geometry: &GridGeometry, refused: Option<&Invalid>) {
    let (at, GridGeometry { width, height, .. }) = (at.as_secs(), geometry);
    match refused {
        None => tracing::info!(
            "{at:.3} s: the operator gives another map of {width} x {height} cells: the pose in it is unknown"
        ),
        Some(why) => {
            tracing::warn!("{at:.3} s: the operator's map is refused, the robot keeps its own: {why}")
        }
    }
}

/// Logs a setting changed by an operator.
pub(super) fn setting_changed(at: Stamp, setting: RunSetting) {
    tracing::info!("{:.3} s: the operator changes a setting: {setting:?}", at.as_secs());
}

/// Logs the zones and places given by an operator.
pub(super) fn annotated(at: Stamp, annotations: &MapAnnotations) {
    let (zones, places) = (annotations.zones.len(), annotations.places.len());
    tracing::info!(
        "{:.3} s: the operator gives the map's zones ({zones}) and places ({places})",
        at.as_secs()
    );
}

/// Logs a state that differs from the last one, with its reason or the reason for the change, or a state with a reason of another kind.
pub(super) fn state(at: Stamp, last: &DriveState, new: &DriveState, transition: Option<TransitionReason>) {
    let kind = |state: &DriveState| state.reason().map(Reason::kind);
    if last.name() != new.name() {
        let new = new.explained(transition);
        tracing::info!("{:.3} s: {} -> {new}", at.as_secs(), last.name());
    } else if kind(last) != kind(new) {
        tracing::info!("{:.3} s: still {new}", at.as_secs());
    }
}

/// Logs a large correction of the pose estimate by `source`, from `old` to `new`.
pub(super) fn correction(at: Stamp, source: &str, old: Pose2, new: Pose2) {
    let distance = old.distance(&new);
    if distance > LOGGED_CORRECTION_M {
        let turn = difference_of_angles(new.theta, old.theta).to_degrees();
        tracing::info!("{:.3} s: {source} corrects the pose by {distance:.3} m, {turn:.2} deg", at.as_secs());
    }
}

/// Logs a visual pose that was not used.
pub(super) fn visual_verdict(at: Stamp, verdict: VisualVerdict) {
    let at = at.as_secs();
    match verdict {
        VisualVerdict::Accepted => {}
        VisualVerdict::Ignored => {
            tracing::debug!(
                "{at:.3} s: the visual pose is ignored: it follows something that moves, or tracking went on from a wrong pose"
            )
        }
        VisualVerdict::FrameMoved => {
            tracing::info!("{at:.3} s: the visual map does not fit the scans; it is anchored anew")
        }
        VisualVerdict::FalseRecognition => {
            tracing::info!(
                "{at:.3} s: an image recognises a place that the scans and the wheels contradict; it is refused"
            );
        }
    }
}

/// Logs a press of a button of the body.
pub(super) fn body(event: &BodyEvent) {
    if let BodyEventKind::Button(Button { index, pressed: true }) = event.kind {
        tracing::info!("{:.3} s: button B{index} is pressed", event.stamp.as_secs());
    }
}

/// Logs a holding condition of the body, or its end.
pub(super) fn hold(at: Stamp, hold: Option<MotionHold>) {
    match hold {
        Some(hold) => tracing::warn!("{:.3} s: no motion: {hold}", at.as_secs()),
        None => tracing::info!("{:.3} s: motion is free again", at.as_secs()),
    }
}

/// Logs a dropped image.
pub(super) fn dropped_image(stamp: Stamp, why: DroppedImage) {
    tracing::debug!("image of {:.3} s dropped: {}", stamp.as_secs(), why.text());
}
