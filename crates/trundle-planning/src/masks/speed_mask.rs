//! Speed limits over the map.

use trundle_core::{GridGeometry, Invalid, Vector2};

/// Speed limits over an area, one limit per cell, as in Nav2's speed filter.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedMask {
    geometry: GridGeometry,
    limits: Vec<f32>,
}

impl SpeedMask {
    /// A mask of `limits`, m/s, row by row from the lowest y. Infinite: no limit.
    ///
    /// # Errors
    /// When the number of cells is not the geometry's, or a limit is not above 0.
    pub fn new(geometry: GridGeometry, limits: Vec<f32>) -> Result<Self, Invalid> {
        if limits.len() != geometry.len() {
            return Err(Invalid::new(
                "cells of the speed mask",
                limits.len(),
                "",
                geometry.len().to_string(),
            ));
        }
        match limits.iter().find(|limit| limit.is_nan() || **limit <= 0.0) {
            Some(limit) => Err(Invalid::new("limit of the speed mask", limit, "m/s", "more than 0")),
            None => Ok(Self { geometry, limits }),
        }
    }

    /// The limit at a point of the map frame, m/s; infinite outside the mask.
    pub fn limit(&self, point: Vector2) -> f64 {
        let cell = self.geometry.cell_at(point).map(|cell| self.limits[self.geometry.linear(cell)]);
        cell.map_or(f64::INFINITY, f64::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_looked_up_and_checked() {
        let geometry = GridGeometry::new(0.5, Vector2::zeros(), 2, 1).unwrap();
        let mask = SpeedMask::new(geometry, vec![0.2, f32::INFINITY]).unwrap();
        assert_eq!(mask.limit(Vector2::new(0.1, 0.1)), f64::from(0.2_f32));
        assert_eq!(mask.limit(Vector2::new(0.7, 0.1)), f64::INFINITY);
        assert_eq!(mask.limit(Vector2::new(9.0, 0.1)), f64::INFINITY);
        assert!(SpeedMask::new(geometry, vec![0.0, 1.0]).is_err());
        assert!(SpeedMask::new(geometry, vec![1.0]).is_err());
    }
}
