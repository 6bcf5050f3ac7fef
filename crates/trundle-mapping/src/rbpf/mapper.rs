//! Rao-Blackwellised particle filter for grid mapping.

use crate::loop_closing::loop_closer::LoopCloser;
use crate::loop_closing::scan_history::ScanHistory;
use crate::loop_closing::stored_scan::StoredScan;
use crate::particle_config::ParticleConfig;
use crate::rbpf::absolute_pose::AbsolutePose;
use crate::rbpf::ancestry::Ancestry;
use crate::rbpf::map_publisher::MapPublisher;
use crate::rbpf::map_redraw::MapRedraw;
use crate::rbpf::odometry_bias::OdometryBias;
use crate::rbpf::odometry_noise::OdometryNoise;
use crate::rbpf::proposal::{Proposal, Proposer};
use crate::rbpf::resampling::{effective, low_variance};
use crate::rbpf::rng::ParticleRng;
use crate::rbpf::scan_update::{Processed, ScanUpdate};
use crate::rbpf::units::{in_metres, scaled};
use crate::rbpf::update_gate::{OdometryStep, UpdateGate};
use crate::scan_match::coarse_search::CoarseSearch;
use crate::scan_match::global_search::GlobalSearch;
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::Matrix3;
use rayon::prelude::*;
use trundle_core::{CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp};
use trundle_grid::tiles::{NearestField, RayUpdate, RayUpdateScratch, TileMap, tile_bytes};

/// Grid maps from laser scans and odometry by a Rao-Blackwellised particle filter \[Grisetti07\].
///
/// Problem: trajectory and map at once. Each particle is a trajectory with the map that follows from it; a scan moves
/// every particle by the improved proposal (odometry and scan match), draws its map on, and weighs it by how well its
/// map foretold the scan; when few particles hold the weight, the others give way to their copies. Copies share their
/// maps' tiles until one writes. What the particles cannot span, a loop after a long way, is searched for and proved, and
/// the way is bent. Cost: per scan and particle one match (linear in the beams) and one drawing (linear in the cells that
/// the beams pass); per 2 m a look for loops, n log n in the scans kept (at most `most_scans`). A loop that bends the way has
/// the map drawn anew, four million cells with each scan: nothing else grows with the length of the run.
#[derive(Debug)]
pub struct ParticleMapper {
    pub(crate) config: ParticleConfig,
    pub(crate) seed: u64,
    pub(crate) updates: u64,
    pub(crate) ray_update: RayUpdate,
    pub(crate) likelihood: Likelihood,
    pub(crate) shape: ScanPoints,
    pub(crate) particles: Vec<Particle>,
    /// Whose copy each particle is since the last column of the ancestry.
    pub(crate) parents: Vec<u16>,
    pub(crate) ancestry: Ancestry,
    scratch: Vec<Scratch>,
    publisher: MapPublisher,
    pub(crate) history: ScanHistory,
    pub(crate) loop_closer: LoopCloser,
    /// The map that a loop bends, while it is drawn.
    pub(crate) redraw: Option<MapRedraw>,
    pub(crate) gate: UpdateGate,
    /// map_from_odom of odometry that does not drift, m and rad: its first pose is the map's origin.
    pub(crate) map_from_odom: Option<Pose2>,
    /// The search for the robot in a map that was there before it.
    pub(crate) global_search: Option<GlobalSearch>,
    /// At which pose of the trajectory this run began.
    pub(crate) first_pose_of_run: usize,
    /// Mean ln p(z | m, x) of a point in the last scans.
    pub(crate) expected_log_likelihood: f64,
    /// How good the odometry is.
    pub(crate) odometry_noise: OdometryNoise,
    /// What it has wrong at every step.
    pub(crate) odometry_bias: OdometryBias,
}

#[derive(Debug, Clone)]
pub(crate) struct Particle {
    /// map_from_base, cells and rad.
    pub(crate) pose: Pose2,
    pub(crate) log_weight: f64,
    pub(crate) map: TileMap,
    pub(crate) proposal: Option<Proposal>,
}

/// What one worker needs.
#[derive(Debug, Clone, Default)]
struct Scratch {
    search: CoarseSearch,
    draw: RayUpdateScratch,
}

