//! The true occupancy grid of a scene.

use trundle_app::AppError;
use trundle_core::OccupancyGrid;
use trundle_sim::{HeightBand, Scene};

/// Largest number of cells that readers of maps accept: 819 m x 819 m at 5 cm. A larger map is refused. Source: ours.
const MAX_MAP_CELLS: f64 = (1u64 << 28) as f64;

/// The true occupancy grid of a scene, cells of `resolution` m.
///
/// # Errors
/// When the map would have too many cells.
pub fn true_map(scene: &Scene, resolution: f64, band: HeightBand) -> Result<OccupancyGrid, AppError> {
    let (low, high) = scene.world.bounds();
    let size = (high - low).xy() / resolution;
    let cells = size.x.ceil() * size.y.ceil();
    if cells > MAX_MAP_CELLS {
        return Err(AppError::Input(format!(
            "map of '{}' at resolution {resolution} m would have {cells:.3e} cells, expected at most {MAX_MAP_CELLS:.3e}",
            scene.name
        )));
    }
    Ok(scene.world.true_grid(resolution, band)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_has_the_size_of_the_scene_unless_it_is_too_large() {
        let scene = Scene::by_name("room", 1).unwrap();
        let band = HeightBand::new(0.02, 0.6).unwrap();
        let geometry = *true_map(&scene, 0.1, band).unwrap().geometry();
        let (low, high) = scene.world.bounds();
        assert!((geometry.width as f64 * 0.1 - (high.x - low.x)).abs() < 0.21, "{geometry:?}");
        let refused = true_map(&scene, 1e-5, band).unwrap_err().to_string();
        assert!(refused.contains("cells, expected at most"), "{refused}");
    }
}
