//! The position adjustment of \[Hong24\] (docs/methods.md B), as the paper has it: greedy, one turn and one straight at a time.
//!
//! Problem: settle on a pose in a corridor by turns on the spot and straight moves. Idea: put the lateral deviation right
//! with the turn and the straight that cost least, f = w1 t + w2 d; then take up the goal's heading and drive the
//! longitudinal one; then turn the rest. Cost: turn samples times straight samples a decision. Contact is tested at the
//! samples only, as in the paper. It rests between two samples, so that it may be done in parts (`pace`).
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | w1, w2 | `time_weight`, `lateral_weight` | 1/s, 1/m |
//! | AB, AC, AD | the straight of `reach`, its free part, the part to the least lateral deviation | m |
//! | t, d | the candidate's time, the lateral deviation at D | s, m |

mod config;
mod decide;

pub use config::PaperConfig;
pub use decide::{Decision, PaperMethod};

use crate::limits::MotionLimits;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::space::Space;
use trundle_core::Pose2;

/// Repeats the method's decisions, each carried out exactly, until it is settled or gives up (`None`).
pub async fn plan(
    space: &Space<'_>,
    start: Pose2,
    goal: Pose2,
    limits: &MotionLimits,
    config: &PaperConfig,
) -> Option<Manoeuvre> {
    let method = PaperMethod { space, limits: *limits, config };
    let (mut pose, mut motions, mut recoveries) = (start, Vec::new(), 0);
    while motions.len() < config.most_motions {
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
