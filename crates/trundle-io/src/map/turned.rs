//! Rotated pictures, resampled on a lattice along the map's axes.

use std::f64::consts::FRAC_PI_2;
use trundle_core::{GridGeometry, Invalid, Vector2};

/// Samples along a cell's side. Source: ours.
const SAMPLES_PER_SIDE: usize = 3;
/// Largest turn of a map that counts as no turn, rad: 1 um at 10 km. Source: ours.
const MAX_STRAIGHT_TURN_RAD: f64 = 1e-10;
/// Largest distance of a map's yaw from a right angle at which its cells are still copied one to one \[rad\]: 1 mm at 100 m. Source: ours.
const MAX_COPIED_TURN_RAD: f64 = 1e-5;

/// Whether a picture with this yaw is resampled, so that its walls may become thicker.
pub(super) fn is_resampled(yaw: f64) -> bool {
    let quarters = yaw / FRAC_PI_2;
    ((quarters - quarters.round()) * FRAC_PI_2).abs() > MAX_COPIED_TURN_RAD
}

/// The values of a picture with this geometry, rotated by `yaw` rad around its origin, on cells along the axes with the same resolution. A
/// new cell gets the value that is first by `rank` among those it touches: walls remain closed, and become up to a cell thicker. Cells
/// outside the picture have the value `beyond`.
///
/// # Errors
/// When the new grid would have too many cells.
pub(super) fn straightened<T: Copy>(
    geometry: GridGeometry,
    values: Vec<T>,
    yaw: f64,
    beyond: T,
    rank: impl Fn(T) -> u8,
) -> Result<(GridGeometry, Vec<T>), Invalid> {
    if yaw.abs() < MAX_STRAIGHT_TURN_RAD {
        return Ok((geometry, values));
    }
    let GridGeometry { resolution, origin, width, height } = geometry;
    let (sin, cos) = yaw.sin_cos();
    let turned = |p: Vector2| Vector2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
    let side = Vector2::new(width as f64, height as f64) * resolution;
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
        .map(|(x, y)| turned(Vector2::new(x * side.x, y * side.y)) / resolution);
    // A right angle leaves the lattice unchanged.
    let low = corners.iter().fold(corners[0], |low, c| low.inf(c)).map(|c| (c + 1e-6).floor());
    let high = corners.iter().fold(corners[0], |high, c| high.sup(c)).map(|c| (c - 1e-6).ceil());
    let size = high - low;
    let new = GridGeometry::new(resolution, origin + low * resolution, size.x as usize, size.y as usize)?;
    let picture = GridGeometry { origin: Vector2::zeros(), ..geometry };
    let value = |linear: usize| {
        let cell = new.cell(linear);
        let samples = (0..SAMPLES_PER_SIDE * SAMPLES_PER_SIDE).filter_map(|k| {
            let part = |k: usize| (k as f64 + 0.5) / SAMPLES_PER_SIDE as f64;
            let at = Vector2::new(
                cell.col as f64 + part(k % SAMPLES_PER_SIDE),
                cell.row as f64 + part(k / SAMPLES_PER_SIDE),
            );
            let at = (low + at) * resolution;
            let back = Vector2::new(cos * at.x + sin * at.y, cos * at.y - sin * at.x);
            picture.cell_at(back).map(|cell| values[picture.linear(cell)])
        });
        samples.min_by_key(|value| rank(*value)).unwrap_or(beyond)
    };
    Ok((new, (0..new.len()).map(value).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn letter(yaw: f64) -> (GridGeometry, Vec<u8>) {
        // 2 1 1
        // 1 1 0, the first row the lowest.
        let geometry = GridGeometry::new(0.5, Vector2::new(1.0, 2.0), 3, 2).unwrap();
        straightened(geometry, vec![1, 1, 0, 2, 1, 1], yaw, 9, |value| value).unwrap()
    }

    #[test]
    fn right_angles_lose_nothing() {
        assert_eq!(letter(0.0).1, [1, 1, 0, 2, 1, 1]);
        let (geometry, values) = letter(std::f64::consts::FRAC_PI_2);
        assert_eq!((geometry.width, geometry.height, geometry.origin), (2, 3, Vector2::new(0.0, 2.0)));
        assert_eq!(values, [2, 1, 1, 1, 1, 0]);
        let (geometry, values) = letter(-std::f64::consts::PI);
        assert!((geometry.origin - Vector2::new(-0.5, 1.0)).norm() < 1e-9);
        assert_eq!(values, [1, 1, 2, 0, 1, 1]);
    }

    #[test]
    fn a_thin_wall_stays_closed_at_any_angle() {
        let geometry = GridGeometry::new(0.1, Vector2::zeros(), 41, 41).unwrap();
        let wall: Vec<u8> = (0..geometry.len()).map(|i| u8::from(i % 41 != 20)).collect();
        for k in 1..30 {
            let yaw = f64::from(k) * 0.21 - 3.0;
            let (new, values) = straightened(geometry, wall.clone(), yaw, 9, |value| value).unwrap();
            // Across the wall in the picture's frame, on a line between the samples.
            let (sin, cos) = yaw.sin_cos();
            let meets = (0..=4000).any(|i| {
                let (x, y) = (f64::from(i) * 1e-3 + 0.05, 2.03);
                let at = Vector2::new(cos * x - sin * y, sin * x + cos * y);
                new.cell_at(at).is_some_and(|cell| values[new.linear(cell)] == 0)
            });
            assert!(meets, "{yaw}");
        }
    }
}
