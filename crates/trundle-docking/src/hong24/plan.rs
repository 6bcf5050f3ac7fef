//! The position adjustment of \[Hong24\] (docs/methods.md B), as in the paper: greedy, alternating one turn and one straight move.
//!
//! Problem: reach a pose in a corridor by turns in place and straight moves. Idea: correct the lateral deviation by the turn and the
//! straight move of minimum cost f = w1 t + w2 d. Then turn to the goal's heading and correct the longitudinal deviation; then correct the
//! heading. Cost: turn samples times straight samples per decision. Contact is tested at the samples only, as in the paper. The search may
//! yield between two samples.
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | w1, w2 | `time_weight`, `lateral_weight` | 1/s, 1/m |
//! | AB, AC, AD | the straight of `reach`, its free part, the part to the minimum lateral deviation | m |
//! | t, d | the candidate's time, the lateral deviation at D | s, m |

use crate::contact_space::ContactSpace;
use crate::hong24::config::Hong24Config;
use crate::hong24::decide::{Decision, Hong24Method};
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::{Manoeuvre, Motion};
use trundle_core::Pose2;

/// Repeats the method's decisions, each carried out exactly, until the goal is reached or the method fails (`None`).
pub async fn plan(
    space: &ContactSpace<'_>,
    start: Pose2,
    goal: Pose2,
    limits: &MotionLimits,
    config: &Hong24Config,
) -> Option<Manoeuvre> {
    let method = Hong24Method { space, limits: *limits, config };
    let (mut pose, mut motions, mut recoveries) = (start, Vec::new(), 0);
    while motions.len() < config.max_motions {
        let next: Vec<Motion> = match method.decide(&pose, &goal, recoveries).await {
            Decision::Settled => return Some(Manoeuvre::new(start, &motions, *limits)),
            Decision::Move(next) => next,
            Decision::Recover(next) => {
                recoveries += 1;
                vec![next]
            }
            Decision::Stuck => return None,
        };
        for motion in next {
            pose = motion.after(pose, motion.amount());
            motions.push(motion);
        }
    }
    None
}
