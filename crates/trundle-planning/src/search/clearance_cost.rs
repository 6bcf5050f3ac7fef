//! Costs of low clearance.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Wanted clearance around the footprint, and its costs.
///
/// A metre of path costs 1, more near obstacles and in unknown space. A path exists whenever the footprint itself fits: these are costs,
/// not obstacles. A path is at most 1 + `comfort_weight` times longer than the shortest path with clearance `margin`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ClearanceCostConfig {
    /// Clearance around the footprint that paths keep unless no other path exists, m, 0 to 1. Default 0.05 (ours): a cell and the tracking
    /// error of a Kobuki.
    pub margin: f64,
    /// Additional cost of a metre without clearance, 0 to 100. It falls to 0 at `margin`. Default 4 (ours).
    pub margin_weight: f64,
    /// Clearance above which a path has no additional cost, m, 0 to 5. A larger value leads paths farther from obstacles. Default 0.25
    /// (ours).
    pub comfort: f64,
    /// Additional cost of a metre without clearance, 0 to 10. It falls to 0 at `comfort`, as a square. Default 0.1 (ours).
    pub comfort_weight: f64,
    /// Additional cost of a metre in unknown space, 0 to 100. Default 0.5 (ours): a known path up to 1.5 times as long is preferred.
    pub unknown_weight: f64,
    /// Additional cost of a metre with the value 100 of a [`CostMask`](crate::CostMask), 0 to 20, in proportion to the value. Default 4:
    /// the cost in Nav2's NavFn (50 per free cell, 0.8 per unit of cost, 2.54 units per value).
    pub mask_weight: f64,
    /// Largest overlap of the start with an obstacle from which a path may lead out, m, 0 to 1. Default 0.06 (ours): one cell of map noise
    /// and a centimetre of pose error.
    pub escape: f64,
}

impl Default for ClearanceCostConfig {
    fn default() -> Self {
        Self {
            margin: 0.05,
            margin_weight: 4.0,
            comfort: 0.25,
            comfort_weight: 0.1,
            unknown_weight: 0.5,
            mask_weight: 4.0,
            escape: 0.06,
        }
    }
}

impl ClearanceCostConfig {
    /// The cost per metre of known floor at this clearance of the footprint (m): 1 or more.
    pub(crate) fn density(&self, clearance: f64) -> f64 {
        let clearance = clearance.max(0.0);
        let mut cost = 1.0;
        if clearance < self.comfort {
            cost += self.comfort_weight * (1.0 - clearance / self.comfort).powi(2);
        }
        if clearance < self.margin {
            cost += self.margin_weight * (1.0 - clearance / self.margin);
        }
        cost
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("room.margin", self.margin, "m", 0.0, 1.0)?;
        require_in("room.margin_weight", self.margin_weight, "", 0.0, 100.0)?;
        require_in("room.comfort", self.comfort, "m", 0.0, 5.0)?;
        require_in("room.comfort_weight", self.comfort_weight, "", 0.0, 10.0)?;
        require_in("room.unknown_weight", self.unknown_weight, "", 0.0, 100.0)?;
        require_in("room.mask_weight", self.mask_weight, "", 0.0, 20.0)?;
        require_in("room.escape", self.escape, "m", 0.0, 1.0)?;
        Ok(self)
    }
}
