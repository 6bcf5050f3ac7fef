//! A run through a world of the BARN challenge, with the challenge's score.

use super::worlds::BarnWorld;
use crate::RunResult;
use crate::laser_run::{LaserRun, Moment};
use crate::shards::points;
use serde::{Deserialize, Serialize};
use trundle_core::{OccupancyGrid, Vector2};
use trundle_runtime::DriveState;

/// Time limit of a run \[s\]. Source: the BARN challenge.
pub const TIME_LIMIT_S: f64 = 100.0;
/// Distance from the goal within which the goal counts as reached \[m\]. Source: the BARN challenge.
pub const GOAL_TOLERANCE_M: f64 = 1.0;
/// Distance from the start at which the clock starts \[m\]. Source: the BARN challenge.
pub const CLOCK_START_M: f64 = 0.1;
/// Time before the limit after which a run counts as out of time \[s\]. Source: ours.
const OUT_OF_TIME_MARGIN_S: f64 = 1.0;

/// A run through a world.
#[derive(Debug, Serialize, Deserialize)]
pub struct BarnTrial {
    /// The world.
    pub(super) world: BarnWorld,
    /// Seed of the noise.
    pub(super) seed: u64,
    /// Whether the goal was reached without a contact.
    pub(super) success: bool,
    /// Time from the start of the clock to the goal or the end, s.
    pub(super) time: f64,
    /// The challenge's score.
    pub(super) score: f64,
    /// Number of contacts.
    pub(super) contacts: u32,
    /// Distance driven, m.
    pub(super) length: f64,
    /// Minimum clearance, m.
    pub(super) min_clearance: f64,
    /// Largest distance of the estimate from truth, m.
    pub(super) max_estimate_error: f64,
    /// Number of plans.
    pub(super) plans: usize,
    /// Control cycle: median and maximum, ms.
    pub(super) cycle_ms: (f64, f64),
    /// The state at the end.
    pub(super) state: DriveState,
    /// Positions driven, world frame.
    #[serde(with = "points")]
    pub(super) driven: Vec<Vector2>,
    /// The map, map frame.
    pub(super) grid: OccupancyGrid,
}

/// Whether the robot is within the tolerance of the goal.
pub(super) fn is_at_goal(moment: &Moment) -> bool {
    moment.pose.distance(&BarnWorld::goal()) < GOAL_TOLERANCE_M
}

impl BarnTrial {
    /// The trial of a finished run.
    pub(super) fn of(world: BarnWorld, seed: u64, run: LaserRun) -> Self {
        let end = *run.end();
        let set_out = run.moments.iter().find(|m| m.pose.distance(&BarnWorld::start()) > CLOCK_START_M);
        let time = end.time - set_out.map_or(0.0, |moment| moment.time);
        let success = is_at_goal(&end) && end.contacts == 0;
        let score = if success { score(world.optimal_time, time) } else { 0.0 };
        let mut cycles = run.cycles_ms.clone();
        cycles.sort_by(f64::total_cmp);
        Self {
            success,
            time,
            score,
            contacts: end.contacts,
            length: run.path_length(),
            min_clearance: run.moments.iter().map(|m| m.clearance).fold(f64::INFINITY, f64::min),
            max_estimate_error: run.worst_estimate(),
            plans: run.plans,
            cycle_ms: (cycles[cycles.len() / 2], cycles[cycles.len() - 1]),
            driven: run.moments.iter().map(|m| m.pose.position()).collect(),
            grid: run.robot.grid().clone(),
            state: run.state,
            world,
            seed,
        }
    }

    /// The outcome in one or two words.
    pub(super) fn outcome_text(&self) -> String {
        match self.success {
            true => "goal reached".to_owned(),
            false if self.contacts > 0 => "contact".to_owned(),
            false if self.time >= TIME_LIMIT_S - OUT_OF_TIME_MARGIN_S => {
                format!("out of time, {}", self.state)
            }
            false => self.state.to_string(),
        }
    }
}

impl RunResult for BarnTrial {
    fn is_success(&self) -> bool {
        self.success
    }

    fn sentence(&self) -> String {
        format!("{} after {:.1} s, score {:.2}", self.outcome_text(), self.time, self.score)
    }
}

/// The challenge's score of a world that was crossed: OT / clip(AT, 2 OT, 8 OT).
fn score(optimal: f64, actual: f64) -> f64 {
    optimal / actual.clamp(2.0 * optimal, 8.0 * optimal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_score_is_the_challenges() {
        assert_eq!(score(6.0, 3.0), 0.5);
        assert_eq!(score(6.0, 24.0), 0.25);
        assert_eq!(score(6.0, 90.0), 0.125);
    }
}
