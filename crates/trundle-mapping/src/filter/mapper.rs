use super::{
    ParticleConfig, ScanShape,
    ancestry::Ancestry,
    chance::Chance,
    closing::{Closer, Tools},
    coarse::CoarseSearch,
    history::History,
    likelihood::Likelihood,
    motion::{motion_covariance, unknown_motion_covariance},
    proposal::{Proposal, Proposer},
    publish::Publisher,
    resample::{effective, low_variance},
    store::StoredScan,
};
use crate::tiles::{Brush, DrawScratch, FieldModel, TileMap, tile_bytes};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use trundle_core::{CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp};

/// Grid maps from laser scans and odometry by a Rao-Blackwellised particle filter \[Grisetti07\].
///
/// Problem: trajectory and map at once. Each particle is a trajectory with the map that follows from it; a scan moves
/// every particle by the improved proposal (odometry and scan match), draws its map on, and weighs it by how well its
/// map foretold the scan; when few particles hold the weight, the others give way to their copies. Copies share their maps' tiles until
/// one writes. Cost: per scan and particle one match (linear in the beams) and one drawing (linear in the cells that the
/// beams pass); none grows with the length of the run.
#[derive(Debug)]
pub struct ParticleMapper {
    config: ParticleConfig,
    seed: u64,
    updates: u64,
    brush: Brush,
    likelihood: Likelihood,
    shape: ScanShape,
    particles: Vec<Particle>,
    /// Whose copy each particle is since the last column of the ancestry.
    parents: Vec<u16>,
    ancestry: Ancestry,
    scratch: Vec<Scratch>,
    publisher: Publisher,
    history: History,
    closer: Closer,
    last: Option<Last>,
    /// Mean ln p(z | m, x) of a point in the last scans.
    usual: f64,
}

#[derive(Debug, Clone)]
struct Particle {
    /// map_from_base, cells and rad.
    pose: Pose2,
    log_weight: f64,
    map: TileMap,
    proposal: Option<Proposal>,
}

/// What one worker needs.
#[derive(Debug, Clone, Default)]
struct Scratch {
    search: CoarseSearch,
    draw: DrawScratch,
}

/// The last scan that was processed.
#[derive(Debug, Clone, Copy)]
struct Last {
    stamp: Stamp,
    odom_from_base: Pose2,
}

/// What became of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScanUpdate {
    /// The robot has hardly moved: the scan was not looked at.
    Still,
    /// Refused: what is wrong with it.
    Refused(Refusal),
    /// The scan moved the particles and is in their maps.
    Processed(Processed),
}

/// Why a scan was not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// The odometry is not finite.
    NotFinite,
    /// The scan is older than the last one.
    TimeGoesBack,
}

/// A processed scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Processed {
    /// Part of the hits that the best particle's map explains, 0 to 1.
    pub explained: f64,
    /// Part of them that lies on free ground of it with no obstacle near, 0 to 1.
    pub contradicted: f64,
    /// Directions that the best particle left to the odometry, 0 to 3: 3 is no overlap with the map.
    pub degenerate: usize,
    /// Covariance of the Gaussian that the best particle's pose was drawn from: m, m, rad, map frame.
    pub covariance: Matrix3<f64>,
    /// Effective number of particles before resampling.
    pub effective: f64,
    /// Whether particles were resampled.
    pub resampled: bool,
    /// Whether the odometry jumped farther than `jump`: the pose is then held where it was.
    pub jumped: bool,
    /// Whether the scan said that the odometry told nothing true: slipping wheels, lost messages.
    pub slipped: bool,
    /// When a loop was closed and the way bent: how far the pose went that went farthest, m.
    pub bent: Option<f64>,
}

