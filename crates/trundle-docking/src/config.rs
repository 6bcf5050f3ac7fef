use crate::limits::MotionLimits;
use crate::paper::PaperConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Footprint, Invalid, Pose2, Vector2, require_in};

/// Which method plans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Least time over all sequences of turns and straight moves, with a proven bound.
    #[default]
    Optimal,
    /// The greedy method of \[Hong24\].
    Paper,
}

/// How a robot settles on its goal in tight spaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DockingConfig {
    /// Which method plans. Default: the optimal one.
    pub method: Method,
    /// Speeds, and the pause between two motions.
    pub limits: MotionLimits,
    /// Kept from every obstacle, m, 0 to 0.5. Default 0.01 (ours: the position tolerance). Where start or goal are
    /// nearer than that, or there is no manoeuvre that keeps it, less will do.
    pub margin: f64,
    /// Less than the margin is kept where that saves this part of the time, 0 to 1. Default 0.25 (ours); 1 keeps the margin
    /// wherever there is a manoeuvre that does, as [`crate::Positioner`] does always: its poses are measured with noise.
    pub margin_saving: f64,
    /// Overlap of start or goal with an obstacle that is taken for an error of the pose, m, 0 to 0.02. Default 0.
    pub overlap: f64,
    /// How far beyond the line from start to goal a manoeuvre may go, m, 0.1 to 10. Default 1.5 (ours).
    pub reach: f64,
    /// Farthest goal, m, 0.1 to 20: beyond, plan a path there first. Default 5 (ours).
    pub max_distance: f64,
    /// An error of position that counts as none, m, 0.001 to 0.1; the cells of the certificate have this side. Default 0.01.
    pub position_tolerance: f64,
    /// An error of heading that counts as none, rad, 0.001 to 0.2. Default 1 deg.
    pub heading_tolerance: f64,
    /// Nodes of the search for manoeuvres of three and more straight moves, 0 to 10^7. Default 2500 (ours: a second
    /// at most; hard problems only).
    pub search_nodes: usize,
    /// What the search for many motions may cost for each margin, in counted steps of some 10 ns ([`crate::Space::work`]), 10^5
    /// to 10^11. Default 5 * 10^7 (ours: half a second; the hardest of 5,000 corridor problems takes a third of it).
    pub most_work: u64,
    /// What a whole plan may cost, in the same steps, 10^5 to 10^11: it then says what it has. Default 2 * 10^8 (ours: two
    /// seconds; the hardest of 5,000 corridor problems takes half of it).
    pub plan_work: u64,
    /// The same among more than 200 points, if that is less. Default 6 * 10^6 (ours: less than 100 ms among a hundred thousand
    /// points, whatever their places).
    pub points_work: u64,
    /// Boxes of the search for a better bound on the time, 0 to 10^8; fewer, in proportion, where there are more than 200 straight
    /// pieces, as a box looks at each. Default 400 (ours: a few ms).
    pub bound_boxes: usize,
    /// The search ends when the time is proven to be within this part of the least, 0 to 1. Default 0.01.
    pub gap: f64,
    /// The settings of \[Hong24\], for [`Method::Paper`].
    pub paper: PaperConfig,
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
            most_work: 50_000_000,
            plan_work: 200_000_000,
            points_work: 6_000_000,
            bound_boxes: 400,
            gap: 0.01,
            paper: PaperConfig::default(),
        }
    }
}

/// Where no manoeuvre is found within reach, one may go so much farther.
pub(crate) const WIDER: f64 = 2.0;

/// What a robot may touch beyond where its base goes, besides its own radius, m.
pub(crate) const BESIDE: f64 = 0.1;

impl DockingConfig {
    /// Middle and half side (m) of the square, map frame, within which a plan from `start` to `goal` may meet obstacles: a
    /// scene must hold all there are in it.
    pub fn view(&self, footprint: &Footprint, start: &Pose2, goal: &Pose2) -> (Vector2, f64) {
        let middle = (start.position() + goal.position()) / 2.0;
        let way = WIDER * self.reach + start.distance(goal) / 2.0;
        (middle, way + footprint.circumscribed_radius() + BESIDE)
    }

    /// Passes a valid configuration through.
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
            ("most_work", self.most_work as f64, "", 1e5, 1e11),
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
    fn bad_numbers_are_refused_by_name() {
        assert!(DockingConfig::default().validated().is_ok());
        let error = DockingConfig { reach: f64::NAN, ..DockingConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "docking.reach");
    }
}
