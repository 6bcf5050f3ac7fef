use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How much room the planner wants around the footprint, and how dearly it pays for it.
///
/// A metre costs 1, more near obstacles and in the unknown; a way exists whenever the footprint itself fits, for these are
/// prices, not walls. A path is at most 1 + `comfort_weight` times longer than the shortest one that keeps `margin`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RoomConfig {
    /// Clearance that is given up only where there is no other way, m, 0 to 1. Default 0.05: a cell and the tracking
    /// error of a Kobuki (ours).
    pub margin: f64,
    /// Price of a metre without any clearance, on top of 1; falls to 0 at `margin`. 0 to 100, default 4 (ours).
    pub margin_weight: f64,
    /// Clearance beyond which there is no need for more, m, 0 to 5. Default 0.25 (ours).
    pub comfort: f64,
    /// Price of a metre without any clearance, on top of 1; falls to 0 at `comfort`, squared. 0 to 10, default 0.1 (ours).
    pub comfort_weight: f64,
    /// Price of a metre in unknown space, on top of 1. 0 to 100, default 0.5 (ours): a known way that is half as long
    /// again is preferred.
    pub unknown_weight: f64,
    /// Price of a metre where a mask of dear places ([`DearMask`](crate::DearMask)) says 100, on top of 1, in proportion below; 0 to
    /// 20. Default 4: what Nav2's NavFn pays for a mask's values (50 a free cell, 0.8 a unit of cost, 2.54 units a value).
    pub mask_weight: f64,
    /// How far a start may stand inside the footprint's clearance and still be planned out of it, m, 0 to 1.
    /// Default 0.06 (ours): one cell of map noise and a centimetre of pose.
    pub escape: f64,
}

impl Default for RoomConfig {
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

impl RoomConfig {
    /// The cost of a known metre with this clearance beside the footprint, m: 1 or more.
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

    /// Passes a valid configuration through.
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
