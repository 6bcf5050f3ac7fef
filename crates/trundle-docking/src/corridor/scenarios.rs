//! The four scenarios of \[Hong24\].

use crate::corridor::problem::Problem;
use crate::scene::obstacle_scene::Obstacle;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Footprint, Pose2, Vector2};

/// The corridor scenarios of \[Hong24\], figure 6: the goal's heading is up. The paper gives no measures; ours are a corridor of
/// 1.0 m and a robot of 0.6 x 0.4 m.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scenario {
    /// (a) No obstacle, the goal to the right.
    Free,
    /// (b) The front is blocked.
    FrontBlocked,
    /// (c) The left front is blocked.
    LeftFrontBlocked,
    /// (d) The right front is blocked, the goal to the right and behind.
    RightFrontBlocked,
}

impl Scenario {
    /// All four, in the paper's order.
    pub const ALL: [Self; 4] =
        [Self::Free, Self::FrontBlocked, Self::LeftFrontBlocked, Self::RightFrontBlocked];

    /// The paper's letter.
    pub fn letter(self) -> char {
        match self {
            Self::Free => 'a',
            Self::FrontBlocked => 'b',
            Self::LeftFrontBlocked => 'c',
            Self::RightFrontBlocked => 'd',
        }
    }

    /// The motions that the paper reports, as words of [`crate::Motion::word`].
    pub fn reported(self) -> [&'static str; 4] {
        match self {
            Self::Free | Self::LeftFrontBlocked => ["clockwise", "forward", "counter-clockwise", "back"],
            Self::FrontBlocked | Self::RightFrontBlocked => {
                ["counter-clockwise", "back", "clockwise", "forward"]
            }
        }
    }

    /// Robot, start, goal and obstacles.
    pub fn problem(self) -> Problem {
        let (goal_y, blocks): (f64, &[[f64; 4]]) = match self {
            Self::Free => (0.0, &[]),
            Self::FrontBlocked => (0.0, &[[-0.5, 0.36, 0.5, 0.46]]),
            Self::LeftFrontBlocked => (0.0, &[[-0.5, 0.40, -0.32, 0.8]]),
            Self::RightFrontBlocked => (-0.1, &[[0.12, 0.36, 0.5, 0.8]]),
        };
        let mut obstacles: Vec<Obstacle> =
            [-0.5, 0.5].map(|x| Obstacle::Segment(at(x, -1.5), at(x, 1.5))).to_vec();
        obstacles.extend(blocks.iter().map(|&[left, bottom, right, top]| {
            Obstacle::Polygon(vec![at(left, bottom), at(right, bottom), at(right, top), at(left, top)])
        }));
        let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)];
        Problem {
            name: format!("hong24-{}", self.letter()),
            footprint: Footprint::Polygon { corners: corners.map(|(x, y)| at(x, y)).to_vec() },
            start: Pose2::new(-0.1, 0.0, FRAC_PI_2),
            goal: Pose2::new(0.1, goal_y, FRAC_PI_2),
            obstacles,
        }
    }
}

fn at(x: f64, y: f64) -> Vector2 {
    Vector2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking_config::{DockingConfig, Method};
    use crate::docking_plan::DockingPlan;
    use crate::planner::DockingPlanner;

    #[test]
    fn the_method_of_hong24_makes_the_reported_motions() {
        let config = DockingConfig { method: Method::Hong24, ..DockingConfig::default() };
        let planner = DockingPlanner::new(config).unwrap();
        for scenario in Scenario::ALL {
            let Problem { footprint, start, goal, .. } = scenario.problem();
            let plan = planner.plan(&footprint, &scenario.problem().scene().unwrap(), start, goal).unwrap();
            let DockingPlan::Found(solution) = plan else { panic!("{scenario:?}: {plan:?}") };
            let words: Vec<_> = solution.manoeuvre.steps().iter().map(|step| step.motion.word()).collect();
            assert_eq!(words, scenario.reported(), "{scenario:?}");
        }
    }
}
