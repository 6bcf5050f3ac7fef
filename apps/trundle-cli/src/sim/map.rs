use std::path::Path;
use trundle::app::AppError;
use trundle::core::OccupancyGrid;
use trundle::io::{OutputFolder, write_map};
use trundle::sim::{HeightBand, Scene};

/// Most cells of a map that is written: what a reader of maps takes, 819 m a side at 5 cm.
const MAX_CELLS: f64 = (1u64 << 28) as f64;

/// The true occupancy grid of a scene, cells of `resolution` m.
pub fn truth(scene: &Scene, resolution: f64, band: HeightBand) -> Result<OccupancyGrid, AppError> {
    let (low, high) = scene.world.bounds();
    let size = (high - low).xy() / resolution;
    let cells = size.x.ceil() * size.y.ceil();
    if cells > MAX_CELLS {
        return Err(AppError::Input(format!(
            "map of '{}' at resolution {resolution} m would have {cells:.3e} cells, expected at most {MAX_CELLS:.3e}",
            scene.name
        )));
    }
    Ok(scene.world.true_grid(resolution, band)?)
}

/// Writes a map as `file` (map_server's YAML) and a PGM beside it.
pub fn write(file: &Path, grid: &OccupancyGrid) -> Result<(), AppError> {
    let is_yaml = file.extension().is_some_and(|extension| extension == "yaml");
    let Some(name) = file.file_stem().and_then(|stem| stem.to_str()).filter(|_| is_yaml) else {
        return Err(AppError::Input(format!(
            "--map is '{}', expected a name ending in .yaml",
            file.display()
        )));
    };
    let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = OutputFolder::create(parent)?;
    write_map(&folder, name, grid)?;
    folder.commit()?;
    Ok(())
}
