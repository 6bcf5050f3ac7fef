//! Position of a corner between the pixels.

use super::corner::Corner;

/// Position of the maximum score, px from the `corner`, at most half a pixel in each direction: the tops of parabolas through the three
/// columns and the three rows around it, with weights 1, 2, 1. The position is twice as exact as the pixel, and better than with the
/// corner's row and column alone (docs/algorithms/orb.md).
///
/// `scores` are those of the corner's level, `width` px per row; the corner is not at the border.
pub(crate) fn offset(scores: &[u8], width: usize, corner: Corner) -> (f32, f32) {
    let first = (usize::from(corner.y) - 1) * width + usize::from(corner.x) - 1;
    let rows = [0, 1, 2].map(|row| &scores[first + row * width..][..3]);
    let weigh = |a: u8, b: u8, c: u8| i32::from(a) + 2 * i32::from(b) + i32::from(c);
    let column = |x: usize| weigh(rows[0][x], rows[1][x], rows[2][x]);
    let row = |y: usize| weigh(rows[y][0], rows[y][1], rows[y][2]);
    (top([0, 1, 2].map(column)), top([0, 1, 2].map(row)))
}

/// Position of the maximum of the parabola through the values at -1, 0 and 1, at most 0.5 from the middle; 0 without a maximum.
fn top([before, middle, after]: [i32; 3]) -> f32 {
    let bend = 2 * middle - before - after;
    if bend <= 0 {
        return 0.0;
    }
    ((after - before) as f32 / (2 * bend) as f32).clamp(-0.5, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_of_a_parabola_is_found() {
        for tenths in -5..=5 {
            let value = |x: i32| 1000 - (10 * x - tenths) * (10 * x - tenths);
            assert_eq!(top([-1, 0, 1].map(value)), tenths as f32 / 10.0);
        }
    }

    #[test]
    fn the_maximum_stays_within_the_pixel() {
        assert_eq!(top([0, 10, 10]), 0.5);
        assert_eq!(top([30, 10, 0]), 0.0);
        assert_eq!(top([21, 20, 0]), -0.5);
        assert_eq!(top([7, 7, 7]), 0.0);
    }

    #[test]
    fn the_maximum_moves_toward_the_higher_neighbours() {
        let corner = Corner { x: 1, y: 1, score: 40 };
        let (x, y) = offset(&[0, 10, 20, 0, 40, 30, 0, 0, 0], 3, corner);
        assert!(x > 0.2 && y < -0.1, "{x} {y}");
        assert_eq!(offset(&[9, 20, 9, 20, 40, 20, 9, 20, 9], 3, corner), (0.0, 0.0));
    }
}
