//! Least squares over a chain of states with a border of slow ones: an arrow-shaped system.
//!
//! Problem: a window of states, each coupled with the next one and all with a few common parameters. Its normal equations are block
//! tridiagonal with a dense border. Idea: a Cholesky factorisation from the oldest block to the newest, then of the border. It fills
//! nothing. The marginal covariance of a block with the border follows by the recursion of Takahashi from the newest block backwards.
//! Cost for K blocks of size N and a border of size B: O(K (N^3 + N^2 B + N B^2) + B^3). No step allocates.

mod covariance;
mod factor;
mod marginal;
mod solver;
mod system;
#[cfg(test)]
mod tests;

pub use covariance::ArrowCovariance;
pub use marginal::ArrowMarginal;
pub use system::ArrowSystem;
