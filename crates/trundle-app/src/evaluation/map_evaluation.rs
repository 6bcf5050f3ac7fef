//! Comparison of the occupied cells of a map with the true map.

use super::named_error::named_error;
use crate::{AppError, read_two_maps};
use std::path::Path;
use trundle_core::Pose2;
use trundle_eval::{EvalError, MapAgreement, MapAgreementConfig, align_maps, map_agreement};
use trundle_io::Summary;

/// Agreement of the occupied cells of a map with those of the true map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapEvaluation {
    /// The agreement of the cells.
    pub agreement: MapAgreement,
    /// The pose of the map's frame in the true map's frame.
    pub pose: Pose2,
    /// Largest distance of two cells that agree \[m\].
    pub within: f64,
}

impl MapEvaluation {
    /// Evaluates the map of one file against the true map of another one. `at` is the pose of the map's frame in the true map's frame: exact, or
    /// the start of an alignment by closest points.
    ///
    /// # Errors
    /// When a map cannot be read, has no occupied cell, or `within` is not above 0.
    pub fn of(truth: &Path, map: &Path, at: Pose2, is_exact: bool, within: f64) -> Result<Self, AppError> {
        let [true_grid, grid] = read_two_maps([truth, map])?;
        let mut config = MapAgreementConfig::default();
        config.within = within;
        let config = config.validated()?;
        let wrong = |error: EvalError| named_error(&error, truth, map);
        let pose = if is_exact { at } else { align_maps(&true_grid, &grid, at).map_err(wrong)? };
        let agreement = map_agreement(&true_grid, &grid, pose, &config).map_err(wrong)?;
        Ok(Self { agreement, pose, within })
    }

    /// The numbers, one row each.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let (found, pose) = (&self.agreement, self.pose);
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        let percent = |part: f64| format!("{:.1} %", part * 100.0);
        let cm = |metres: f64| format!("{:.1} cm", metres * 100.0);
        let place = format!("{:.3} m, {:.3} m, {:.2} deg", pose.x, pose.y, pose.theta.to_degrees());
        let distance = format!("{}, {}", cm(found.to_truth.mean), cm(found.to_truth.max));
        let visible = format!("{} of {}", found.from_truth.count, found.surface_cells);
        vec![
            row("the map lies at", place),
            row("occupied cells", found.to_truth.count.to_string()),
            row(&format!("of these within {} of a true one", cm(self.within)), percent(found.precision)),
            row("their distance: mean, largest", distance),
            row("true surface cells there to be seen", visible),
            row(&format!("of these within {} of one of the map", cm(self.within)), percent(found.recall)),
            row("free cells inside what is truly occupied", percent(found.cleared)),
        ]
    }

    /// The numbers for scripts.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let (found, pose) = (&self.agreement, self.pose);
        let mut summary = Summary::new("eval map");
        summary
            .set("success", true)
            .set("x_m", pose.x)
            .set("y_m", pose.y)
            .set("heading_deg", pose.theta.to_degrees())
            .set("within_m", self.within)
            .set("precision", found.precision)
            .set("recall", found.recall)
            .set("cleared", found.cleared)
            .set("to_truth_m", found.to_truth)
            .set("from_truth_m", found.from_truth)
            .set("surface_cells", found.surface_cells);
        summary
    }
}
