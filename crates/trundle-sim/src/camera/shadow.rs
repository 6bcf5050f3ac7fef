//! Depth shadows: pixels that the projector does not light.

/// Removes the depths of a row that are in the shadow of a projector to the right of the camera. `px_m` is focal length times their
/// distance, px m (negative: to the left).
///
/// In the projector's view, column u at depth z is at u - px_m / z. A surface is lit if no surface to its right (in the camera's image) is
/// farther left in the projector's view.
pub(super) fn cast_shadow(truth: &[f32], px_m: f32, reported: &mut [f32]) {
    let mut nearest = f32::INFINITY;
    let mut look = |column: usize, reported: &mut f32| {
        if truth[column] <= 0.0 {
            return;
        }
        let place = if px_m > 0.0 { column as f32 } else { -(column as f32) } - px_m.abs() / truth[column];
        // Half a pixel of tolerance: steep surfaces are lit.
        if place > nearest + 0.5 {
            *reported = 0.0;
        }
        nearest = nearest.min(place);
    };
    let columns = reported.iter_mut().enumerate();
    if px_m > 0.0 {
        columns.rev().for_each(|(column, reported)| look(column, reported));
    } else {
        columns.for_each(|(column, reported)| look(column, reported));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A post at 1 m over columns 50 to 59 before a wall at 4 m.
    fn post() -> Vec<f32> {
        (0..100).map(|x| if (50..60).contains(&x) { 1.0 } else { 4.0 }).collect()
    }

    #[test]
    fn the_shadow_is_as_wide_as_the_difference_of_disparities() {
        let truth = post();
        let mut reported = truth.clone();
        cast_shadow(&truth, 40.0, &mut reported);
        // 40 (1/1 - 1/4) = 30 px to the left of the post.
        let dark: Vec<usize> = (0..100).filter(|&x| reported[x] == 0.0).collect();
        assert_eq!((dark[0], dark[dark.len() - 1], dark.len()), (21, 49, 29));
        let mut reported = truth.clone();
        cast_shadow(&truth, -40.0, &mut reported);
        let dark: Vec<usize> = (0..100).filter(|&x| reported[x] == 0.0).collect();
        assert_eq!((dark[0], dark.len()), (60, 29));
    }

    #[test]
    fn planes_are_lit() {
        let truth: Vec<f32> = (0..100).map(|x| 1.0 / (0.2 + 0.004 * x as f32)).collect();
        for px_m in [40.0, -40.0] {
            let mut reported = truth.clone();
            cast_shadow(&truth, px_m, &mut reported);
            assert_eq!(reported, truth);
        }
    }
}
