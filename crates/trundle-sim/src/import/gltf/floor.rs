//! The height of a scene's floor: its lowest large level.

use crate::world::Triangle;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Height of a level \[m\]. Surfaces that differ by less are one level. Source: ours.
const LEVEL_HEIGHT_M: f64 = 0.1;
/// Angle between a surface and the horizontal \[deg\]. A steeper surface is not floor. Source: ours.
const MAX_SLOPE_DEG: f64 = 15.0;
/// Share of the largest level's area that makes a level a floor. Source: ours.
const MIN_FLOOR_SHARE: f64 = 0.3;
/// Distance from z = 0 within which a level is at z = 0 \[m\]. Source: ours.
const MAX_DISTANCE_FROM_ZERO_M: f64 = 0.15;

/// The height of the floor if it is not at z = 0, world frame, m; `None` if it is, or without a level surface.
pub(super) fn floor_elsewhere(positions: &[[f32; 3]], triangles: &[Triangle]) -> Option<f64> {
    let levels = levels(positions, triangles);
    let largest = levels.values().map(|level| level.area).fold(0.0, f64::max);
    let at_zero = |level: &&Level| level.height().abs() <= MAX_DISTANCE_FROM_ZERO_M;
    let area_at_zero: f64 = levels.values().filter(at_zero).map(|level| level.area).sum();
    if area_at_zero >= MIN_FLOOR_SHARE * largest {
        return None;
    }
    let floor = levels.values().find(|level| level.area >= MIN_FLOOR_SHARE * largest)?;
    Some((floor.height() * 1e4).round() / 1e4)
}

/// Horizontal surfaces of one height.
#[derive(Debug, Clone, Copy, Default)]
struct Level {
    /// m^2.
    area: f64,
    /// Area times height, m^3.
    moment: f64,
}

impl Level {
    fn height(&self) -> f64 {
        self.moment / self.area
    }
}

/// The horizontal surfaces by height, the lowest first.
fn levels(positions: &[[f32; 3]], triangles: &[Triangle]) -> BTreeMap<i64, Level> {
    let mut levels: BTreeMap<i64, Level> = BTreeMap::new();
    for triangle in triangles {
        let [a, b, c] =
            triangle.corners.map(|corner| Vector3::from(positions[corner as usize].map(f64::from)));
        let normal = (b - a).cross(&(c - a));
        let area = normal.norm() / 2.0;
        if normal.z.abs() < 2.0 * area * MAX_SLOPE_DEG.to_radians().cos() {
            continue;
        }
        let height = (a.z + b.z + c.z) / 3.0;
        let level = levels.entry((height / LEVEL_HEIGHT_M).round() as i64).or_default();
        level.area += area;
        level.moment += area * height;
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of a side and a height, m.
    fn scene(squares: &[(f32, f32)]) -> Option<f64> {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for (side, z) in squares {
            let first = positions.len() as u32;
            positions.extend([[0.0, 0.0, *z], [*side, 0.0, *z], [*side, *side, *z], [0.0, *side, *z]]);
            for corners in [[0, 1, 2], [0, 2, 3]] {
                triangles.push(Triangle { corners: corners.map(|c| c + first), material: 0 });
            }
        }
        floor_elsewhere(&positions, &triangles)
    }

    #[test]
    fn the_lowest_large_level_is_the_floor() {
        assert_eq!(scene(&[(4.0, -10.0), (4.0, -7.5), (1.0, -9.3)]), Some(-10.0));
        assert_eq!(scene(&[(4.0, 1.5), (1.0, 0.9)]), Some(1.5), "a small step lies below the floor");
        assert_eq!(scene(&[(4.0, 0.05), (4.0, 2.5)]), None);
        assert_eq!(scene(&[(4.0, 0.0), (5.0, -3.0)]), None, "a cellar leaves the ground floor where it is");
        assert_eq!(scene(&[(4.0, -0.75), (1.2, 0.0)]), Some(-0.75), "a table top at zero is not floor");
        assert_eq!(scene(&[]), None);
    }
}
