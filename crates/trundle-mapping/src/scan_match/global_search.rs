use crate::loop_closing::loop_closer::PROOF;
use crate::particle_config::ParticleConfig;
use crate::scan_match::branch_and_bound::Pyramid;
use crate::scan_match::cloud_match::{Finder, Found};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::scan_points::ScanShape;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeSet;
use trundle_core::Pose2;
use trundle_grid::tiles::TileMap;

/// Why nobody knows where the robot is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    /// The map is empty, or the scans hold next to nothing.
    NothingToSee,
    /// No place fits better than one that was never seen.
    NothingFits,
    /// Several places fit alike: the robot must see more.
    SeveralPlaces,
}

/// The last scans together, looked for in the whole map.
#[derive(Debug, Clone, Default)]
pub(crate) struct GlobalSearch {
    /// Scans and where the odometry says they were taken (cells).
    scans: Vec<(ScanShape, Pose2)>,
}

/// Scans that are looked for together.
const MOST_SCANS: usize = 20;
/// Hits nearer to each other than this count once, cells.
const SPACING: f64 = 2.0;
/// Fewer hits than this are next to nothing.
const LEAST_POINTS: usize = 30;
/// A place that leaves more of the hits unexplained is in another building, or one rebuilt: among all places of a large map
/// some always explains half of them.
const LEAST_EXPLAINED: f64 = 0.75;
/// Standard deviation of a place that may be anywhere: cells, rad.
const ANYWHERE: (f64, f64) = (1e5, 100.0);

impl GlobalSearch {
    /// Adds a scan taken with the base at `odom_from_base` (cells).
    pub(crate) fn push(&mut self, shape: &ScanShape, odom_from_base: Pose2) {
        if self.scans.len() == MOST_SCANS {
            self.scans.remove(0);
        }
        self.scans.push((shape.clone(), odom_from_base));
    }

    /// Where in the map the base was at the last scan.
    pub(crate) fn look(
        &self,
        (config, likelihood): (&ParticleConfig, &Likelihood),
        map: &TileMap,
        pyramid: &Pyramid,
    ) -> Result<Found, Lost> {
        let Some((_, last)) = self.scans.last() else { return Err(Lost::NothingToSee) };
        let (mut cloud, mut taken) = (ScanShape::default(), BTreeSet::new());
        let parts = self.scans.iter().rev().map(|(shape, odom)| (shape, last.inverse() * *odom));
        cloud.gather(parts, SPACING, &mut taken);
        cloud.finish();
        if cloud.points.len() < LEAST_POINTS {
            return Err(Lost::NothingToSee);
        }
        let (middle, half) = pyramid.bounds();
        let finder = Finder { config, likelihood, cloud: &cloud };
        let sigma = Vector3::new(ANYWHERE.0, ANYWHERE.0, ANYWHERE.1);
        let covariance = Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        let found = finder.find_in(
            pyramid,
            map,
            Pose2::new(middle.0, middle.1, 0.0),
            &covariance,
            (half, std::f64::consts::PI),
            3,
        );
        let unseen = 0.5 * config.outliers.ln() * cloud.points.len() as f64 / config.correlation;
        let is_proved = |best: &&Found| best.log_likelihood - unseen > PROOF && best.degenerate == 0;
        let best = found.first().filter(is_proved).filter(|best| best.explained >= LEAST_EXPLAINED);
        let best = best.ok_or(Lost::NothingFits)?;
        let rival = found.get(1).map_or(f64::NEG_INFINITY, |rival| rival.log_likelihood);
        if best.log_likelihood - rival > RIVAL { Ok(*best) } else { Err(Lost::SeveralPlaces) }
    }
}

/// By so much the best place must be better than the second, nats: 1 in 3000.
const RIVAL: f64 = 8.0;
