//! Clipping of polylines to a rectangle: the rasteriser receives only finite, moderate numbers.

use trundle_core::Hypotenuse;

/// A place in a picture: pixels from the left, pixels from the top.
pub(crate) type Px = (f64, f64);

/// Distance of a point from the last selected one below which it is skipped, px. Source: ours.
const INVISIBLE_STEP: f64 = 0.2;

/// The parts of a polyline within `margin` px of a `width` x `height` picture. A point that is not finite cuts the polyline.
pub(crate) fn visible_runs(
    points: impl IntoIterator<Item = Px>,
    size: (f64, f64),
    margin: f64,
) -> Vec<Vec<Px>> {
    let mut runs: Vec<Vec<Px>> = Vec::new();
    let mut last: Option<Px> = None;
    let mut open = false;
    for point in points {
        if !(point.0.is_finite() && point.1.is_finite()) {
            (last, open) = (None, false);
            continue;
        }
        let Some(from) = last else {
            last = Some(point);
            continue;
        };
        if distance(from, point) < INVISIBLE_STEP {
            continue;
        }
        last = Some(point);
        let Some((a, b)) = clip(from, point, size, margin) else {
            open = false;
            continue;
        };
        match runs.last_mut().filter(|_| open && a == from) {
            Some(run) => run.push(b),
            None => runs.push(vec![a, b]),
        }
        open = b == point;
    }
    runs
}

fn distance(a: Px, b: Px) -> f64 {
    (a.0 - b.0).hypotenuse(a.1 - b.1)
}

/// The part of a segment inside the rectangle (Liang and Barsky 1984).
fn clip(a: Px, b: Px, size: (f64, f64), margin: f64) -> Option<(Px, Px)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if !(dx.is_finite() && dy.is_finite()) {
        return None;
    }
    let sides =
        [(-dx, a.0 + margin), (dx, size.0 + margin - a.0), (-dy, a.1 + margin), (dy, size.1 + margin - a.1)];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (along, room) in sides {
        if along == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if along < 0.0 {
            enter = enter.max(room / along);
        } else {
            leave = leave.min(room / along);
        }
    }
    // Rounding may leave an end far outside if the other end is extremely distant: both are clamped.
    let held = |v: f64, side: f64| v.clamp(-margin, side + margin);
    let hold = |p: Px| (held(p.0, size.0), held(p.1, size.1));
    let at = |t: f64| (a.0 + dx * t, a.1 + dy * t);
    let ends = (if enter > 0.0 { at(enter) } else { a }, if leave < 1.0 { at(leave) } else { b });
    (enter <= leave).then(|| (hold(ends.0), hold(ends.1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (f64, f64) = (10.0, 10.0);

    #[test]
    fn a_line_through_the_picture_is_cut_at_both_sides() {
        let runs = visible_runs([(-1e6, 5.0), (1e6, 5.0)], SIZE, 0.0);
        assert_eq!(runs.len(), 1);
        assert!((runs[0][0].0 - 0.0).abs() < 1e-6 && (runs[0][1].0 - 10.0).abs() < 1e-6);
    }

    #[test]
    fn runs_break_outside_and_at_nan() {
        let inside = [(1.0, 1.0), (2.0, 2.0), (3.0, 1.0)];
        assert_eq!(visible_runs(inside, SIZE, 0.0), vec![inside.to_vec()]);
        let with_hole = [(1.0, 1.0), (2.0, 2.0), (f64::NAN, 0.0), (3.0, 1.0), (4.0, 1.0)];
        assert_eq!(visible_runs(with_hole, SIZE, 0.0).len(), 2);
        let out_and_back = [(1.0, 1.0), (1.0, 50.0), (2.0, 50.0), (2.0, 1.0)];
        assert_eq!(visible_runs(out_and_back, SIZE, 0.0).len(), 2);
        assert!(visible_runs([(20.0, 20.0), (30.0, 20.0)], SIZE, 1.0).is_empty());
    }

    #[test]
    fn rounding_of_far_ends_stays_in_the_picture() {
        for far in [1e18, 1e34, 2.8e265] {
            for run in
                visible_runs([(-far, 3.0), (far, 5.0), (2.0, -far), (2.0, -1e9), (far, far)], SIZE, 1.0)
            {
                assert!(run.iter().all(|p| p.0.abs() <= 11.0 && p.1.abs() <= 11.0), "{run:?}");
            }
        }
    }

    #[test]
    fn standing_still_costs_nothing() {
        let still = (0..1000).map(|i| (5.0 + f64::from(i) * 1e-5, 5.0)).chain([(8.0, 5.0)]);
        assert_eq!(visible_runs(still, SIZE, 0.0)[0].len(), 2);
    }
}
