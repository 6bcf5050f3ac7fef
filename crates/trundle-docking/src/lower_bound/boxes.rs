//! Squares of a quadtree over the turning positions of the robot.

use trundle_core::Vector2;

/// A square of a quadtree: `level` halvings of the region; `x`, `y` are its column and row among the squares of its level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Square {
    pub level: u8,
    pub x: u16,
    pub y: u16,
}

impl Square {
    /// The whole region.
    pub const ALL: Self = Self { level: 0, x: 0, y: 0 };

    /// The four quarters of the square.
    pub fn quarters(self) -> [Self; 4] {
        let at = |x, y| Self { level: self.level + 1, x: 2 * self.x + x, y: 2 * self.y + y };
        [at(0, 0), at(1, 0), at(0, 1), at(1, 1)]
    }
}

/// The region that the squares divide.
#[derive(Debug, Clone, Copy)]
pub struct Region {
    pub center: Vector2,
    /// Half the side of the whole, m.
    pub half: f64,
}

/// A position within `half` (m) of `center` along both axes.
#[derive(Debug, Clone, Copy)]
pub struct PositionBox {
    pub center: Vector2,
    pub half: f64,
}

impl Region {
    /// The positions of a square.
    pub fn place(&self, square: Square) -> PositionBox {
        let half = self.half / f64::from(1_u32 << square.level);
        let along = |i: u16| (2.0 * f64::from(i) + 1.0) * half - self.half;
        PositionBox { center: self.center + Vector2::new(along(square.x), along(square.y)), half }
    }
}

impl PositionBox {
    /// An exact position.
    pub fn exactly(p: Vector2) -> Self {
        Self { center: p, half: 0.0 }
    }

    /// Largest distance of a position from the centre, m.
    pub fn radius(&self) -> f64 {
        self.half * std::f64::consts::SQRT_2
    }
}
