//! Models of the particle filter: settings, likelihood of scans, and ray update of the maps.

use crate::particle_config::ParticleConfig;
use crate::scan_match::likelihood::Likelihood;
use trundle_core::{Cell, Invalid, OccupancyGrid};
use trundle_grid::tiles::{NearestField, RayUpdate, TileMap};

/// Reach of the field of nearest obstacles \[m\]: eight sigmas of a laser's hits, four of a depth camera's at 4 m. Source:
/// ours.
const FIELD_REACH_M: f64 = 0.2;
/// Sigma of the coarse likelihood \[cells\]: one step of the coarse search. Source: ours.
const COARSE_SIGMA_CELLS: f64 = 2.0;

/// Settings of a filter with the models derived from them.
#[derive(Debug)]
pub(crate) struct FilterModels {
    pub(crate) config: ParticleConfig,
    pub(crate) likelihood: Likelihood,
    pub(crate) ray_update: RayUpdate,
}

impl FilterModels {
    /// Derives the models from the settings.
    ///
    /// # Errors
    /// When a setting is out of range.
    pub(crate) fn new(config: ParticleConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let reach = (FIELD_REACH_M / config.map.resolution).ceil() as i32;
        Ok(Self {
            likelihood: Likelihood::new(&config),
            ray_update: RayUpdate::new(&config.map, NearestField::new(reach, COARSE_SIGMA_CELLS)),
            config,
        })
    }

    /// Map with the cells of a three-valued grid.
    pub(crate) fn map_from_grid(&self, grid: &OccupancyGrid) -> TileMap {
        let (geometry, resolution) = (grid.geometry(), self.config.map.resolution);
        let mut map = TileMap::default();
        for (i, cell) in grid.cells().iter().enumerate() {
            if *cell != Cell::Unknown {
                let center = geometry.center(geometry.cell(i)) / resolution;
                self.ray_update.set(&mut map, (center.x.floor() as i32, center.y.floor() as i32), *cell);
            }
        }
        map
    }
}
