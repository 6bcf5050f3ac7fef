//! Steps to the 16 nearest directions, in whole numbers: what the wave and its guide count in.

/// The cost of a cell's side, of its diagonal, and of a knight's move, where a metre costs 1.
pub(crate) const SIDE: u32 = 256;
const DIAGONAL: u32 = 362;
const KNIGHT: u32 = 572;

/// Columns and rows of each step: sides, diagonals, knight's moves. The 16 directions make a way at most 2.8 % longer
/// than its straight pieces, the 8 nearest ones 8.2 %.
pub(crate) const STEPS: [(i32, i32); 16] = [
    (1, 0),
    (-1, 0),
    (0, 1),
    (0, -1),
    (1, 1),
    (1, -1),
    (-1, 1),
    (-1, -1),
    (2, 1),
    (2, -1),
    (-2, 1),
    (-2, -1),
    (1, 2),
    (1, -2),
    (-1, 2),
    (-1, -2),
];

/// The length of a step.
pub(crate) const fn length(step: usize) -> u32 {
    match step {
        0..4 => SIDE,
        4..8 => DIAGONAL,
        _ => KNIGHT,
    }
}

/// The longest step.
pub(crate) const LONGEST: u32 = KNIGHT;

/// The length of the shortest way by these steps over `(x, y)` cells, were all free.
pub(crate) fn between((x, y): (u32, u32)) -> u32 {
    let (long, short) = (x.max(y), x.min(y));
    if long >= 2 * short {
        KNIGHT * short + SIDE * (long - 2 * short)
    } else {
        KNIGHT * (long - short) + DIAGONAL * (2 * short - long)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_nearly_straight_and_never_shorter() {
        for x in 0..40 {
            for y in 0..40 {
                let straight = f64::from(x * x + y * y).sqrt() * f64::from(SIDE);
                let ratio = f64::from(between((x, y))) / straight.max(1.0);
                assert!(ratio < 1.028 && (ratio > 0.999 || x + y == 0), "{x} {y}: {ratio}");
            }
        }
    }
}
