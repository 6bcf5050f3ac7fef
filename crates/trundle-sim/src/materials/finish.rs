//! The paints of a solid.

use super::kind::Paint;

/// The paints of a solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Finish {
    /// For a box: faces +x, -x, +y, -y, top, bottom in its own frame. For a cylinder: its side is the first, top and bottom are the last
    /// two.
    pub faces: [Paint; 6],
    /// Seed of the paintings. `None`: derived from the solid's index in the world's list, which makes all solids different. Solids of one
    /// world with the same seed, size and paints are exactly equal.
    pub seed: Option<u64>,
}

impl Finish {
    /// The same paint on all faces; every face still has a separate painting.
    pub fn all(paint: Paint) -> Self {
        Self { faces: [paint; 6], seed: None }
    }

    /// The same paints, drawn from `seed`.
    pub fn seeded(self, seed: u64) -> Self {
        Self { seed: Some(seed), ..self }
    }
}
