//! Search for the robot in a loaded map, and the pause of mapping where scans contradict that map.

use crate::loop_closing::stored_scan::StoredScan;
use crate::rbpf::given_map::{GivenMap, Streak};
use crate::rbpf::mapper::ParticleMapper;
use crate::rbpf::scan_update::{MappingPause, ScanUpdate};
use crate::rbpf::update_gate::UpdateGate;
use crate::scan_match::branch_and_bound::Pyramid;
use crate::scan_match::cloud_match::CloudMatch;
use crate::scan_match::global_search::{GlobalSearch, Lost};
use crate::units::{in_cells, in_metres};
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, Stamp};
use trundle_grid::tiles::TileMap;

/// Variance of the constraint between the last pose of a loaded run and the first of the next, along x and y \[m^2\]. Source: ours.
const NEXT_RUN_VARIANCE_M2: f64 = 0.01;
/// Variance of the heading of that constraint [rad^2]. Source: ours.
const NEXT_RUN_VARIANCE_RAD2: f64 = 4e-4;

impl ParticleMapper {
    /// Declares the pose in the map unknown, as after loading the map for another run. The robot is searched for, and the map does
    /// not change until it is found. The trajectory of a new run begins.
    pub fn kidnapped(&mut self) {
        self.finish();
        self.search_anew();
        self.given = None;
        self.set.first_pose_of_run = self.loops.history.scans.len();
    }

    /// The next scans are searched for in the map. A wrong place would contradict the given map, and mapping pause again.
    fn search_anew(&mut self) {
        (self.global_search, self.search_pyramid) = (Some(GlobalSearch::of_first_proof()), None);
        self.gate = UpdateGate::default();
        self.odometry.map_from_odom = None;
    }

    /// Searches the best particle's map for the robot; all particles continue from where it is found.
    pub(super) fn relocalize(&mut self, stamp: Stamp) -> ScanUpdate {
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

    /// Puts all particles to the place that was found in `map`, the best one's.
    fn continue_at(&mut self, stamp: Stamp, found: &CloudMatch, map: TileMap) -> ScanUpdate {
        (self.global_search, self.search_pyramid) = (None, None);
        let mut trajectory = self.set.trajectory();
        let pose = in_metres(&self.models.config, found.pose);
        let history = &mut self.loops.history;
        self.given.get_or_insert_with(|| GivenMap::new(map.clone(), history.scans.len()));
        history.measure(&trajectory.iter().map(|(_, pose)| *pose).collect::<Vec<_>>());
        // The map constrains the two runs to each other.
        let variances = Vector3::new(NEXT_RUN_VARIANCE_M2, NEXT_RUN_VARIANCE_M2, NEXT_RUN_VARIANCE_RAD2);
        let covariance = Matrix3::from_diagonal(&variances);
        history.push(StoredScan::new(&self.models.config, &self.points), covariance);
        trajectory.push((stamp, pose));
        self.set.collapse(trajectory, found.pose, &map);
        self.set.particles.iter_mut().for_each(|particle| particle.proposal = None);
        self.updates += 1;
        ScanUpdate::Found(pose)
    }

    /// Contradiction of the last scans to the given map, if it has lasted long enough. The last scan is not stored yet.
    pub(super) fn contradiction(&mut self, stamp: Stamp) -> Option<Streak> {
        let (pose, scans) = (self.set.best().pose, self.loops.history.scans.len());
        self.given.as_mut()?.check(&self.models, &self.points, pose, (stamp, scans))
    }

    /// Takes the scans of a streak out of trajectory and map, and searches for the robot in the map without them.
    pub(super) fn pause(&mut self, streak: Streak) -> ScanUpdate {
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

    /// Compares further scans with the present map, as after a correction that moved the given one.
    pub(super) fn renew_given(&mut self) {
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
