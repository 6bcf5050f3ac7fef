//! Questions about contact among very many points.
//!
//! Problem: a hundred thousand points, and a plan asks ten thousand questions. Idea: the points are in a tree of discs; a disc
//! that the hull's rough outline ([`crate::geometry::Profile`]) cannot touch, or not before what is known already, is passed over whole. What
//! is left, some ten points a question, goes through the closed forms: the answers are those of all points, exactly.

mod drive;
mod headings;
mod stand;
mod turn;

pub use drive::DriveQuestion;
pub use headings::{HeadingsQuestion, join};
pub use stand::StandQuestion;
pub use turn::TurnQuestion;

/// Fewer points than this are all asked.
pub const FEW: usize = 200;
