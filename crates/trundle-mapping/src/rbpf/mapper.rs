//! Rao-Blackwellised particle filter for grid mapping.

use crate::filter_models::FilterModels;
use crate::loop_closing::stored_scan::StoredScan;
use crate::particle_config::ParticleConfig;
use crate::rbpf::absolute_pose::AbsolutePose;
use crate::rbpf::given_map::{GivenMap, Streak};
use crate::rbpf::loop_correction::LoopCorrector;
use crate::rbpf::map_publisher::MapPublisher;
use crate::rbpf::odometry_model::OdometryModel;
use crate::rbpf::particle_set::ParticleSet;
use crate::rbpf::proposal::{Proposal, Proposer};
use crate::rbpf::rng::ParticleRng;
use crate::rbpf::scan_update::{MappingPause, Processed, ScanUpdate};
use crate::rbpf::update_gate::{OdometryStep, UpdateGate};
use crate::scan_match::branch_and_bound::Pyramid;
use crate::scan_match::cloud_match::CloudMatch;
use crate::scan_match::coarse_search::CoarseSearch;
use crate::scan_match::global_search::{GlobalSearch, Lost};
use crate::scan_match::scan_points::ScanPoints;
use crate::units::{in_cells, in_metres, scaled};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use trundle_core::{CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp};
use trundle_grid::tiles::{RayUpdateScratch, TileMap, tile_bytes};

/// Grid maps from laser scans and odometry by a Rao-Blackwellised particle filter \[Grisetti07\].
///
/// Problem: estimate trajectory and map together. Each particle is a trajectory with its map. A scan moves each particle by the improved
/// proposal (odometry and scan match), updates its map, and weights it by the likelihood of the scan in that map. Particles are resampled
/// when few of them have almost all the weight. Copies share the tiles of their maps until one writes. Loops too long for the particles are
/// searched, verified, and corrected in trajectory and map.
///
/// Cost: for each scan and particle one match (linear in the beams) and one ray update (linear in the cells that the beams cross); for each
/// 2 m of path one loop search, n log n in the stored scans (at most `max_scans`). After a loop closure the map is redrawn, four million
/// cells with each scan. No other cost grows with the length of the run.
#[derive(Debug)]
pub struct ParticleMapper {
    pub(crate) models: FilterModels,
    pub(crate) seed: u64,
    /// Number of processed scans.
    pub(crate) updates: u64,
    pub(super) points: ScanPoints,
    pub(crate) set: ParticleSet,
    scratch: Vec<Scratch>,
    publisher: MapPublisher,
    pub(crate) loops: LoopCorrector,
    pub(crate) gate: UpdateGate,
    pub(crate) odometry: OdometryModel,
    /// Search for the robot in a loaded map; `None` after the robot is found.
    pub(super) global_search: Option<GlobalSearch>,
    /// The pyramid of the searched map, which does not change during the search.
    pub(super) search_pyramid: Option<Pyramid>,
    /// The loaded map; `None` until the robot is found in it.
    pub(crate) given: Option<GivenMap>,
    /// Running mean of ln p(z | m, x) of a point over the last scans, nats.
    pub(crate) expected_log_likelihood: f64,
}

/// Buffers of one worker thread.
#[derive(Debug, Clone, Default)]
struct Scratch {
    search: CoarseSearch,
    rays: RayUpdateScratch,
}

/// Initial mean log-likelihood of a point [nats]: half of the points at obstacles, half on unknown ground. Source: ours.
pub(crate) const EXPECTED_LOG_LIKELIHOOD: f64 = -1.0;
/// Weight of a new scan in the running mean log-likelihood \[1\]. The mean covers about the last twenty scans. Source:
/// ours.
pub(crate) const EXPECTED_LOG_LIKELIHOOD_RATE: f64 = 0.05;
/// Variance of the constraint between the last pose of a loaded run and the first of the next, along x and y \[m^2\]. Source: ours.
const NEXT_RUN_VARIANCE_M2: f64 = 0.01;
/// Variance of the heading of that constraint [rad^2]. Source: ours.
const NEXT_RUN_VARIANCE_RAD2: f64 = 4e-4;

