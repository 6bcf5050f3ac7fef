//! Global localization of the filter in the map it was loaded with.

use crate::loop_closing::stored_scan::StoredScan;
use crate::rbpf::mapper::{Particle, ParticleMapper};
use crate::rbpf::scan_update::ScanUpdate;
use crate::rbpf::units::in_metres;
use crate::rbpf::update_gate::UpdateGate;
use crate::scan_match::branch_and_bound::Pyramid;
use crate::scan_match::global_search::{GlobalSearch, Lost};
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Cell, OccupancyGrid, Stamp};
use trundle_grid::tiles::TileMap;

/// The part of the filter that goes on in a map which was there before.
impl ParticleMapper {
    /// Tells that the robot may be anywhere in the map, as after loading it for another run: it is looked for, and until it is
    /// found the map does not change. The trajectory begins anew.
    pub fn kidnapped(&mut self) {
        self.finish();
        self.global_search = Some(GlobalSearch::default());
        self.gate = UpdateGate::default();
        self.map_from_odom = None;
        self.first_pose_of_run = self.history.scans.len();
    }

    /// Looks for the robot in the best particle's map; all particles go on from where it is found.
    pub(crate) fn search(&mut self, stamp: Stamp) -> ScanUpdate {
        let best = self.best();
        let map = self.particles[best].map.clone();
        let Some(pyramid) = Pyramid::new(&map) else { return ScanUpdate::Lost(Lost::NothingToSee) };
        let Some(search) = &self.global_search else { return ScanUpdate::Still };
        let found = match search.look((&self.config, &self.likelihood), &map, &pyramid) {
            Ok(found) => found,
            Err(lost) => return ScanUpdate::Lost(lost),
        };
        self.global_search = None;
        let way = self.full_trajectory();
        let pose = in_metres(&self.config, found.pose);
        self.history.measure(&way.iter().map(|(_, pose)| *pose).collect::<Vec<_>>());
        // The old way and the new are tied by the map: as well as its parts are known to each other.
        self.history
            .push(StoredScan::new(&self.shape), Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 4e-4)));
        for particle in &mut self.particles {
            *particle = Particle { pose: found.pose, log_weight: 0.0, map: map.clone(), proposal: None };
        }
        self.first_pose_of_run = way.len();
        self.ancestry.replace(way.into_iter().chain([(stamp, pose)]).collect());
        self.parents = vec![0; self.particles.len()];
        self.updates += 1;
        ScanUpdate::Found(pose)
    }

    /// A map of tiles that says what a three-valued one says.
    pub(crate) fn map_of(&self, grid: &OccupancyGrid) -> TileMap {
        let mut map = TileMap::default();
        let geometry = grid.geometry();
        let resolution = self.config.map.resolution;
        for (i, cell) in grid.cells().iter().enumerate() {
            if *cell != Cell::Unknown {
                let center = geometry.center(geometry.cell(i)) / resolution;
                self.ray_update.set(&mut map, (center.x.floor() as i32, center.y.floor() as i32), *cell);
            }
        }
        map
    }
}
