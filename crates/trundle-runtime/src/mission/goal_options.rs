//! Tolerances of a goal's arrival, and the behaviour if the path to the goal is blocked.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, require_in};

/// A goal of a mission: a pose, and how the robot drives there.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TaskGoal {
    /// The pose, map frame.
    #[serde(flatten)]
    pub pose: Pose2,
    /// How the robot drives there.
    #[serde(flatten)]
    pub options: GoalOptions,
}

/// Settings of one goal. A setting that is `None` is that of the robot file.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct GoalOptions {
    /// Time without progress after which the goal is given up \[s\], 1 to 3600. `None`: `mission_executor.patience_s`.
    #[serde(default, rename = "patience_s", skip_serializing_if = "Option::is_none")]
    pub patience: Option<f64>,
    /// Distance from the goal that counts as an arrival \[m\], 0.01 to 10. Also a blocked goal is then reached at the nearest free place
    /// within this distance. `None`: the robot settles exactly on the goal.
    #[serde(default, rename = "tolerance_m", skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Difference of heading that counts as an arrival \[rad\], 3.5 to 180 deg. `None`: with a [`GoalOptions::tolerance`] any heading, else the
    /// robot turns exactly to the heading.
    #[serde(default, rename = "heading_tolerance_rad", skip_serializing_if = "Option::is_none")]
    pub heading_tolerance: Option<f64>,
    /// Behaviour if an obstacle blocks the path. `None`: `mission_executor.when_blocked`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when_blocked: Option<WhenBlocked>,
    /// Whether the robot continues to the next goal of the mission without a stop once it is within the [`GoalOptions::tolerance`]. The last
    /// goal is always driven to.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub pass_through: bool,
}

/// Behaviour if an obstacle blocks the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WhenBlocked {
    /// Takes another path, of any length. Without a path the robot searches one until its patience ends.
    #[default]
    Detour,
    /// Waits until the path is free, without a limit of time, in place of a much longer path.
    Wait,
}

/// Range of the patience \[s\]. Source: ours.
pub(crate) const PATIENCE_RANGE_S: (f64, f64) = (1.0, 3600.0);
/// Range of the tolerance of a position \[m\]. Source: ours; below it the robot settles exactly.
const TOLERANCE_RANGE_M: (f64, f64) = (0.01, 10.0);
/// Range of the tolerance of a heading \[deg\]. Source: ours; the turn at the end of a path is exact to 2.9 deg.
const HEADING_TOLERANCE_RANGE_DEG: (f64, f64) = (3.5, 180.0);

impl TaskGoal {
    /// A pose with these options.
    #[must_use]
    pub fn new(pose: Pose2, options: GoalOptions) -> Self {
        Self { pose, options }
    }
}

impl From<Pose2> for TaskGoal {
    fn from(pose: Pose2) -> Self {
        Self { pose, options: GoalOptions::default() }
    }
}

impl GoalOptions {
    /// Returns valid options unchanged. `of`: the owner of the options in messages, as `of the goal of task 2`.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self, of: &str) -> Result<Self, Invalid> {
        let check = |name: &str, value: Option<f64>, unit: &'static str, (min, max): (f64, f64)| match value {
            Some(value) => require_in(&format!("{name} {of}"), value, unit, min, max).map(drop),
            None => Ok(()),
        };
        check("patience", self.patience, "s", PATIENCE_RANGE_S)?;
        check("tolerance", self.tolerance, "m", TOLERANCE_RANGE_M)?;
        if self.pass_through && self.tolerance.is_none() {
            let name = format!("pass_through {of}");
            return Err(Invalid::new(name, true, "", "a tolerance of the position beside it"));
        }
        // Missions hold headings in degrees.
        let heading = self.heading_tolerance.map(f64::to_degrees);
        if let (Some(heading), None) = (heading, self.tolerance) {
            let name = format!("heading tolerance {of}");
            return Err(Invalid::new(name, heading, "deg", "a tolerance of the position beside it"));
        }
        check("heading tolerance", heading, "deg", HEADING_TOLERANCE_RANGE_DEG)?;
        Ok(self)
    }

    /// These options, with others for those that are `None`.
    pub(crate) fn or(self, others: &Self) -> Self {
        Self {
            patience: self.patience.or(others.patience),
            tolerance: self.tolerance.or(others.tolerance),
            heading_tolerance: self.heading_tolerance.or(others.heading_tolerance),
            when_blocked: self.when_blocked.or(others.when_blocked),
            pass_through: self.pass_through,
        }
    }

    /// Whether a pose counts as an arrival at `goal`; false for a goal without tolerances.
    pub(crate) fn is_arrival(&self, pose: &Pose2, goal: &Pose2) -> bool {
        let Some(tolerance) = self.tolerance else { return false };
        let off = trundle_core::difference_of_angles(pose.theta, goal.theta).abs();
        pose.distance(goal) <= tolerance && self.heading_tolerance.is_none_or(|max| off <= max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_outside_their_range_are_refused_by_name() {
        let message = |options: GoalOptions| options.validated("of task 1").unwrap_err().to_string();
        let some = GoalOptions::default();
        assert_eq!(some.validated(""), Ok(some));
        assert!(message(GoalOptions { patience: Some(0.0), ..some }).contains("patience of task 1"));
        assert!(message(GoalOptions { tolerance: Some(0.001), ..some }).contains("tolerance of task 1"));
        assert!(message(GoalOptions { tolerance: Some(f64::NAN), ..some }).contains("tolerance of task 1"));
        let passed = message(GoalOptions { pass_through: true, ..some });
        assert!(passed.starts_with("pass_through of task 1 is true, expected a tolerance"), "{passed}");
        let turned = message(GoalOptions { heading_tolerance: Some(4.0), tolerance: Some(0.3), ..some });
        assert!(turned.contains("heading tolerance of task 1 is 229") && turned.contains(" deg"), "{turned}");
    }

    #[test]
    fn an_arrival_is_within_both_tolerances() {
        let goal = Pose2::new(1.0, 2.0, 3.1);
        let at = |x: f64, theta: f64| Pose2::new(x, 2.0, theta);
        let exact = GoalOptions::default();
        assert!(!exact.is_arrival(&goal, &goal), "the robot settles first");
        let near = GoalOptions { tolerance: Some(0.2), ..exact };
        assert!(near.is_arrival(&at(1.19, 0.0), &goal) && !near.is_arrival(&at(1.21, 3.1), &goal));
        let turned = GoalOptions { heading_tolerance: Some(0.1), ..near };
        assert!(turned.is_arrival(&at(1.1, -3.13), &goal) && !turned.is_arrival(&at(1.1, 2.9), &goal));
        let heading_alone = GoalOptions { heading_tolerance: Some(3.0), ..exact };
        assert!(!heading_alone.is_arrival(&at(1.1, 3.1), &goal));
    }

    #[test]
    fn a_goal_without_options_is_its_pose_in_a_file() {
        let plain = TaskGoal::from(Pose2::new(1.0, 2.0, 0.5));
        assert_eq!(serde_json::to_string(&plain).unwrap(), r#"{"x":1.0,"y":2.0,"theta":0.5}"#);
        let options =
            GoalOptions { patience: Some(600.0), when_blocked: Some(WhenBlocked::Wait), ..plain.options };
        let waits = TaskGoal { options, ..plain };
        let text = serde_json::to_string(&waits).unwrap();
        assert_eq!(text, r#"{"x":1.0,"y":2.0,"theta":0.5,"patience_s":600.0,"when_blocked":"wait"}"#);
        assert_eq!(serde_json::from_str::<TaskGoal>(&text).unwrap(), waits);
    }
}
