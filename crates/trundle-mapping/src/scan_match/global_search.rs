//! Search of the newest scans in a whole map.

use crate::particle_config::ParticleConfig;
use crate::scan_match::branch_and_bound::{LookupBudget, Pyramid};
use crate::scan_match::cloud_match::{CloudMatch, CloudMatcher, MIN_PROOF_NATS};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeSet;
use trundle_core::{Pose2, Stamp};
use trundle_grid::tiles::TileMap;

/// Reason why the pose is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Lost {
    /// The map is empty, or the scans have too few points.
    NothingToSee,
    /// No place fits better than unknown ground.
    NothingFits,
    /// Several places fit equally well: the robot must observe more of its surroundings.
    SeveralPlaces,
    /// The search ended at its budget before all places were compared.
    Unfinished,
}

/// Search of the combined last scans in the whole map.
///
/// Searches have a budget of lookups by the scans' stamps, not by the clock: the result is the same on every machine. A robot in a map of
/// another place takes a bounded fraction of a core.
#[derive(Debug, Clone)]
pub(crate) struct GlobalSearch {
    /// Scans with their poses by the odometry (cells).
    scans: Vec<(ScanPoints, Pose2)>,
    /// Stamp of the last scan.
    now: Stamp,
    /// Available lookups; negative after a search.
    credit: i64,
    /// Result of the last search.
    last: Lost,
}

/// Lookups that accrue in a second of the scans' time [1/s]: about a tenth of a core. Source: ours.
const LOOKUPS_PER_SECOND: f64 = 1e8;
/// Largest credit, also the initial one: about forty seconds of a core. Source: ours.
const MAX_CREDIT_LOOKUPS: i64 = 40_000_000_000;
/// Largest number of lookups of one search. Source: ours.
const MAX_SEARCH_LOOKUPS: u64 = 20_000_000_000;

impl Default for GlobalSearch {
    fn default() -> Self {
        Self {
            scans: Vec::new(),
            now: Stamp::default(),
            credit: MAX_CREDIT_LOOKUPS,
            last: Lost::NothingToSee,
        }
    }
}

/// Maximum number of scans that are matched together. The oldest scan is dropped beyond it. Source: ours.
const MAX_SCANS: usize = 20;
/// Minimum distance of two points of the cloud \[cells\]. A nearer point is dropped. Source: ours.
const POINT_SPACING_CELLS: f64 = 2.0;
/// Minimum number of points of the cloud. Fewer points are not matched. Source: ours.
const MIN_POINTS: usize = 30;
/// Minimum fraction of points that the map explains \[1\]. A lower fraction means another or a changed building: some place of a large map
/// always explains half of the points. Source: ours.
const MIN_EXPLAINED: f64 = 0.75;
/// Sigma of an unknown position \[cells\]. Source: ours.
const UNKNOWN_POSITION_SIGMA_CELLS: f64 = 1e5;
/// Sigma of an unknown heading \[rad\]. Source: ours.
const UNKNOWN_HEADING_SIGMA_RAD: f64 = 100.0;

impl GlobalSearch {
    /// Adds a scan taken with the base at `odom_from_base` (cells).
    pub(crate) fn push(&mut self, shape: &ScanPoints, odom_from_base: Pose2, stamp: Stamp) {
        let accrued = (stamp - self.now).max(0.0) * LOOKUPS_PER_SECOND;
        self.credit = self.credit.saturating_add(accrued as i64).min(MAX_CREDIT_LOOKUPS);
        self.now = stamp;
        if self.scans.len() == MAX_SCANS {
            self.scans.remove(0);
        }
        self.scans.push((shape.clone(), odom_from_base));
    }

    /// Pose of the base in the map at the last scan. Without credit, the last result.
    pub(crate) fn search(
        &mut self,
        models: (&ParticleConfig, &Likelihood),
        map: &TileMap,
        pyramid: &Pyramid,
    ) -> Result<CloudMatch, Lost> {
        if self.credit <= 0 {
            return Err(self.last);
        }
        let budget = LookupBudget::new(MAX_SEARCH_LOOKUPS);
        let found = self.search_within(models, (pyramid, map), &budget);
        self.credit -= budget.used() as i64;
        found.inspect_err(|lost| self.last = *lost)
    }

    fn search_within(
        &self,
        (config, likelihood): (&ParticleConfig, &Likelihood),
        (pyramid, map): (&Pyramid, &TileMap),
        budget: &LookupBudget,
    ) -> Result<CloudMatch, Lost> {
        let Some((_, last)) = self.scans.last() else { return Err(Lost::NothingToSee) };
        let (mut cloud, mut taken) = (ScanPoints::default(), BTreeSet::new());
        let parts = self.scans.iter().rev().map(|(shape, odom)| (shape, last.inverse() * *odom));
        cloud.gather(parts, POINT_SPACING_CELLS, &mut taken);
        cloud.finish();
        if cloud.points.len() < MIN_POINTS {
            return Err(Lost::NothingToSee);
        }
        let (middle, half) = pyramid.bounds();
        let finder = CloudMatcher { config, likelihood, cloud: &cloud };
        let sigma = Vector3::new(
            UNKNOWN_POSITION_SIGMA_CELLS,
            UNKNOWN_POSITION_SIGMA_CELLS,
            UNKNOWN_HEADING_SIGMA_RAD,
        );
        let covariance = Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        let found = finder.find_in(
            (pyramid, map),
            Pose2::new(middle.0, middle.1, 0.0),
            &covariance,
            (half, std::f64::consts::PI),
            (MAX_PLACES, budget),
        );
        if budget.is_spent() {
            return Err(Lost::Unfinished);
        }
        let unseen = 0.5 * config.outliers.ln() * cloud.points.len() as f64 / config.correlation;
        let is_proved =
            |best: &&CloudMatch| best.log_likelihood - unseen > MIN_PROOF_NATS && best.degenerate == 0;
        let best = found.first().filter(is_proved).filter(|best| best.explained >= MIN_EXPLAINED);
        let best = best.ok_or(Lost::NothingFits)?;
        let rival = found.get(1).map_or(f64::NEG_INFINITY, |rival| rival.log_likelihood);
        if best.log_likelihood - rival > MIN_MARGIN_NATS { Ok(*best) } else { Err(Lost::SeveralPlaces) }
    }
}

/// Maximum number of places that are compared. Source: ours.
const MAX_PLACES: usize = 3;
/// Minimum log-likelihood ratio of the best to the second-best place [nats], 1 in 3000. Below it the places are
/// ambiguous. Source: ours.
const MIN_MARGIN_NATS: f64 = 8.0;
