//! Costs of low clearance.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Wanted clearance around the footprint, and its costs.
///
/// A metre of path costs 1, more near obstacles and in unknown space. A path exists whenever the footprint itself fits: these are
/// costs, not obstacles. A path is at most 1 + `comfort_weight` times longer than the shortest one that keeps `margin`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClearanceCostConfig {
    /// Clearance that is given up only if there is no other path, m, 0 to 1. Default 0.05: a cell and the tracking error of a
    /// Kobuki (ours).
    pub margin: f64,
    /// Additional cost of a metre without any clearance; falls to 0 at `margin`. 0 to 100, default 4 (ours).
    pub margin_weight: f64,
    /// Clearance above which no more is wanted, m, 0 to 5. Default 0.25 (ours).
    pub comfort: f64,
    /// Additional cost of a metre without any clearance; falls to 0 at `comfort`, squared. 0 to 10, default 0.1 (ours).
    pub comfort_weight: f64,
    /// Additional cost of a metre in unknown space. 0 to 100, default 0.5 (ours): a known path up to half as long again is
    /// preferred.
    pub unknown_weight: f64,
    /// Additional cost of a metre where a [`CostMask`](crate::CostMask) holds 100, in proportion below; 0 to 20. Default 4: the
    /// cost in Nav2's NavFn (50 per free cell, 0.8 per unit of cost, 2.54 units per value).
    pub mask_weight: f64,
    /// Largest overlap of a start that is still planned out of, m, 0 to 1. Default 0.06 (ours): one cell of map noise and a
    /// centimetre of pose.
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
