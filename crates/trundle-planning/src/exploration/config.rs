//! Configuration of exploration.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Parameters of frontier exploration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ExploreConfig {
    /// Smallest length of a frontier, m, 0.05 to 5. Shorter frontiers are ignored. Default 0.4: the Kobuki does not fit through narrower
    /// gaps.
    pub min_frontier: f64,
    /// Largest distance of a viewpoint from its frontier, m, 0.5 to 10. Default 2 (ours): near enough for a view behind the frontier.
    pub view_distance: f64,
    /// Number of views after which a remaining frontier is ignored, 1 to 10. Default 2 (ours).
    pub looks: u32,
    /// Gain of a metre of frontier, in metres of path, 0 to 10. A larger value prefers long frontiers to near ones. Default 0.5 (ours).
    pub gain: f64,
    /// Largest distance of a frontier from the start, m, 1 to 1000. Farther frontiers are ignored. Default 50 (ours).
    pub reach: f64,
}

impl Default for ExploreConfig {
    fn default() -> Self {
        Self { min_frontier: 0.4, view_distance: 2.0, looks: 2, gain: 0.5, reach: 50.0 }
    }
}

impl ExploreConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("explore.min_frontier", self.min_frontier, "m", 0.05, 5.0)?;
        require_in("explore.view_distance", self.view_distance, "m", 0.5, 10.0)?;
        require_in("explore.looks", f64::from(self.looks), "", 1.0, 10.0)?;
        require_in("explore.gain", self.gain, "", 0.0, 10.0)?;
        require_in("explore.reach", self.reach, "m", 1.0, 1000.0)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invalid_number_is_refused_with_its_key() {
        let error = ExploreConfig { looks: 0, ..ExploreConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "explore.looks");
        assert!(ExploreConfig { reach: f64::NAN, ..ExploreConfig::default() }.validated().is_err());
    }
}
