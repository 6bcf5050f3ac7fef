//! The file of `trundle sim --map`.

use crate::output_args::write_file;
use std::path::Path;
use trundle::app::AppError;
use trundle::core::OccupancyGrid;
use trundle::io::{MapImage, map_picture, map_yaml};

/// Writes a map as `file` (map_server's YAML) and a picture beside it.
pub fn write(file: &Path, grid: &OccupancyGrid, image: MapImage) -> Result<(), AppError> {
    let is_yaml = file.extension().is_some_and(|extension| extension == "yaml");
    let Some(name) = file.file_stem().and_then(|stem| stem.to_str()).filter(|_| is_yaml) else {
        return Err(AppError::Input(format!(
            "--map is '{}', expected a name ending in .yaml",
            file.display()
        )));
    };
    let (picture, bytes) = map_picture(name, grid, image)?;
    write_file(&file.with_file_name(&picture), &bytes)?;
    write_file(file, map_yaml(grid, &picture).as_bytes())
}