impl ParticleMapper {
    /// Filter without a scan. The base pose of the first scan is the map's origin.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: ParticleConfig, seed: u64) -> Result<Self, Invalid> {
        let models = FilterModels::new(config)?;
        Ok(Self {
            seed,
            updates: 0,
            points: ScanPoints::default(),
            set: ParticleSet::new(models.config.particles),
            scratch: Vec::new(),
            publisher: MapPublisher::new(&models.config.map),
            loops: LoopCorrector::default(),
            gate: UpdateGate::default(),
            odometry: OdometryModel::default(),
            global_search: None,
            search_pyramid: None,
            given: None,
            expected_log_likelihood: EXPECTED_LOG_LIKELIHOOD,
            models,
        })
    }

    /// Processes a scan taken with the base at `odom_from_base` by the odometry.
    pub fn update(&mut self, odom_from_base: Pose2, scan: &Scan) -> ScanUpdate {
        let has_absolute_pose = self.odometry.map_from_odom.is_some();
        let step = match self.gate.pass(&self.models.config, has_absolute_pose, odom_from_base, scan) {
            Ok(Some(step)) => step,
            Ok(None) => return ScanUpdate::Still,
            Err(refusal) => return ScanUpdate::Refused(refusal),
        };
        self.points.set(&self.models.config, scan);
        if let Some(search) = &mut self.global_search {
            search.push(&self.points, in_cells(&self.models.config, odom_from_base), scan.stamp());
            return self.relocalize(scan.stamp());
        }
        let first = step.first && self.updates == 0;
        if first && self.models.config.pose_prior.is_some() {
            self.odometry.map_from_odom = Some(odom_from_base.inverse());
        }
        let absolute = self.odometry.absolute_pose(&self.models.config, odom_from_base);
        self.move_and_draw(&step, absolute, first);
        if let Some(streak) = self.contradiction(scan.stamp()) {
            return self.pause(streak);
        }
        ScanUpdate::Processed(self.finish_update(scan.stamp(), &step, absolute.is_none()))
    }

    /// Weights, trajectories, learnt odometry, resampling and loops after the particles moved.
    fn finish_update(&mut self, stamp: Stamp, step: &OdometryStep, dead_reckoning: bool) -> Processed {
        let effective = self.set.normalize();
        let resampled = effective < self.models.config.resample_below * self.set.len() as f64;
        self.set.record(&self.models.config, stamp);
        let proposal = self.set.best().proposal;
        if let Some(proposal) = proposal.filter(|p| p.degenerate < 3) {
            self.expected_log_likelihood +=
                EXPECTED_LOG_LIKELIHOOD_RATE * (proposal.per_point - self.expected_log_likelihood);
        }
        let resolution = self.models.config.map.resolution;
        if dead_reckoning {
            self.odometry.learn(step, proposal.as_ref(), resolution);
        }
        let covariance = step_covariance(proposal.as_ref(), resolution);
        self.loops.history.push(StoredScan::new(&self.models.config, &self.points), covariance);
        if resampled {
            // The stream after those of the particles.
            let mut rng = ParticleRng::new(self.seed, self.updates, self.set.len());
            self.set.resample(rng.uniform());
        }
        let driven = step.motion.position().norm();
        let loop_correction_m =
            if dead_reckoning { self.loops.close_loops(&self.models, &mut self.set, driven) } else { None };
        let stored = self.loops.history.scans.len();
        self.loops.thin_history(&self.models, &mut self.set);
        if loop_correction_m.is_some() || self.loops.history.scans.len() < stored {
            self.renew_given();
        }
        self.updates += 1;
        Processed {
            explained: proposal.map_or(0.0, |p| p.explained),
            contradicted: proposal.map_or(0.0, |p| p.contradicted),
            degenerate: proposal.map_or(0, |p| p.degenerate),
            covariance: proposal.map_or(Matrix3::zeros(), |p| scaled(p.covariance, resolution)),
            effective,
            resampled,
            jumped: step.jumped,
            slipped: proposal.is_some_and(|p| p.slipped),
            loop_correction_m,
        }
    }

    /// Moves each particle by the proposal, and updates its map with the scan.
    fn move_and_draw(&mut self, step: &OdometryStep, absolute: Option<AbsolutePose>, first: bool) {
        let (motion, covariance) = self.odometry.motion(step);
        let motion = in_cells(&self.models.config, motion);
        let proposer = Proposer {
            config: &self.models.config,
            likelihood: &self.models.likelihood,
            points: &self.points,
            motion_covariance: scaled(covariance, 1.0 / self.models.config.map.resolution),
            anchor: absolute,
            expected_log_likelihood: self.expected_log_likelihood,
        };
        let (seed, updates) = (self.seed, self.updates);
        let (ray_update, rays) = (&self.models.ray_update, &self.points.rays);
        let workers = rayon::current_num_threads().clamp(1, self.set.len());
        let share = self.set.len().div_ceil(workers);
        self.scratch.resize_with(workers, Scratch::default);
        // Failed odometry failed for all particles: the best one searches for the new place.
        let best = self.set.best();
        let places = (best.pose, best.pose * motion);
        let far =
            if first { Vec::new() } else { proposer.far(&best.map, &mut self.scratch[0].search, places) };
        let shares = self.set.particles.par_chunks_mut(share).zip(&mut self.scratch).enumerate();
        shares.for_each(|(worker, (particles, scratch))| {
            for (i, particle) in particles.iter_mut().enumerate() {
                if !first {
                    let mut rng = ParticleRng::new(seed, updates, worker * share + i);
                    let places = (particle.pose, particle.pose * motion);
                    let proposal =
                        proposer.propose((&particle.map, &far), &mut scratch.search, places, &mut rng);
                    particle.pose = proposal.pose;
                    particle.log_weight += proposal.log_weight * proposer.weight_scale();
                    particle.proposal = Some(proposal);
                }
                ray_update.apply(&mut particle.map, &mut scratch.rays, particle.pose, rays);
            }
        });
    }

    /// Completes work in progress, as after the last scan of a log: the redraw of a corrected map.
    pub fn finish(&mut self) {
        self.loops.finish(&self.models, &mut self.set);
    }

    /// Polishes the finished trajectory (\[Lu97\], \[Konolige10\]) after the last scan of a log, and redraws the map.
    ///
    /// Each stored scan is matched with its neighbours and with other passes of the same place, and the poses are those at which all
    /// agree best. `goes_on` is asked between the rounds. The first pose does not change. All particles continue from the result. Returns the largest displacement of a stored pose,
    /// m; `None` if the poses are kept: with odometry without drift (`pose_prior`), if the scans have too many parallel passes, or if the scans agree no better at other poses. The same
    /// scans give the same bytes on any number of threads.
    pub fn polish(&mut self, goes_on: &dyn Fn() -> bool) -> Option<f64> {
        self.finish();
        if self.models.config.pose_prior.is_some() {
            return None;
        }
        let farthest = self.loops.polish(&self.models, &mut self.set, goes_on)?;
        self.renew_given();
        Some(farthest)
    }

    /// map_from_base of the best particle at the last processed scan.
    pub fn pose(&self) -> Pose2 {
        in_metres(&self.models.config, self.set.best().pose)
    }

    /// The best particle's poses at the stored scans of this run.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose2)> {
        self.set.trajectory().split_off(self.set.first_pose_of_run)
    }

    /// The best particle's poses at all processed scans of this run, including dropped ones.
    pub fn whole_trajectory(&self) -> Vec<(Stamp, Pose2)> {
        self.loops.history.dropped.whole(&self.set.trajectory(), self.set.first_pose_of_run)
    }

    /// Map of the best particle. Only tiles written since the last call are updated.
    pub fn grid(&mut self) -> &OccupancyGrid {
        self.publisher.show(&self.set.best().map);
        self.publisher.grid()
    }

    /// Bytes of maps, ancestry and buffers; tiles that particles share count once.
    pub fn bytes(&self) -> usize {
        let redraw = self.loops.redraw.iter().map(|redraw| &redraw.map);
        let maps = tile_bytes(self.set.particles.iter().map(|p| &p.map).chain(redraw));
        maps + self.set.ancestry.bytes() + self.loops.history.bytes()
    }

    /// Number of changes that [`ParticleMapper::grid`] has published.
    pub fn revision(&self) -> u64 {
        self.publisher.revision()
    }

    /// Parts of the last grid that changed after `revision`: lowest cell and (columns, rows) of each.
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.publisher.changes_since(revision)
    }

    /// The best particle's map.
    pub(crate) fn best_map(&self) -> &TileMap {
        &self.set.best().map
    }

    /// Declares the pose in the map unknown, as after loading the map for another run. A search for the robot begins, and the map does not
    /// change until the robot is found. The trajectory of a new run begins.
    pub fn kidnapped(&mut self) {
        self.finish();
        self.search_anew();
        self.given = None;
        self.set.first_pose_of_run = self.loops.history.scans.len();
    }

    /// Starts a search of the next scans in the map. A wrong place would contradict the given map and pause mapping again.
    fn search_anew(&mut self) {
        (self.global_search, self.search_pyramid) = (Some(GlobalSearch::default()), None);
        self.gate = UpdateGate::default();
        self.odometry.map_from_odom = None;
    }

    /// Searches the best particle's map for the robot; all particles continue from the found pose.
    fn relocalize(&mut self, stamp: Stamp) -> ScanUpdate {
        let map = self.set.best().map.clone();
        if self.search_pyramid.is_none() {
            self.search_pyramid = Pyramid::new(&map);
        }
        let Some(search) = &mut self.global_search else { return ScanUpdate::Still };
        let Some(pyramid) = &self.search_pyramid else { return ScanUpdate::Lost(Lost::NothingToSee) };
        match search.search((&self.models.config, &self.models.likelihood), &map, pyramid) {
            Ok(found) => self.continue_at(stamp, &found, map),
            Err(lost) => ScanUpdate::Lost(lost),
        }
    }

    /// Moves all particles to the place found in `map`, the best particle's map.
    fn continue_at(&mut self, stamp: Stamp, found: &CloudMatch, map: TileMap) -> ScanUpdate {
        (self.global_search, self.search_pyramid) = (None, None);
        let mut trajectory = self.set.trajectory();
        let pose = in_metres(&self.models.config, found.pose);
        let history = &mut self.loops.history;
        self.given.get_or_insert_with(|| GivenMap::new(map.clone(), history.scans.len()));
        history.measure(&trajectory.iter().map(|(_, pose)| *pose).collect::<Vec<_>>());
        // The common map constrains the two runs relative to each other.
        let variances = Vector3::new(NEXT_RUN_VARIANCE_M2, NEXT_RUN_VARIANCE_M2, NEXT_RUN_VARIANCE_RAD2);
        let covariance = Matrix3::from_diagonal(&variances);
        history.push(StoredScan::new(&self.models.config, &self.points), covariance);
        trajectory.push((stamp, pose));
        self.set.collapse(trajectory, found.pose, &map);
        self.set.particles.iter_mut().for_each(|particle| particle.proposal = None);
        self.updates += 1;
        ScanUpdate::Found(pose)
    }

    /// Contradiction of the last scans with the given map, if long enough. The last scan is not stored yet.
    fn contradiction(&mut self, stamp: Stamp) -> Option<Streak> {
        let (pose, scans) = (self.set.best().pose, self.loops.history.scans.len());
        self.given.as_mut()?.check(&self.models, &self.points, pose, (stamp, scans))
    }

    /// Removes the scans of a streak from trajectory and map, and starts a search for the robot in the remaining map.
    fn pause(&mut self, streak: Streak) -> ScanUpdate {
        let stored = self.loops.history.scans.len();
        let removed_scans = stored - streak.scans_before;
        let mut trajectory = self.set.trajectory();
        trajectory.truncate(streak.scans_before);
        let map = self.map_before(&trajectory);
        self.loops.truncate(streak.scans_before);
        let last = trajectory.last().map_or(Pose2::IDENTITY, |(_, pose)| *pose);
        self.set.collapse(trajectory, in_cells(&self.models.config, last), &map);
        self.search_anew();
        ScanUpdate::Paused(MappingPause { since: streak.since, removed_scans })
    }

    /// Replaces the given map by the present one, after a correction that moved the map.
    fn renew_given(&mut self) {
        if self.given.is_some() {
            self.given = Some(GivenMap::new(self.set.best().map.clone(), self.loops.history.scans.len()));
        }
    }

    /// The given map with the scans of this run up to the end of `trajectory`.
    fn map_before(&self, trajectory: &[(Stamp, Pose2)]) -> TileMap {
        let Some(given) = &self.given else { return self.set.best().map.clone() };
        let mut map = given.map.clone();
        for (k, (_, pose)) in trajectory.iter().enumerate().skip(given.scans) {
            self.loops.draw_scan(&self.models, &mut map, k, in_cells(&self.models.config, *pose));
        }
        map
    }
}

/// Covariance of the step to the last pose in its frame: m, m, rad.
fn step_covariance(proposal: Option<&Proposal>, resolution: f64) -> Matrix3<f64> {
    let floor = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 2e-5));
    let Some(proposal) = proposal else { return floor };
    let (s, c) = proposal.pose.theta.sin_cos();
    let base_from_map = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    floor + base_from_map * scaled(proposal.covariance, resolution) * base_from_map.transpose()
}
