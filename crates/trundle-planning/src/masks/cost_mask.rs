//! Additional costs over the map.

use trundle_core::{GridGeometry, Invalid, Vector2};

/// Additional costs over an area, per cell, 0 to 100 per cent of [`ClearanceCostConfig::mask_weight`]: to be avoided, not forbidden.
///
/// [`ClearanceCostConfig::mask_weight`]: crate::ClearanceCostConfig::mask_weight
#[derive(Debug, Clone, PartialEq)]
pub struct CostMask {
    geometry: GridGeometry,
    values: Vec<u8>,
}

impl CostMask {
    /// A mask of `values`, row by row from the lowest y.
    ///
    /// # Errors
    /// When the number of values differs from the number of cells, or a value is above 100.
    pub fn new(geometry: GridGeometry, values: Vec<u8>) -> Result<Self, Invalid> {
        if values.len() != geometry.len() {
            let expected = geometry.len().to_string();
            return Err(Invalid::new("number of values of the mask", values.len(), "", expected));
        }
        match values.iter().find(|value| **value > 100) {
            Some(value) => Err(Invalid::new("value of the mask", value, "", "0 to 100")),
            None => Ok(Self { geometry, values }),
        }
    }

    /// The cost share at a point of the map frame, 0 to 1; 0 outside the mask.
    pub(crate) fn share(&self, point: Vector2) -> f64 {
        let cell = self.geometry.cell_at(point).map(|cell| self.values[self.geometry.linear(cell)]);
        f64::from(cell.unwrap_or(0)) / 100.0
    }
}
