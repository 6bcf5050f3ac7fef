//! Configuration of the docking planner.

use crate::hong24::config::Hong24Config;
use crate::motion::limits::MotionLimits;
use serde::{Deserialize, Serialize};
use trundle_core::{Footprint, Invalid, Pose2, Vector2, require_in};

/// Planning method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Minimum time over all sequences of turns and straight moves, with a lower bound.
    #[default]
    Optimal,
    /// The greedy method of \[Hong24\].
    #[serde(rename = "paper", alias = "hong24")]
    Hong24,
}

impl Method {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 2] = [
        ("optimal", "Shortest time, with a proven bound", Self::Optimal),
        ("paper", "The greedy method of Hong (2024)", Self::Hong24),
    ];
}

/// Parameters of docking in narrow spaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct DockingConfig {
    /// Planning method. Default optimal (ours): it solves more problems than `hong24`, with faster manoeuvres
    /// (docs/algorithms/docking.md).
    pub method: Method,
    /// Speeds, and the pause between two motions.
    pub limits: MotionLimits,
    /// Distance of manoeuvres from obstacles, m, 0 to 0.5. A smaller margin is used if start or goal are nearer, or if no manoeuvre keeps
    /// the margin. Default 0.01 (ours: the position tolerance); in the robot file 0.05, above `safety.stop_margin_m`.
    pub margin: f64,
    /// Fraction of the time that a smaller margin must save, 0 to 1. With 1 the margin is kept whenever a manoeuvre exists, as in
    /// [`crate::Positioner`], whose measured poses are noisy. Default 0.25 (ours).
    pub margin_saving: f64,
    /// Largest overlap of start or goal with an obstacle that counts as an error of the pose, m, 0 to 0.02. Default 0 (ours): the poses are
    /// exact.
    pub overlap: f64,
    /// Distance from the line between start and goal within which manoeuvres are searched, m, 0.1 to 10. A larger value finds more and
    /// takes longer. Default 1.5 (ours).
    pub reach: f64,
    /// Largest distance of the goal, m, 0.1 to 20. Farther goals need a path first. Default 5 (ours).
    pub max_distance: f64,
    /// Tolerance of the position, m, 0.001 to 0.1; also the side of the certificate's cells. Default 0.01 (ours).
    pub position_tolerance: f64,
    /// Tolerance of the heading, rad, 0.001 to 0.2. Default 0.0175 (1 deg; ours).
    pub heading_tolerance: f64,
    /// Maximum number of nodes in the search for manoeuvres of three and more straight moves, 0 to 10^7. More find more manoeuvres and take
    /// longer. Default 2500 (ours: at most a second, in hard problems only).
    pub search_nodes: usize,
    /// Cost limit of the search for many motions per margin, in counted steps of some 10 ns ([`crate::ContactSpace::work`]), 10^5 to 10^11.
    /// Default 5 * 10^7 (ours: half a second; the hardest of 5,000 corridor problems takes a third of it); in the robot file 5 * 10^6.
    pub max_work: u64,
    /// Cost limit of a whole plan, in the same counted steps, 10^5 to 10^11. At the limit the best manoeuvre so far is the result. Default
    /// 2 * 10^8 (ours: two seconds; the hardest of 5,000 corridor problems takes half of it); in the robot file 2 * 10^7.
    pub plan_work: u64,
    /// Cost limit of a whole plan among more than 200 points, in the same counted steps, 10^5 to 10^11, if smaller than `plan_work`. Default 6 * 10^6
    /// (ours: less than 100 ms among a hundred thousand points).
    pub points_work: u64,
    /// Number of boxes of the branch and bound for the lower bound, 0 to 10^8. With more than 200 segments the number is reduced in
    /// proportion. Default 400 (ours: a few ms).
    pub bound_boxes: usize,
    /// Relative gap between time and lower bound at which the search ends, 0 to 1. Default 0.01 (ours).
    pub gap: f64,
    /// Parameters of \[Hong24\], for [`Method::Hong24`].
    pub paper: Hong24Config,
}

impl Default for DockingConfig {
    fn default() -> Self {
        Self {
            method: Method::Optimal,
            limits: MotionLimits::default(),
            margin: 0.01,
            margin_saving: 0.25,
            overlap: 0.0,
            reach: 1.5,
            max_distance: 5.0,
            position_tolerance: 0.01,
            heading_tolerance: 1_f64.to_radians(),
            search_nodes: 2500,
            max_work: 50_000_000,
            plan_work: 200_000_000,
            points_work: 6_000_000,
            bound_boxes: 400,
            gap: 0.01,
            paper: Hong24Config::default(),
        }
    }
}

/// Factor on the reach of the second search, if the first one finds no manoeuvre. Source: ours.
pub(crate) const WIDER_REACH_FACTOR: f64 = 2.0;

/// Distance beyond the positions of the base, besides the robot's own radius, within which obstacles matter, m. Source: ours.
pub(crate) const OBSTACLE_MARGIN_M: f64 = 0.1;

impl DockingConfig {
    /// Centre and half side (m) of the square, map frame, whose obstacles matter to a plan from `start` to `goal`: a scene must
    /// contain all of them.
    pub fn view(&self, footprint: &Footprint, start: &Pose2, goal: &Pose2) -> (Vector2, f64) {
        let middle = (start.position() + goal.position()) / 2.0;
        let distance = WIDER_REACH_FACTOR * self.reach + start.distance(goal) / 2.0;
        (middle, distance + footprint.circumscribed_radius() + OBSTACLE_MARGIN_M)
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        self.limits = self.limits.validated()?;
        self.paper = self.paper.validated()?;
        let ranges = [
            ("margin", self.margin, "m", 0.0, 0.5),
            ("margin_saving", self.margin_saving, "", 0.0, 1.0),
            ("overlap", self.overlap, "m", 0.0, 0.02),
            ("reach", self.reach, "m", 0.1, 10.0),
            ("max_distance", self.max_distance, "m", 0.1, 20.0),
            ("position_tolerance", self.position_tolerance, "m", 0.001, 0.1),
            ("heading_tolerance", self.heading_tolerance, "rad", 0.001, 0.2),
            ("search_nodes", self.search_nodes as f64, "", 0.0, 1e7),
            ("max_work", self.max_work as f64, "", 1e5, 1e11),
            ("plan_work", self.plan_work as f64, "", 1e5, 1e11),
            ("points_work", self.points_work as f64, "", 1e5, 1e11),
            ("bound_boxes", self.bound_boxes as f64, "", 0.0, 1e8),
            ("gap", self.gap, "", 0.0, 1.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("docking.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invalid_number_is_refused_with_its_key() {
        assert!(DockingConfig::default().validated().is_ok());
        let error = DockingConfig { reach: f64::NAN, ..DockingConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "docking.reach");
    }
}
