//! Global localization in a fixed map, then tracking by particles.

use crate::filter_models::FilterModels;
use crate::particle_config::ParticleConfig;
use crate::persist::FilterFileError;
use crate::rbpf::map_publisher::MapPublisher;
use crate::rbpf::mapper::{EXPECTED_LOG_LIKELIHOOD, EXPECTED_LOG_LIKELIHOOD_RATE, ParticleMapper};
use crate::rbpf::motion_model::unknown_motion_covariance;
use crate::rbpf::proposal::{Proposal, Proposer};
use crate::rbpf::resampling::{effective, low_variance};
use crate::rbpf::rng::ParticleRng;
use crate::rbpf::scan_update::Refusal;
use crate::rbpf::update_gate::{OdometryStep, UpdateGate};
use crate::scan_match::branch_and_bound::Pyramid;
use crate::scan_match::coarse_search::CoarseSearch;
use crate::scan_match::global_search::{GlobalSearch, Lost};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::scan_points::ScanPoints;
use crate::units::{in_cells, in_metres, scaled};
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Invalid, OccupancyGrid, Pose2, Scan, Stamp, wrap_angle};
use trundle_grid::tiles::TileMap;

/// Localizes the robot in a fixed map: finds its pose by a search of the whole map, then tracks it by a particle filter with the mapper's
/// proposal.
///
/// A pose is found if it is proved: the best place in the whole map (branch and bound over the complete lattice) must be clearly better
/// than the second-best place and than unknown ground. Cost: a search is linear in the map's area; tracking does not depend on the area.
#[derive(Debug)]
pub struct MapLocalizer {
    config: ParticleConfig,
    seed: u64,
    updates: u64,
    likelihood: Likelihood,
    map: TileMap,
    pyramid: Option<Pyramid>,
    points: ScanPoints,
    coarse: CoarseSearch,
    gate: UpdateGate,
    expected_log_likelihood: f64,
    state: State,
}

#[derive(Debug)]
enum State {
    Lost(GlobalSearch),
    /// Poses (cells) with the logarithms of their weights, and the number of successive scans that the map does not explain.
    Known {
        particles: Vec<(Pose2, f64)>,
        strange: usize,
    },
}

/// Result of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Localized {
    /// The robot has hardly moved: the scan was not used.
    Still,
    /// The scan was refused.
    Refused(Refusal),
    /// The pose is unknown.
    Lost(Lost),
    /// The pose is known.
    Known {
        /// Mean of the particles.
        map_from_base: Pose2,
        /// Covariance of the particles and of the last match: m, m, rad, map frame.
        covariance: Matrix3<f64>,
        /// Part of the hits that the map explains, 0 to 1.
        explained: f64,
        /// Number of directions determined by the odometry alone, 0 to 3.
        degenerate: usize,
    },
}

/// Number of successive scans that fit worse than unknown ground after which the robot is lost. Source: ours.
const MAX_MISMATCHED_SCANS: usize = 5;

impl MapLocalizer {
    /// A localizer in the map of a saved filter ([`ParticleMapper::save`]).
    ///
    /// # Errors
    /// As [`ParticleMapper::load`].
    pub fn load(bytes: &[u8], config: ParticleConfig, seed: u64) -> Result<Self, FilterFileError> {
        let mapper = ParticleMapper::load(bytes, config)?;
        Ok(Self::of(&mapper, seed))
    }

    /// A localizer in the present map of a filter's best particle.
    pub fn of(mapper: &ParticleMapper, seed: u64) -> Self {
        Self::new(mapper.models.config.clone(), mapper.best_map().clone(), seed)
    }

    /// A localizer in a three-valued map, as from a PGM and YAML.
    ///
    /// # Errors
    /// When the configuration is out of range, or the grid's cells are not its `map.resolution`.
    pub fn from_grid(grid: &OccupancyGrid, config: ParticleConfig, seed: u64) -> Result<Self, Invalid> {
        let models = FilterModels::new(config)?;
        let found = grid.geometry().resolution;
        if (found - models.config.map.resolution).abs() > 1e-9 {
            return Err(Invalid::new(
                "map.resolution",
                models.config.map.resolution,
                "m",
                format!("the map's {found} m"),
            ));
        }
        let map = models.map_from_grid(grid);
        Ok(Self::new(models.config, map, seed))
    }

    fn new(config: ParticleConfig, map: TileMap, seed: u64) -> Self {
        Self {
            likelihood: Likelihood::new(&config),
            pyramid: Pyramid::new(&map),
            map,
            seed,
            updates: 0,
            points: ScanPoints::default(),
            coarse: CoarseSearch::default(),
            gate: UpdateGate::default(),
            expected_log_likelihood: EXPECTED_LOG_LIKELIHOOD,
            state: State::Lost(GlobalSearch::default()),
            config,
        }
    }

    /// The map as a three-valued grid.
    pub fn grid(&self) -> OccupancyGrid {
        let mut publisher = MapPublisher::new(&self.config.map);
        publisher.show(&self.map);
        publisher.grid().clone()
    }

    /// Sets the pose of the base, without a search.
    pub fn start_at(&mut self, map_from_base: Pose2) {
        let pose = in_cells(&self.config, map_from_base);
        self.state = State::Known { particles: vec![(pose, 0.0); self.config.particles], strange: 0 };
    }

