//! Segments of a drive: motion of the camera with the turns of the wheels.

use super::planar_track::PlanarPose;
use super::wheel_angles::{WheelAngles, WheelTurn};
use nalgebra::Rotation2;
use trundle_core::Vector2;

/// Turn at which a segment ends: 1 rad. Source: ours; shorter segments determine the camera's offset poorly.
const MAX_TURN_RAD: f64 = 1.0;
/// Distance of the camera at which a segment ends: 0.4 m. Source: ours.
const MAX_DISTANCE_M: f64 = 0.4;
/// Longest segment: 4 s. Source: ours.
const MAX_DURATION_S: f64 = 4.0;
/// Longest time between two images: 0.5 s. A longer gap ends the segment. Source: ours.
const MAX_IMAGE_GAP_S: f64 = 0.5;

/// Motion of the camera over a segment, in steps from image to image.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    /// Displacement of the camera in the levelled frame of its start, m.
    pub(super) displacement: Vector2,
    /// Turn of the camera, rad.
    pub(super) turn: f64,
    /// Turns of the wheels.
    pub(super) wheels: WheelTurn,
    steps: Vec<Step>,
}

/// Motion between two images.
#[derive(Debug, Clone, Copy)]
struct Step {
    wheels: WheelTurn,
    /// Heading in the middle of the step minus that at the segment's start, rad.
    heading: f64,
    /// Turn of the step, rad.
    turn: f64,
}

impl Segment {
    /// Displacement of the base in its own frame at the segment's start; each step is an arc. `distance` converts turns of the wheels to
    /// the unit of the result.
    pub(super) fn base_displacement(&self, distance: impl Fn(&WheelTurn) -> f64) -> Vector2 {
        let chord = |step: &Step| {
            let half = step.turn / 2.0;
            let ratio = if half.abs() < 1e-6 { 1.0 } else { half.sin() / half };
            Rotation2::new(step.heading) * Vector2::new(distance(&step.wheels) * ratio, 0.0)
        };
        self.steps.iter().map(chord).sum()
    }
}

/// The successive segments of a trajectory, without those of a robot at rest.
pub(super) fn segments(track: &[PlanarPose], wheels: &WheelAngles) -> Vec<Segment> {
    let mut found = Vec::new();
    let mut open: Vec<(PlanarPose, WheelTurn)> = Vec::new();
    for pair in track.windows(2) {
        let turned = wheels.turn(pair[0].stamp, pair[1].stamp);
        let Some(turned) = turned.filter(|_| pair[1].stamp - pair[0].stamp <= MAX_IMAGE_GAP_S) else {
            open.clear();
            continue;
        };
        if open.is_empty() {
            open.push((pair[0], WheelTurn::default()));
        }
        open.push((pair[1], turned));
        let start = open[0].0;
        let is_long = (pair[1].heading - start.heading).abs() >= MAX_TURN_RAD
            || (pair[1].position - start.position).norm() >= MAX_DISTANCE_M;
        if is_long || pair[1].stamp - start.stamp >= MAX_DURATION_S {
            found.extend(is_long.then(|| segment(&open)));
            open.clear();
        }
    }
    found
}

fn segment(poses: &[(PlanarPose, WheelTurn)]) -> Segment {
    let (start, end) = (poses[0].0, poses[poses.len() - 1].0);
    let step = |pair: &[(PlanarPose, WheelTurn)]| {
        let (earlier, later) = (pair[0].0.heading, pair[1].0.heading);
        Step { wheels: pair[1].1, heading: (earlier + later) / 2.0 - start.heading, turn: later - earlier }
    };
    let sum = |total: WheelTurn, (_, turn): &(PlanarPose, WheelTurn)| WheelTurn {
        left: total.left + turn.left,
        right: total.right + turn.right,
    };
    Segment {
        displacement: Rotation2::new(-start.heading) * (end.position - start.position),
        turn: end.heading - start.heading,
        wheels: poses.iter().fold(WheelTurn::default(), sum),
        steps: poses.windows(2).map(step).collect(),
    }
}
