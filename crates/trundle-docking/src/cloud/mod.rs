//! Questions about contact among very many points.
//!
//! Problem: a hundred thousand points, and a plan asks ten thousand questions. Idea: the points are in a tree of boxes; a box
//! that the hull's rough outline ([`HullProfile`]) cannot touch, or not before what is known already, is passed over whole. What
//! is left, some ten points a question, goes through the closed forms: the answers are those of all points, but for a ten-millionth, a hundredth of what motions back off by.

mod drive;
mod headings;
mod stand;
mod turn;

pub use drive::DriveQuestion;
pub use headings::{HeadingsQuestion, join};
pub use stand::StandQuestion;
pub use turn::TurnQuestion;

/// What is met later by less than this, m or rad, is no other contact: a wall that is met flat has thousands at once.
const SAME: f64 = 1e-7;

/// Fewer points than this are all asked.
pub const FEW: usize = 200;