impl ParticleMapper {
    /// A filter that has seen nothing; the first scan's base pose is the map's origin.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: ParticleConfig, seed: u64) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let reach = (FIELD_REACH_M / config.map.resolution).ceil() as i32;
        let particle =
            Particle { pose: Pose2::IDENTITY, log_weight: 0.0, map: TileMap::default(), proposal: None };
        Ok(Self {
            seed,
            updates: 0,
            ray_update: RayUpdate::new(&config.map, NearestField::new(reach, COARSE_SIGMA_CELLS)),
            likelihood: Likelihood::new(&config),
            shape: ScanPoints::default(),
            particles: vec![particle; config.particles],
            parents: (0..config.particles as u16).collect(),
            ancestry: Ancestry::default(),
            scratch: Vec::new(),
            publisher: MapPublisher::new(&config.map),
            history: ScanHistory::default(),
            loop_closer: LoopCloser::default(),
            redraw: None,
            gate: UpdateGate::default(),
            map_from_odom: None,
            global_search: None,
            first_pose_of_run: 0,
            expected_log_likelihood: EXPECTED_LOG_LIKELIHOOD,
            odometry_noise: OdometryNoise::default(),
            odometry_bias: OdometryBias::default(),
            config,
        })
    }

    /// Takes in a scan taken with the base at `odom_from_base` by the odometry.
    pub fn update(&mut self, odom_from_base: Pose2, scan: &Scan) -> ScanUpdate {
        let poses_count = self.map_from_odom.is_some();
        let step = match self.gate.pass(&self.config, poses_count, odom_from_base, scan) {
            Ok(Some(step)) => step,
            Ok(None) => return ScanUpdate::Still,
            Err(refusal) => return ScanUpdate::Refused(refusal),
        };
        self.shape.set(&self.config, scan);
        let odom_cells = self.cells(odom_from_base);
        if let Some(search) = &mut self.global_search {
            search.push(&self.shape, odom_cells);
            return self.search(scan.stamp());
        }
        let first = step.first && self.updates == 0;
        if first && self.config.pose_prior.is_some() {
            self.map_from_odom = Some(odom_from_base.inverse());
        }
        let anchor =
            self.map_from_odom.and_then(|origin| AbsolutePose::new(&self.config, origin * odom_from_base));
        let jumped = step.jumped;
        let covariance = if jumped { step.covariance } else { self.odometry_noise.scaled(&step.covariance) };
        let motion = if jumped { step.motion } else { self.odometry_bias.corrected(step.motion) };
        self.move_and_draw((motion, covariance), anchor, first);
        let (effective, resampled) = self.weigh();
        self.ancestry.push(
            scan.stamp(),
            self.particles.iter().map(|p| in_metres(&self.config, p.pose)),
            &self.parents,
        );
        let best = self.best();
        let proposal = self.particles[best].proposal;
        if let Some(proposal) = proposal.filter(|p| p.degenerate < 3) {
            self.expected_log_likelihood +=
                EXPECTED_LOG_LIKELIHOOD_RATE * (proposal.per_point - self.expected_log_likelihood);
        }
        if anchor.is_none() {
            self.learn_odometry(&step, proposal.as_ref());
        }
        self.history.push(StoredScan::new(&self.shape), self.step_covariance(proposal.as_ref()));
        if resampled {
            self.resample();
        } else {
            self.parents = (0..self.particles.len() as u16).collect();
        }
        let bent = if anchor.is_none() { self.close_loops(step.motion.position().norm()) } else { None };
        self.thin_history();
        self.updates += 1;
        ScanUpdate::Processed(Processed {
            explained: proposal.map_or(0.0, |p| p.explained),
            contradicted: proposal.map_or(0.0, |p| p.contradicted),
            degenerate: proposal.map_or(0, |p| p.degenerate),
            covariance: proposal
                .map_or(Matrix3::zeros(), |p| scaled(p.covariance, self.config.map.resolution)),
            effective,
            resampled,
            jumped,
            slipped: proposal.is_some_and(|p| p.slipped),
            bent,
        })
    }

    /// map_from_base of the best particle at the last processed scan.
    pub fn pose(&self) -> Pose2 {
        in_metres(&self.config, self.particles[self.best()].pose)
    }

    /// The best particle's poses at the processed scans of this run.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose2)> {
        self.full_trajectory().split_off(self.first_pose_of_run)
    }

    /// The same from the first run on.
    pub(crate) fn full_trajectory(&self) -> Vec<(Stamp, Pose2)> {
        // The last resampling is not in the ancestry yet: parents lead from the particles to its last column.
        let best = self.best();
        self.ancestry.trajectory(usize::from(self.parents[best]))
    }

    /// The map of the best particle, brought up to date in place: only what was written since the last call is touched.
    pub fn grid(&mut self) -> &OccupancyGrid {
        let best = self.best();
        self.publisher.show(&self.particles[best].map);
        self.publisher.grid()
    }

    /// Bytes that maps, ancestry and buffers hold; tiles that particles share count once.
    pub fn bytes(&self) -> usize {
        let bending = self.redraw.iter().map(|bending| &bending.map);
        let maps = tile_bytes(self.particles.iter().map(|p| &p.map).chain(bending));
        maps + self.ancestry.bytes() + self.history.bytes()
    }

    /// Counts the changes that [`ParticleMapper::grid`] has shown.
    pub fn revision(&self) -> u64 {
        self.publisher.revision()
    }

    /// The parts of the last grid that changed after `revision`: lowest cell and (columns, rows) of each.
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.publisher.changes_since(revision)
    }

    /// Moves every particle by the proposal, and draws the scan into its map.
    fn move_and_draw(
        &mut self,
        (motion, covariance): (Pose2, Matrix3<f64>),
        anchor: Option<AbsolutePose>,
        first: bool,
    ) {
        let per_metre = 1.0 / self.config.map.resolution;
        let proposer = Proposer {
            config: &self.config,
            likelihood: &self.likelihood,
            shape: &self.shape,
            motion_covariance: scaled(covariance, per_metre),
            anchor,
            expected_log_likelihood: self.expected_log_likelihood,
        };
        let motion = Pose2 { x: motion.x * per_metre, y: motion.y * per_metre, ..motion };
        let (seed, updates, ray_update, shape) = (self.seed, self.updates, &self.ray_update, &self.shape);
        let workers = rayon::current_num_threads().clamp(1, self.particles.len());
        let share = self.particles.len().div_ceil(workers);
        self.scratch.resize_with(workers, Scratch::default);
        // Where the odometry failed it did so for all particles: the best one looks for where they are.
        let best = &self.particles[best_of(&self.particles)];
        let places = (best.pose, best.pose * motion);
        let far =
            if first { Vec::new() } else { proposer.far(&best.map, &mut self.scratch[0].search, places) };
        let shares = self.particles.par_chunks_mut(share).zip(&mut self.scratch).enumerate();
        shares.for_each(|(worker, (particles, scratch))| {
            for (i, particle) in particles.iter_mut().enumerate() {
                if !first {
                    let mut rng = ParticleRng::new(seed, updates, worker * share + i);
                    let guess = particle.pose * motion;
                    let found = proposer.propose(
                        (&particle.map, &far),
                        &mut scratch.search,
                        (particle.pose, guess),
                        &mut rng,
                    );
                    particle.pose = found.pose;
                    particle.log_weight += found.log_weight * proposer.weight_scale();
                    particle.proposal = Some(found);
                }
                ray_update.apply(&mut particle.map, &mut scratch.draw, particle.pose, &shape.rays);
            }
        });
    }

    fn learn_odometry(&mut self, step: &OdometryStep, proposal: Option<&Proposal>) {
        let Some(proposal) = proposal.filter(|_| !step.jumped) else { return };
        if proposal.slipped {
            self.odometry_noise.doubt();
        } else if let Some(innovation) = proposal.innovation {
            let (unit, configured) = (self.config.map.resolution, step.covariance);
            let noise = scaled(self.odometry_noise.scaled(&configured), 1.0 / unit).diagonal();
            self.odometry_bias.learn(step.motion, &innovation, noise, unit);
            self.odometry_noise.learn(&innovation, &scaled(configured, 1.0 / unit));
        }
    }

    pub(crate) fn cells(&self, pose: Pose2) -> Pose2 {
        let per_metre = 1.0 / self.config.map.resolution;
        Pose2 { x: pose.x * per_metre, y: pose.y * per_metre, ..pose }
    }

    /// The best particle's map.
    pub(crate) fn best_map(&self) -> &TileMap {
        &self.particles[self.best()].map
    }

    /// Normalises the weights; the effective number of particles, and whether it is too low.
    fn weigh(&mut self) -> (f64, bool) {
        let greatest = self.particles.iter().map(|p| p.log_weight).fold(f64::NEG_INFINITY, f64::max);
        for particle in &mut self.particles {
            particle.log_weight -= greatest;
        }
        let effective = effective(&self.weights());
        (effective, effective < self.config.resample_below * self.particles.len() as f64)
    }

    fn weights(&self) -> Vec<f64> {
        self.particles.iter().map(|p| p.log_weight.exp()).collect()
    }

    fn resample(&mut self) {
        // One past the particles' own streams.
        let uniform = ParticleRng::new(self.seed, self.updates, self.particles.len()).uniform();
        self.parents = low_variance(&self.weights(), uniform);
        for i in 0..self.particles.len() {
            let parent = usize::from(self.parents[i]);
            if parent != i {
                self.particles[i] = self.particles[parent].clone();
            }
        }
        self.particles.iter_mut().for_each(|p| p.log_weight = 0.0);
    }

    /// The particle of the greatest weight, the first of equals.
    pub(crate) fn best(&self) -> usize {
        best_of(&self.particles)
    }
}

fn best_of(particles: &[Particle]) -> usize {
    let better = |best: usize, i: usize| {
        if particles[i].log_weight > particles[best].log_weight { i } else { best }
    };
    (1..particles.len()).fold(0, better)
}

/// Mean log-likelihood of a point before the first scan [nats]: half of the points at obstacles, half on unknown ground.
/// Source: ours.
pub(crate) const EXPECTED_LOG_LIKELIHOOD: f64 = -1.0;
/// Weight of a new scan in the running mean log-likelihood [1]. The mean covers about the last twenty scans. Source:
/// ours.
pub(crate) const EXPECTED_LOG_LIKELIHOOD_RATE: f64 = 0.05;
/// Reach of the field of nearest obstacles [m]: eight sigmas of a laser's hits, four of a depth camera's at 4 m. Source:
/// ours.
const FIELD_REACH_M: f64 = 0.2;
/// Sigma of the coarse likelihood [cells]: one step of the coarse search. Source: ours.
const COARSE_SIGMA_CELLS: f64 = 2.0;
