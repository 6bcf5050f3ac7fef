//! The highest surface over each cell of the floor.

use crate::surface_mesh::SurfaceMesh;
use trundle_core::{Invalid, require_in};

/// Smallest vertical part of a normal that counts as a surface seen from above \[1\]. Source: ours, 60 deg.
const MIN_UPWARD: f32 = 0.5;
/// Largest number of cells. Source: ours.
const MAX_CELLS: f64 = 1e8;

/// Heights over the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lower left corner of the map, m.
    pub origin: [f64; 2],
    /// Number of cells along x.
    pub width: usize,
    /// Number of cells along y.
    pub height: usize,
    /// Height of each cell, m, NaN where nothing was seen; x fastest, from the lower left corner.
    pub heights: Vec<f32>,
}

impl HeightMap {
    /// The highest upward surface below `ceiling` m in cells of `resolution` m; `None` for a mesh without one.
    ///
    /// # Errors
    /// When the resolution is outside 0.01 to 1 m, or the map has more than 10^8 cells.
    pub fn of(mesh: &SurfaceMesh, resolution: f64, ceiling: f64) -> Result<Option<Self>, Invalid> {
        require_in("resolution of the height map", resolution, "m", 0.01, 1.0)?;
        let points = || {
            let upward = mesh.vertices.iter().zip(&mesh.normals);
            upward.filter(|(at, normal)| normal[2] >= MIN_UPWARD && f64::from(at[2]) < ceiling)
        };
        let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
            points().map(|(at, _)| (f64::from(at[axis]) / resolution).floor()).reduce(pick)
        };
        let lowest = bound(0, f64::min).zip(bound(1, f64::min));
        let highest = bound(0, f64::max).zip(bound(1, f64::max));
        let Some(((left, bottom), (right, top))) = lowest.zip(highest) else { return Ok(None) };
        let (width, height) = (right - left + 1.0, top - bottom + 1.0);
        require_in("cells of the height map", width * height, "", 1.0, MAX_CELLS)?;
        let mut map = Self {
            resolution,
            origin: [left * resolution, bottom * resolution],
            width: width as usize,
            height: height as usize,
            heights: vec![f32::NAN; (width * height) as usize],
        };
        for (at, _) in points() {
            let column = (f64::from(at[0]) / resolution).floor() - left;
            let row = (f64::from(at[1]) / resolution).floor() - bottom;
            let cell = &mut map.heights[row as usize * map.width + column as usize];
            *cell = cell.max(at[2]);
        }
        Ok(Some(map))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_upward_surface_below_the_ceiling_counts() {
        let up = [0.0, 0.0, 1.0];
        let vertices = vec![[0.02, 0.01, 0.0], [0.02, 0.01, 0.7], [0.02, 0.01, 2.5], [0.27, 0.11, 0.3]];
        let mesh = SurfaceMesh { vertices, normals: vec![up; 4], ..SurfaceMesh::default() };
        let map = HeightMap::of(&mesh, 0.1, 2.0).unwrap().unwrap();
        assert_eq!((map.width, map.height, map.origin), (3, 2, [0.0, 0.0]));
        assert_eq!((map.heights[0], map.heights[5]), (0.7, 0.3));
        assert!(map.heights[1].is_nan());
        let down = SurfaceMesh { normals: vec![[0.0, 0.0, -1.0]; 4], ..mesh.clone() };
        assert_eq!(HeightMap::of(&down, 0.1, 2.0).unwrap(), None);
        assert!(HeightMap::of(&mesh, 0.0, 2.0).is_err());
    }
}
