use super::{
    ParticleConfig, ScanShape,
    ancestry::Ancestry,
    chance::Chance,
    closing::{Closer, Tools},
    coarse::CoarseSearch,
    find::Pyramid,
    gate::Gate,
    history::History,
    likelihood::Likelihood,
    locate::{GlobalSearch, Lost},
    proposal::{Proposal, Proposer},
    publish::Publisher,
    resample::{effective, low_variance},
    store::StoredScan,
};
use crate::tiles::{Brush, DrawScratch, FieldModel, TileMap, tile_bytes};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Stamp};

/// Grid maps from laser scans and odometry by a Rao-Blackwellised particle filter \[Grisetti07\].
///
/// Problem: trajectory and map at once. Each particle is a trajectory with the map that follows from it; a scan moves
/// every particle by the improved proposal (odometry and scan match), draws its map on, and weighs it by how well its
/// map foretold the scan; when few particles hold the weight, the others give way to their copies. Copies share their maps' tiles until
/// one writes. Cost: per scan and particle one match (linear in the beams) and one drawing (linear in the cells that the
/// beams pass); none grows with the length of the run.
#[derive(Debug)]
pub struct ParticleMapper {
    pub(super) config: ParticleConfig,
    pub(super) seed: u64,
    pub(super) updates: u64,
    pub(super) brush: Brush,
    likelihood: Likelihood,
    shape: ScanShape,
    pub(super) particles: Vec<Particle>,
    /// Whose copy each particle is since the last column of the ancestry.
    pub(super) parents: Vec<u16>,
    pub(super) ancestry: Ancestry,
    scratch: Vec<Scratch>,
    publisher: Publisher,
    pub(super) history: History,
    pub(super) closer: Closer,
    pub(super) gate: Gate,
    /// The search for the robot in a map that was there before it.
    lost: Option<GlobalSearch>,
    /// At which pose of the trajectory this run began.
    pub(super) session: usize,
    /// Mean ln p(z | m, x) of a point in the last scans.
    pub(super) usual: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Particle {
    /// map_from_base, cells and rad.
    pub(super) pose: Pose2,
    pub(super) log_weight: f64,
    pub(super) map: TileMap,
    pub(super) proposal: Option<Proposal>,
}

/// What one worker needs.
#[derive(Debug, Clone, Default)]
struct Scratch {
    search: CoarseSearch,
    draw: DrawScratch,
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
    /// Where the robot is in the map is not known yet, after [`ParticleMapper::kidnapped`]: the map does not change.
    Lost(Lost),
    /// It is known from now on.
    Found(Pose2),
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
            gate: Gate::default(),
            lost: None,
            session: 0,
            usual: USUAL,
            config,
        })
    }

    /// Takes in a scan taken with the base at `odom_from_base` by the odometry.
    pub fn update(&mut self, odom_from_base: Pose2, scan: &Scan) -> ScanUpdate {
        let step = match self.gate.pass(&self.config, odom_from_base, scan) {
            Ok(Some(step)) => step,
            Ok(None) => return ScanUpdate::Still,
            Err(refusal) => return ScanUpdate::Refused(refusal),
        };
        self.shape.set(&self.config, scan);
        let odom_cells = self.cells(odom_from_base);
        if let Some(search) = &mut self.lost {
            search.push(&self.shape, odom_cells);
            return self.search(scan.stamp());
        }
        let jumped = step.jumped;
        self.move_and_draw(step.motion, step.covariance, step.first && self.updates == 0);
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

    /// Tells that the robot may be anywhere in the map, as after loading it for another run: it is looked for, and until it is
    /// found the map does not change. The trajectory begins anew.
    pub fn kidnapped(&mut self) {
        self.lost = Some(GlobalSearch::default());
        self.gate = Gate::default();
        self.session = self.history.scans.len();
    }

    /// Looks for the robot in the best particle's map; all particles go on from where it is found.
    fn search(&mut self, stamp: Stamp) -> ScanUpdate {
        let best = self.best();
        let map = self.particles[best].map.clone();
        let Some(pyramid) = Pyramid::new(&map) else { return ScanUpdate::Lost(Lost::NothingToSee) };
        let Some(search) = &self.lost else { return ScanUpdate::Still };
        let found = match search.look((&self.config, &self.likelihood), &map, &pyramid) {
            Ok(found) => found,
            Err(lost) => return ScanUpdate::Lost(lost),
        };
        self.lost = None;
        let way = self.way();
        let pose = metres(&self.config, found.pose);
        self.history.measure(&way.iter().map(|(_, pose)| *pose).collect::<Vec<_>>());
        // The old way and the new are tied by the map: as well as its parts are known to each other.
        self.history
            .push(StoredScan::new(&self.shape), Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 4e-4)));
        for particle in &mut self.particles {
            *particle = Particle { pose: found.pose, log_weight: 0.0, map: map.clone(), proposal: None };
        }
        self.session = way.len();
        self.ancestry.replace(way.into_iter().chain([(stamp, pose)]).collect());
        self.parents = vec![0; self.particles.len()];
        self.updates += 1;
        ScanUpdate::Found(pose)
    }

    /// map_from_base of the best particle at the last processed scan.
    pub fn pose(&self) -> Pose2 {
        metres(&self.config, self.particles[self.best()].pose)
    }

    /// The best particle's poses at the processed scans of this run.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose2)> {
        self.way().split_off(self.session)
    }

    /// The same from the first run on.
    fn way(&self) -> Vec<(Stamp, Pose2)> {
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
        let trajectory = self.way();
        let poses: Vec<Pose2> = trajectory.iter().map(|(_, pose)| *pose).collect();
        let tools = Tools { config: &self.config, brush: &self.brush, likelihood: &self.likelihood };
        let closing = self.closer.look(&tools, &mut self.history, &poses)?;
        if closing.farthest < self.config.map.resolution {
            return None;
        }
        let mut map = TileMap::default();
        let mut draw = DrawScratch::default();
        for (scan, pose) in self.history.scans.iter().zip(&closing.poses) {
            self.shape.set_stored(&self.config, scan);
            self.brush.draw(&mut map, &mut draw, self.cells(*pose), &self.shape);
        }
        let stamps = trajectory.iter().map(|(stamp, _)| *stamp);
        self.ancestry.replace(stamps.zip(closing.poses.iter().copied()).collect());
        let last = *closing.poses.last().expect("invariant: loops are closed of some poses");
        let pose = self.cells(last);
        for particle in &mut self.particles {
            particle.pose = pose;
            particle.log_weight = 0.0;
            particle.map = map.clone();
        }
        self.parents = vec![0; self.particles.len()];
        Some(closing.farthest)
    }

    /// Keeps the store of scans within its bounds.
    fn thin_history(&mut self) {
        if self.history.scans.len() > self.config.most_scans {
            let count = (self.config.most_scans / 2).min(self.ancestry.shared.len());
            let before = self.history.scans.len();
            self.history.thin(&mut self.ancestry.shared, count);
            let gone = before - self.history.scans.len();
            self.session = if self.session < count { self.session.div_ceil(2) } else { self.session - gone };
            self.closer.pending.clear();
        }
    }

    fn cells(&self, pose: Pose2) -> Pose2 {
        let per_metre = 1.0 / self.config.map.resolution;
        Pose2 { x: pose.x * per_metre, y: pose.y * per_metre, ..pose }
    }

    /// The best particle's map.
    pub(super) fn best_map(&self) -> &TileMap {
        &self.particles[self.best()].map
    }

    /// A map of tiles that says what a three-valued one says.
    pub(super) fn map_of(&self, grid: &OccupancyGrid) -> TileMap {
        let mut map = TileMap::default();
        let geometry = grid.geometry();
        let resolution = self.config.map.resolution;
        for (i, cell) in grid.cells().iter().enumerate() {
            if *cell != Cell::Unknown {
                let center = geometry.center(geometry.cell(i)) / resolution;
                self.brush.assert(&mut map, (center.x.floor() as i32, center.y.floor() as i32), *cell);
            }
        }
        map
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
pub(super) const USUAL: f64 = -1.0;
/// Weight of a new scan in what is usual: about the last twenty count.
pub(super) const USUAL_RATE: f64 = 0.05;
/// How far the field of nearest obstacles reaches, m.
const FIELD_REACH: f64 = 0.3;
/// Sigma of the coarse search, cells: one step of it.
const COARSE_SIGMA_CELLS: f64 = 2.0;

pub(super) fn metres(config: &ParticleConfig, pose: Pose2) -> Pose2 {
    Pose2 { x: pose.x * config.map.resolution, y: pose.y * config.map.resolution, ..pose }
}

/// A covariance of a pose whose lengths are given in units of `unit` m: m, m, rad.
pub(super) fn scaled(covariance: Matrix3<f64>, unit: f64) -> Matrix3<f64> {
    let scale = Matrix3::from_diagonal(&Vector3::new(unit, unit, 1.0));
    scale * covariance * scale
}
