//! Manoeuvres: sequences of turns in place and straight moves.

use crate::motion::limits::MotionLimits;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, Twist2};

/// A motion from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// A turn in place, rad, counter-clockwise positive; more than half a turn if only the longer turn is free.
    Turn(f64),
    /// A straight move, m, backward negative.
    Drive(f64),
}

impl Motion {
    /// Pose of a base that started at `from` after `part` of the motion (in the motion's unit, m or rad).
    pub fn after(&self, from: Pose2, part: f64) -> Pose2 {
        match self {
            Self::Turn(_) => Pose2::new(from.x, from.y, from.theta + part),
            Self::Drive(_) => {
                let p = from.position() + from.direction() * part;
                Pose2 { x: p.x, y: p.y, theta: from.theta }
            }
        }
    }

    /// The whole motion: rad or m.
    pub fn amount(&self) -> f64 {
        match self {
            Self::Turn(amount) | Self::Drive(amount) => *amount,
        }
    }

    /// Time from rest to rest, s.
    pub fn time(&self, limits: &MotionLimits) -> f64 {
        match self {
            Self::Turn(angle) => limits.turn_time(*angle),
            Self::Drive(distance) => limits.drive_time(*distance),
        }
    }

    /// One word for people: `clockwise`, `counter-clockwise`, `forward`, `back`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Turn(angle) if *angle < 0.0 => "clockwise",
            Self::Turn(_) => "counter-clockwise",
            Self::Drive(distance) if *distance < 0.0 => "back",
            Self::Drive(_) => "forward",
        }
    }
}

/// A motion with its poses and times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// The motion.
    pub motion: Motion,
    /// `map_from_base` before the motion.
    pub from: Pose2,
    /// `map_from_base` after the motion.
    pub to: Pose2,
    /// Start, s after the manoeuvre's start.
    pub starts: f64,
    /// Duration, s, without the pause that follows.
    pub lasts: f64,
}

/// A sequence of motions with a pause between every two.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manoeuvre {
    steps: Vec<Step>,
    limits: MotionLimits,
    start: Pose2,
}

impl Manoeuvre {
    /// The motions from a pose. Empty motions are left out, neighbours of one kind are joined.
    pub fn new(start: Pose2, motions: &[Motion], limits: MotionLimits) -> Self {
        let (mut steps, mut from, mut starts) = (Vec::new(), start, 0.0);
        for motion in joined(motions) {
            let lasts = motion.time(&limits);
            let to = motion.after(from, motion.amount());
            steps.push(Step { motion, from, to, starts, lasts });
            (from, starts) = (to, starts + lasts + limits.switch_time);
        }
        Self { steps, limits, start }
    }

    /// The motions with their poses and times.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// `map_from_base` at the start.
    pub fn start(&self) -> Pose2 {
        self.start
    }

    /// `map_from_base` at the end.
    pub fn end(&self) -> Pose2 {
        self.steps.last().map_or(self.start, |step| step.to)
    }

    /// Duration with pauses, s.
    pub fn duration(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.starts + step.lasts)
    }

    /// Speeds and pauses of the manoeuvre.
    pub fn limits(&self) -> &MotionLimits {
        &self.limits
    }

    /// Pose and twist `time` seconds after the start; before and after the manoeuvre, those of its ends.
    pub fn at(&self, time: f64) -> (Pose2, Twist2) {
        let Some(step) = self.steps.iter().rev().find(|step| step.starts <= time).or(self.steps.first())
        else {
            return (self.start, Twist2::ZERO);
        };
        let since = time - step.starts;
        if since < 0.0 || since >= step.lasts {
            return (if since < 0.0 { step.from } else { step.to }, Twist2::ZERO);
        }
        match step.motion {
            Motion::Turn(angle) => {
                let (done, rate) = self.limits.turn_at(angle, since);
                (step.motion.after(step.from, done), Twist2::new(0.0, rate))
            }
            Motion::Drive(distance) => {
                let (done, speed) = self.limits.drive_at(distance, since);
                (step.motion.after(step.from, done), Twist2::new(speed, 0.0))
            }
        }
    }
}

/// Amount below which a motion is empty, m or rad. Source: ours.
const MIN_AMOUNT: f64 = 1e-7;

fn joined(motions: &[Motion]) -> Vec<Motion> {
    let mut list: Vec<Motion> = Vec::with_capacity(motions.len());
    for &motion in motions.iter().filter(|m| m.amount().abs() > MIN_AMOUNT) {
        match (list.last_mut(), motion) {
            (Some(Motion::Turn(sum)), Motion::Turn(more))
            | (Some(Motion::Drive(sum)), Motion::Drive(more)) => *sum += more,
            _ => list.push(motion),
        }
        // The remainder of motions that cancel; the neighbours before and after it are then joined too.
        list.pop_if(|m| m.amount().abs() <= MIN_AMOUNT);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_follow_the_steps_and_the_end_is_exact() {
        let motions = [
            Motion::Turn(0.5),
            Motion::Drive(0.2),
            Motion::Drive(0.0),
            Motion::Turn(-0.5),
            Motion::Drive(-0.1),
        ];
        let manoeuvre = Manoeuvre::new(Pose2::new(1.0, 2.0, 0.3), &motions, MotionLimits::default());
        assert_eq!(manoeuvre.steps().len(), 4);
        let (end, twist) = manoeuvre.at(manoeuvre.duration());
        assert_eq!(end, manoeuvre.end());
        assert!(twist.v.abs() < 1e-12 && twist.omega == 0.0);
        for step in manoeuvre.steps() {
            let (pose, _) = manoeuvre.at(step.starts + step.lasts + 0.1);
            assert!(pose.distance(&step.to) < 1e-12);
        }
        assert!((manoeuvre.end().theta - 0.3).abs() < 1e-12);
    }
}
