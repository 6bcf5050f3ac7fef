//! Inputs of the smoother.

use super::fixed_lag::Smoother;
use super::measurement::{MeasurementUse, PlanarMeasurement};
use super::scan_intake;
use super::visual_intake;
use crate::fusion::correction::VisualPose;

impl Smoother {
    /// Adds a visual pose. The first one of a visual map anchors the map.
    pub fn add_visual(&mut self, visual: &VisualPose) -> MeasurementUse {
        visual_intake::add(self, visual)
    }

    /// Adds a scan match, `map_from_base` with a covariance that includes the map's.
    pub fn add_scan(&mut self, scan: &PlanarMeasurement) -> MeasurementUse {
        scan_intake::add(self, scan)
    }
}
