//! Least squares over a chain of states with a border of common states: an arrow-shaped system.
//!
//! Problem: a window of states; each state couples with the next one and with a few common parameters. Its normal equations are block
//! tridiagonal with a dense border. Idea: a Cholesky factorisation from the oldest block to the newest, then of the border. The factor has
//! no additional non-zero blocks. The marginal covariance of a block with the border follows by the recursion of Takahashi from the newest
//! block backwards. Cost for K blocks of size N and a border of size B: O(K (N^3 + N^2 B + N B^2) + B^3). No step allocates.

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
