//! The file of `trundle sim --map`.

use std::path::Path;
use trundle::app::AppError;
use trundle::core::OccupancyGrid;
use trundle::io::{OutputFolder, write_map};

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