    /// Declares that the robot was carried away: a new search begins.
    pub fn kidnapped(&mut self) {
        self.state = State::Lost(GlobalSearch::default());
    }

    /// Processes a scan, taken with the base at `odom_from_base` by the odometry.
    pub fn update(&mut self, odom_from_base: Pose2, scan: &Scan) -> Localized {
        let step = match self.gate.pass(&self.config, false, odom_from_base, scan) {
            Ok(Some(step)) => step,
            Ok(None) => return Localized::Still,
            Err(refusal) => return Localized::Refused(refusal),
        };
        self.points.set(&self.config, scan);
        self.updates += 1;
        match &mut self.state {
            State::Lost(_) => self.search(odom_from_base, scan.stamp()),
            State::Known { .. } if step.jumped => {
                self.kidnapped();
                self.search(odom_from_base, scan.stamp())
            }
            State::Known { .. } => self.follow(&step),
        }
    }

    fn search(&mut self, odom_from_base: Pose2, stamp: Stamp) -> Localized {
        let State::Lost(search) = &mut self.state else { return Localized::Still };
        search.push(&self.points, in_cells(&self.config, odom_from_base), stamp);
        let Some(pyramid) = &self.pyramid else { return Localized::Lost(Lost::NothingToSee) };
        let found = match search.search((&self.config, &self.likelihood), &self.map, pyramid) {
            Ok(found) => found,
            Err(lost) => return Localized::Lost(lost),
        };
        let covariance = found.information.try_inverse().unwrap_or_else(unknown_motion_covariance);
        self.state = State::Known { particles: vec![(found.pose, 0.0); self.config.particles], strange: 0 };
        Localized::Known {
            map_from_base: in_metres(&self.config, found.pose),
            covariance: scaled(covariance, self.config.map.resolution),
            explained: found.explained,
            degenerate: found.degenerate,
        }
    }

    fn follow(&mut self, step: &OdometryStep) -> Localized {
        let State::Known { particles, strange } = &mut self.state else { return Localized::Still };
        let per_metre = 1.0 / self.config.map.resolution;
        let proposer = Proposer {
            config: &self.config,
            likelihood: &self.likelihood,
            points: &self.points,
            motion_covariance: scaled(step.covariance, per_metre),
            anchor: None,
            expected_log_likelihood: self.expected_log_likelihood,
        };
        let motion = in_cells(&self.config, step.motion);
        let lead =
            particles.iter().fold(particles[0], |best, next| if next.1 > best.1 { *next } else { best }).0;
        let far = proposer.far(&self.map, &mut self.coarse, (lead, lead * motion));
        let mut best: Option<(f64, Proposal)> = None;
        for (i, (pose, log_weight)) in particles.iter_mut().enumerate() {
            let mut rng = ParticleRng::new(self.seed, self.updates, i);
            let places = (*pose, *pose * motion);
            let found = proposer.propose((&self.map, &far), &mut self.coarse, places, &mut rng);
            *pose = found.pose;
            *log_weight += found.log_weight * proposer.weight_scale();
            if best.is_none_or(|(greatest, _)| *log_weight > greatest) {
                best = Some((*log_weight, found));
            }
        }
        let (greatest, found) = best.expect("invariant: there is at least one particle");
        let unseen = 0.5 * self.config.outliers.ln();
        *strange = if found.per_point < unseen { *strange + 1 } else { 0 };
        if *strange >= MAX_MISMATCHED_SCANS {
            self.kidnapped();
            return Localized::Lost(Lost::NothingFits);
        }
        self.expected_log_likelihood +=
            EXPECTED_LOG_LIKELIHOOD_RATE * (found.per_point - self.expected_log_likelihood);
        particles.iter_mut().for_each(|(_, log_weight)| *log_weight -= greatest);
        let (mean, spread) = moments(particles);
        let weights: Vec<f64> = particles.iter().map(|(_, log_weight)| log_weight.exp()).collect();
        if effective(&weights) < self.config.resample_below * weights.len() as f64 {
            let uniform = ParticleRng::new(self.seed, self.updates, weights.len()).uniform();
            let parents = low_variance(&weights, uniform);
            let old = particles.clone();
            *particles = parents.iter().map(|&parent| (old[usize::from(parent)].0, 0.0)).collect();
        }
        Localized::Known {
            map_from_base: in_metres(&self.config, mean),
            covariance: scaled(spread + found.covariance, self.config.map.resolution),
            explained: found.explained,
            degenerate: found.degenerate,
        }
    }
}

/// Weighted mean and covariance.
fn moments(particles: &[(Pose2, f64)]) -> (Pose2, Matrix3<f64>) {
    let first = particles[0].0;
    let off =
        |pose: &Pose2| Vector3::new(pose.x - first.x, pose.y - first.y, wrap_angle(pose.theta - first.theta));
    let total: f64 = particles.iter().map(|(_, log)| log.exp()).sum();
    let mean: Vector3<f64> = particles.iter().map(|(pose, log)| off(pose) * (log.exp() / total)).sum();
    let spread = particles
        .iter()
        .map(|(pose, log)| (off(pose) - mean) * (off(pose) - mean).transpose() * (log.exp() / total))
        .sum();
    (Pose2::new(first.x + mean.x, first.y + mean.y, first.theta + mean.z), spread)
}
