//! Approximate traversal of a line that sets bits of a mask, one cell for each step along the longer axis.

use super::{cell_mask::CellMask, tile::Tile};

/// Cells from a start point up to, but without, the cell of the end point.
///
/// Each step along the longer axis gives one cell: the cell on the line at the centre of that column or row. A line through the corner of a
/// cell does not clear that cell; [`crate::ray_cells`] gives those cells too.
#[derive(Debug, Clone, Copy)]
pub(super) struct SteppedRay {
    /// Cell along the longer axis.
    major: i32,
    /// Coordinate along the shorter axis, 32.32 fixed point.
    minor: i64,
    step: i32,
    slope: i64,
    steep: bool,
    /// Steps to go.
    pub(super) left: i64,
}

impl SteppedRay {
    pub(super) fn new(from: (f64, f64), to: (f64, f64)) -> Self {
        const ONE: f64 = 4_294_967_296.0;
        let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
        let along = |p: (f64, f64)| if steep { (p.1, p.0) } else { p };
        let ((a0, b0), (a1, b1)) = (along(from), along(to));
        let (start, end) = (a0.floor(), a1.floor());
        let sign = if a1 >= a0 { 1.0 } else { -1.0 };
        let slope = if a1 == a0 { 0.0 } else { (b1 - b0) / (a1 - a0).abs() };
        let to_middle = (start + 0.5 - a0) * sign;
        Self {
            major: start as i32,
            minor: ((b0 + slope * to_middle) * ONE) as i64,
            step: sign as i32,
            slope: (slope * ONE) as i64,
            steep,
            left: (end - start).abs() as i64,
        }
    }

    #[inline]
    pub(super) fn cell(&self) -> (i32, i32) {
        let minor = (self.minor >> 32) as i32;
        if self.steep { (minor, self.major) } else { (self.major, minor) }
    }

    /// Steps until the longer axis leaves its tile, or the ray ends.
    #[inline]
    fn steps_in_tile(&self) -> i64 {
        const MASK: i32 = Tile::SIDE as i32 - 1;
        let within = self.major & MASK;
        self.left.min(i64::from(if self.step > 0 { MASK - within + 1 } else { within + 1 }))
    }

    #[inline]
    fn tile(&self) -> (i32, i32) {
        let (x, y) = self.cell();
        (x >> Tile::BITS, y >> Tile::BITS)
    }

    #[inline]
    pub(super) fn advance(&mut self) {
        self.major += self.step;
        self.minor += self.slope;
        self.left -= 1;
    }
}

impl SteppedRay {
    /// Sets the bits of the ray's cells. The mask must cover them.
    pub(super) fn mark(self, mask: &mut CellMask) {
        if self.steep { self.mark_along::<true>(mask) } else { self.mark_along::<false>(mask) }
    }

    fn mark_along<const STEEP: bool>(mut self, mask: &mut CellMask) {
        const MASK: i32 = Tile::SIDE as i32 - 1;
        while self.left > 0 {
            let rows = mask.tile(self.tile());
            let minor_tile = (self.minor >> 32) as i32 >> Tile::BITS;
            let (mut major, mut minor, mut steps) = (self.major, self.minor, 0);
            // Successive cells of one row are gathered in a register.
            let (mut row, mut word) = (((self.minor >> 32) as i32 & MASK) as usize, 0_u32);
            for _ in 0..self.steps_in_tile() {
                let at = (minor >> 32) as i32;
                if at >> Tile::BITS != minor_tile {
                    break;
                }
                if STEEP {
                    rows[(major & MASK) as usize] |= 1 << (at & MASK);
                } else {
                    let here = (at & MASK) as usize;
                    if here != row {
                        rows[row] |= word;
                        (row, word) = (here, 0);
                    }
                    word |= 1 << (major & MASK);
                }
                major += self.step;
                minor += self.slope;
                steps += 1;
            }
            if !STEEP {
                rows[row] |= word;
            }
            (self.major, self.minor, self.left) = (major, minor, self.left - steps);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        /// The mask contains exactly the cells of the stepwise traversal, and each is within half a cell of the line.
        #[test]
        fn the_mask_holds_the_cells_of_the_steps(
            x in -90.0..90.0_f64, y in -90.0..90.0_f64, u in -90.0..90.0_f64, v in -90.0..90.0_f64,
        ) {
            let mut mask = CellMask::default();
            mask.cover((-100, -100), (100, 100));
            SteppedRay::new((x, y), (u, v)).mark(&mut mask);
            let mut ray = SteppedRay::new((x, y), (u, v));
            let mut steps = BTreeSet::new();
            while ray.left > 0 {
                steps.insert(ray.cell());
                ray.advance();
            }
            let mut found = BTreeSet::new();
            let copy = mask.clone();
            for (at, rows, _) in mask.touched_with(&copy) {
                for (row, col) in (0..32).flat_map(|row| (0..32).map(move |col| (row, col))) {
                    if rows[row as usize] >> col & 1 == 1 {
                        found.insert(((at.0 << 5) + col, (at.1 << 5) + row));
                    }
                }
            }
            prop_assert_eq!(&found, &steps);
            let (dx, dy) = (u - x, v - y);
            for (cx, cy) in found {
                let (ox, oy) = (f64::from(cx) + 0.5 - x, f64::from(cy) + 0.5 - y);
                let off = if dy.abs() > dx.abs() { ox - dx / dy * oy } else { oy - dy / dx * ox };
                prop_assert!(off.abs() < 0.5 + 1e-6, "cell ({cx}, {cy}) lies {off} cells from the line");
            }
            prop_assert!(!steps.contains(&(u.floor() as i32, v.floor() as i32)), "the end cell is left out");
        }
    }
}
