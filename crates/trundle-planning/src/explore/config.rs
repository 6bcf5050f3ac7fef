use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How unknown space is explored.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExploreConfig {
    /// Shorter frontiers are not worth a look, m, 0.05 to 5. Default 0.4: a gap that the Kobuki fits through is wider.
    pub least_frontier: f64,
    /// From no farther than this a frontier is looked at, m, 0.5 to 10. Default 2 (ours): near enough to see behind it.
    pub view_distance: f64,
    /// A frontier that is still there after so many looks from its place is left alone, 1 to 10. Default 2.
    pub looks: u32,
    /// What a metre of frontier is worth, in metres of way, 0 to 10. Default 0.5 (ours): the near ones first, the large ones
    /// of two equally near.
    pub gain: f64,
    /// Frontiers farther from the start than this are left alone, m, 1 to 1000. Default 50.
    pub reach: f64,
}

impl Default for ExploreConfig {
    fn default() -> Self {
        Self { least_frontier: 0.4, view_distance: 2.0, looks: 2, gain: 0.5, reach: 50.0 }
    }
}

impl ExploreConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("explore.least_frontier", self.least_frontier, "m", 0.05, 5.0)?;
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
    fn bad_numbers_are_refused_by_name() {
        let error = ExploreConfig { looks: 0, ..ExploreConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "explore.looks");
        assert!(ExploreConfig { reach: f64::NAN, ..ExploreConfig::default() }.validated().is_err());
    }
}
