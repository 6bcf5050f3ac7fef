//! The place of a map in its frame, for messages about what lies beside it.

use trundle_core::GridGeometry;

/// The place of a map in its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapExtent {
    /// First and last coordinate along x and along y, m.
    spans: [(f64, f64); 2],
}

impl MapExtent {
    /// The place of this grid.
    #[must_use]
    pub fn of(grid: &GridGeometry) -> Self {
        let spans = [(grid.origin.x, grid.width), (grid.origin.y, grid.height)];
        Self { spans: spans.map(|(begin, cells)| (begin, begin + cells as f64 * grid.resolution)) }
    }

    /// Whether a point \[m\] is on the map.
    #[must_use]
    pub fn contains(&self, point: &[f64; 2]) -> bool {
        self.spans.iter().zip(point).all(|((begin, end), value)| (begin..=end).contains(&value))
    }

    /// Whether both share a place.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.spans.iter().zip(&other.spans).all(|(a, b)| a.1 > b.0 && b.1 > a.0)
    }
}

impl std::fmt::Display for MapExtent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y] = self.spans;
        write!(f, "x {:.2} to {:.2} m, y {:.2} to {:.2} m", x.0, x.1, y.0, y.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn a_map_has_its_points_and_overlaps_its_neighbour_on_no_edge() {
        let grid =
            |x: f64| GridGeometry { origin: Vector2::new(x, -1.0), resolution: 0.5, width: 4, height: 6 };
        let map = MapExtent::of(&grid(-0.5));
        assert_eq!(map.to_string(), "x -0.50 to 1.50 m, y -1.00 to 2.00 m");
        assert!(map.contains(&[1.5, 0.0]) && !map.contains(&[1.6, 0.0]) && !map.contains(&[0.0, 2.5]));
        assert!(map.overlaps(&MapExtent::of(&grid(1.0))) && !map.overlaps(&MapExtent::of(&grid(1.5))));
    }
}
