//! Convex polygons: depth of a point, inscribed disc, inset.

use trundle_core::Vector2;

/// The sides of a polygon, from corner to corner.
pub fn sides(corners: &[Vector2]) -> impl Iterator<Item = (Vector2, Vector2)> + '_ {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// Depth of a point inside a convex polygon, m; negative outside.
pub fn depth_within(corners: &[Vector2], point: Vector2) -> f64 {
    let to_side = |(a, b): (Vector2, Vector2)| (b - a).perp(&(point - a)) / (b - a).norm();
    sides(corners).map(to_side).fold(f64::INFINITY, f64::min)
}

/// Centre and radius of the largest disc in a convex polygon. The depth is concave: a grid search around the maximum, refined, finds it.
pub fn inscribed_disc(corners: &[Vector2]) -> (Vector2, f64) {
    const ROUNDS: usize = 12;
    const SAMPLES: i32 = 4;
    let mut best = (centre_of(corners), depth_within(corners, centre_of(corners)));
    let mut reach = corners.iter().map(|c| (c - best.0).norm()).fold(0.0, f64::max);
    for _ in 0..ROUNDS {
        let around = best.0;
        for (i, j) in (-SAMPLES..=SAMPLES).flat_map(|i| (-SAMPLES..=SAMPLES).map(move |j| (i, j))) {
            let at = around + Vector2::new(f64::from(i), f64::from(j)) * (reach / f64::from(SAMPLES));
            let depth = depth_within(corners, at);
            if depth > best.1 {
                best = (at, depth);
            }
        }
        reach /= 2.0;
    }
    best
}

/// The mean of the points.
pub fn centre_of(points: &[Vector2]) -> Vector2 {
    points.iter().sum::<Vector2>() / points.len() as f64
}

/// The polygon with its sides moved inwards by `by` m; `None` if no area remains, or a side vanishes.
pub fn inset(corners: &[Vector2], by: f64) -> Option<Vec<Vector2>> {
    let count = corners.len();
    let side = |i: usize| (corners[(i + 1) % count] - corners[i % count]).try_normalize(1e-12);
    let corner = |i: usize| {
        let (before, after) = (side(i + count - 1)?, side(i)?);
        let inward = |along: Vector2| Vector2::new(-along.y, along.x);
        let sum = inward(before) + inward(after);
        let opening = 1.0 + before.dot(&after);
        (opening > 1e-6).then(|| corners[i] + sum * (by / opening))
    };
    let moved: Vec<Vector2> = (0..count).map(corner).collect::<Option<_>>()?;
    let is_valid =
        (0..count).all(|i| (moved[(i + 1) % count] - moved[i]).dot(&(side(i).unwrap_or_default())) > 0.0);
    is_valid.then_some(moved)
}
