//! The paints of a solid.

use super::kind::Paint;

/// The paints of a solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Finish {
    /// Of a box: its faces +x, -x, +y, -y, top, bottom in its own frame. Of a cylinder: its side is the first, top and
    /// bottom the last two.
    pub faces: [Paint; 6],
    /// Seed of the paintings. `None`: from the solid's index in the world's list, so that no two solids are equal. Solids of one world with
    /// the same seed, size and paints are exactly equal.
    pub seed: Option<u64>,
}

impl Finish {
    /// The same paint all over (every face still gets a painting of its own).
    pub fn all(paint: Paint) -> Self {
        Self { faces: [paint; 6], seed: None }
    }

    /// The same paints, drawn from `seed`.
    pub fn seeded(self, seed: u64) -> Self {
        Self { seed: Some(seed), ..self }
    }
}
