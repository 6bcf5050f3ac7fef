//! Steps to the 16 nearest directions, with whole-numbered lengths: the unit of the search and its heuristic.
/// Length of a step to a side neighbour, in units of 1/256 of a cell's side. Source: ours.
pub(crate) const SIDE: u32 = 256;
/// Length of a diagonal step, in the same units. Source: 256 sqrt(2).
const DIAGONAL_STEP: u32 = 362;
/// Length of a knight's move, in the same units. Source: 256 sqrt(5).
const KNIGHT_STEP: u32 = 572;

/// Columns and rows of each step: sides, diagonals, knight's moves. 16 directions make a path at most 2.8 % longer than a straight
/// line, 8 directions 8.2 %. Source: ours.
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
        4..8 => DIAGONAL_STEP,
        _ => KNIGHT_STEP,
    }
}

/// The longest step.
pub(crate) const LONGEST_STEP: u32 = KNIGHT_STEP;

/// The length of the shortest path by these steps over `(x, y)` free cells.
pub(crate) fn between((x, y): (u32, u32)) -> u32 {
    let (long, short) = (x.max(y), x.min(y));
    if long >= 2 * short {
        KNIGHT_STEP * short + SIDE * (long - 2 * short)
    } else {
        KNIGHT_STEP * (long - short) + DIAGONAL_STEP * (2 * short - long)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattice_paths_are_nearly_straight_and_never_shorter() {
        for x in 0..40 {
            for y in 0..40 {
                let straight = f64::from(x * x + y * y).sqrt() * f64::from(SIDE);
                let ratio = f64::from(between((x, y))) / straight.max(1.0);
                assert!(ratio < 1.028 && (ratio > 0.999 || x + y == 0), "{x} {y}: {ratio}");
            }
        }
    }
}
