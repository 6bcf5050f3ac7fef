//! Which poses hang together: the free headings over every cell of a grid of positions.
//!
//! Problem: show that *no* motion whatever leads from one pose to another. Idea: over a cell of side e, shrink the hull by
//! the cell's half diagonal. What the true hull can do anywhere in the cell, the shrunk one can do at its centre; its free
//! headings there come in closed form. Cells side by side are joined where their free headings meet. Where start and goal
//! are not joined, there is no motion, of whatever kind. Cost: cells that can be reached, times the pieces near them.

mod columns;
mod guide;
mod proof;

pub use guide::Guide;
pub use proof::{Ground, Proof, disprove};
