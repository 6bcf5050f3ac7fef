use super::{
    mask::Mask,
    tile::{TILE_BITS, TILE_SIDE},
};

/// The cells from a point up to, but without, the cell of another: one for each step along the longer axis, the one
/// that the line passes at the middle of that column or row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    major: i32,
    /// 32.32 fixed point.
    minor: i64,
    step: i32,
    slope: i64,
    steep: bool,
    pub(super) left: i64,
}

impl Ray {
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

    /// How many steps there are until the longer axis leaves its tile, or the ray ends.
    #[inline]
    fn steps_in_tile(&self) -> i64 {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        let within = self.major & MASK;
        self.left.min(i64::from(if self.step > 0 { MASK - within + 1 } else { within + 1 }))
    }

    #[inline]
    fn tile(&self) -> (i32, i32) {
        let (x, y) = self.cell();
        (x >> TILE_BITS, y >> TILE_BITS)
    }

    #[inline]
    pub(super) fn advance(&mut self) {
        self.major += self.step;
        self.minor += self.slope;
        self.left -= 1;
    }
}

impl Ray {
    /// Sets the bits of its cells, which are covered.
    pub(super) fn mark(self, mask: &mut Mask) {
        if self.steep { self.mark_along::<true>(mask) } else { self.mark_along::<false>(mask) }
    }

    fn mark_along<const STEEP: bool>(mut self, mask: &mut Mask) {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        while self.left > 0 {
            let rows = mask.tile(self.tile());
            let minor_tile = (self.minor >> 32) as i32 >> TILE_BITS;
            let (mut major, mut minor, mut steps) = (self.major, self.minor, 0);
            // Cells of one row beside each other are gathered in a register.
            let (mut row, mut word) = (((self.minor >> 32) as i32 & MASK) as usize, 0_u32);
            for _ in 0..self.steps_in_tile() {
                let at = (minor >> 32) as i32;
                if at >> TILE_BITS != minor_tile {
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