impl ParticleMapper {
    /// A filter that has seen nothing; the first scan's base pose is the map's origin.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: ParticleConfig, seed: u64) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let reach = (FIELD_REACH / config.map.resolution).ceil() as i32;
        let particle =
            Particle { pose: Pose2::IDENTITY, log_weight: 0.0, map: TileMap::default(), proposal: None };
        Ok(Self {
            seed,
            updates: 0,
            brush: Brush::new(&config.map, FieldModel::new(reach, COARSE_SIGMA_CELLS)),
            likelihood: Likelihood::new(&config),
            shape: ScanShape::default(),
            particles: vec![particle; config.particles],
            parents: (0..config.particles as u16).collect(),
            ancestry: Ancestry::default(),
            scratch: Vec::new(),
            publisher: Publisher::new(&config.map),
            history: History::default(),
            closer: Closer::default(),
            last: None,
            usual: USUAL,
            config,
        })
    }

    /// Takes in a scan taken with the base at `odom_from_base` by the odometry.
    pub fn update(&mut self, odom_from_base: Pose2, scan: &Scan) -> ScanUpdate {
        if !odom_from_base.is_finite() {
            return ScanUpdate::Refused(Refusal::NotFinite);
        }
        let motion = match self.last {
            Some(last) if scan.stamp() < last.stamp => return ScanUpdate::Refused(Refusal::TimeGoesBack),
            Some(last) => last.odom_from_base.inverse() * odom_from_base,
            None => Pose2::IDENTITY,
        };
        let jumped = motion.position().norm() > self.config.jump;
        let waited = self.last.map_or(0.0, |last| scan.stamp() - last.stamp);
        let still = waited < self.config.wait_gate
            && motion.position().norm() < self.config.move_gate
            && motion.theta.abs() < self.config.turn_gate_deg.to_radians();
        if self.last.is_some() && still {
            return ScanUpdate::Still;
        }
        self.shape.set(&self.config, scan);
        let first = self.last.is_none();
        self.last = Some(Last { stamp: scan.stamp(), odom_from_base });
        let (motion, covariance) = if jumped {
            (Pose2::IDENTITY, unknown_motion_covariance())
        } else {
            (motion, motion_covariance(&self.config.motion, motion))
        };
        self.move_and_draw(motion, covariance, first);
        let (effective, resampled) = self.weigh();
        self.ancestry.push(
            scan.stamp(),
            self.particles.iter().map(|p| metres(&self.config, p.pose)),
            &self.parents,
        );
        let best = self.best();
        let proposal = self.particles[best].proposal;
        if let Some(proposal) = proposal.filter(|p| p.degenerate < 3) {
            self.usual += USUAL_RATE * (proposal.per_point - self.usual);
        }
        self.history.push(StoredScan::new(&self.shape), self.step_covariance(proposal.as_ref()));
        if resampled {
            self.resample();
        } else {
            self.parents = (0..self.particles.len() as u16).collect();
        }
        let bent = self.close_loops();
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
        metres(&self.config, self.particles[self.best()].pose)
    }

    /// The best particle's poses at the processed scans.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose2)> {
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
        let maps = tile_bytes(self.particles.iter().map(|p| &p.map));
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
    fn move_and_draw(&mut self, motion: Pose2, covariance: Matrix3<f64>, first: bool) {
        let per_metre = 1.0 / self.config.map.resolution;
        let proposer = Proposer {
            config: &self.config,
            likelihood: &self.likelihood,
            shape: &self.shape,
            motion_covariance: scaled(covariance, per_metre),
            usual: self.usual,
        };
        let motion = Pose2 { x: motion.x * per_metre, y: motion.y * per_metre, ..motion };
        let (seed, updates, brush, shape) = (self.seed, self.updates, &self.brush, &self.shape);
        let workers = rayon::current_num_threads().clamp(1, self.particles.len());
        let share = self.particles.len().div_ceil(workers);
        self.scratch.resize_with(workers, Scratch::default);
        let shares = self.particles.par_chunks_mut(share).zip(&mut self.scratch).enumerate();
        shares.for_each(|(worker, (particles, scratch))| {
            for (i, particle) in particles.iter_mut().enumerate() {
                if !first {
                    let mut chance = Chance::new(seed, updates, worker * share + i);
                    let guess = particle.pose * motion;
                    let found = proposer.propose(
                        &particle.map,
                        &mut scratch.search,
                        particle.pose,
                        guess,
                        &mut chance,
                    );
                    particle.pose = found.pose;
                    particle.log_weight += found.log_weight * proposer.weight_scale();
                    particle.proposal = Some(found);
                }
                brush.draw(&mut particle.map, &mut scratch.draw, particle.pose, shape);
            }
        });
    }

    /// Covariance of the step to the last pose in its frame: m, m, rad.
    fn step_covariance(&self, proposal: Option<&Proposal>) -> Matrix3<f64> {
        let least = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 2e-5));
        let Some(proposal) = proposal else { return least };
        let (s, c) = proposal.pose.theta.sin_cos();
        let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
        least + turn * scaled(proposal.covariance, self.config.map.resolution) * turn.transpose()
    }

    /// Looks for loops; where one is closed, the best particle's way and map are bent, and all go on from there.
    fn close_loops(&mut self) -> Option<f64> {
        let trajectory = self.trajectory();
        let poses: Vec<Pose2> = trajectory.iter().map(|(_, pose)| *pose).collect();
        let tools = Tools { config: &self.config, brush: &self.brush, likelihood: &self.likelihood };
        let closing = self.closer.look(&tools, &mut self.history, &poses)?;
        if closing.farthest < self.config.map.resolution {
            return None;
        }
        let mut map = TileMap::default();
        let mut draw = DrawScratch::default();
        let per_metre = 1.0 / self.config.map.resolution;
        let cells = |pose: Pose2| Pose2 { x: pose.x * per_metre, y: pose.y * per_metre, ..pose };
        for (scan, pose) in self.history.scans.iter().zip(&closing.poses) {
            self.shape.set_stored(&self.config, scan);
            self.brush.draw(&mut map, &mut draw, cells(*pose), &self.shape);
        }
        let stamps = trajectory.iter().map(|(stamp, _)| *stamp);
        self.ancestry.replace(stamps.zip(closing.poses.iter().copied()).collect());
        let last = *closing.poses.last().expect("invariant: loops are closed of some poses");
        for particle in &mut self.particles {
            particle.pose = cells(last);
            particle.log_weight = 0.0;
            particle.map = map.clone();
        }
        self.parents = vec![0; self.particles.len()];
        Some(closing.farthest)
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
        let uniform = Chance::new(self.seed, self.updates, self.particles.len()).uniform();
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
    fn best(&self) -> usize {
        let better = |best: usize, i: usize| {
            if self.particles[i].log_weight > self.particles[best].log_weight { i } else { best }
        };
        (1..self.particles.len()).fold(0, better)
    }
}

/// What a point of a scan is like before any was seen, nats: half of the points at obstacles, half on unknown ground.
const USUAL: f64 = -1.0;
/// Weight of a new scan in what is usual: about the last twenty count.
const USUAL_RATE: f64 = 0.05;
/// How far the field of nearest obstacles reaches, m.
const FIELD_REACH: f64 = 0.3;
/// Sigma of the coarse search, cells: one step of it.
const COARSE_SIGMA_CELLS: f64 = 2.0;

fn metres(config: &ParticleConfig, pose: Pose2) -> Pose2 {
    Pose2 { x: pose.x * config.map.resolution, y: pose.y * config.map.resolution, ..pose }
}

/// A covariance of a pose whose lengths are given in units of `unit` m: m, m, rad.
fn scaled(covariance: Matrix3<f64>, unit: f64) -> Matrix3<f64> {
    let scale = Matrix3::from_diagonal(&Vector3::new(unit, unit, 1.0));
    scale * covariance * scale
}
