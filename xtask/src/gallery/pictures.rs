//! Pictures of the gallery that the measurements' commands draw.

use crate::program;
use std::path::Path;

/// Measurement, picture in the output folder of its command, and its file below `docs/pictures`.
pub const PICTURES: [(&str, &str, &str); 5] = [
    ("poses", "paths.png", "poses.png"),
    ("obstacles", "seed-1.png", "gallery/obstacles.png"),
    ("corridor", "corridor.png", "docking-scenarios.png"),
    ("barn", "median.png", "gallery/barn.png"),
    ("mrpb", "room02-2-seed-1.png", "gallery/mrpb.png"),
];

/// Copies the pictures of a measurement that was just repeated.
pub fn take(root: &Path, measurement: &str) -> Result<(), String> {
    for (_, drawn, file) in PICTURES.iter().filter(|(name, _, _)| *name == measurement) {
        let drawn = program::target(root)?.join("results").join(measurement).join(drawn);
        let file = root.join("docs/pictures").join(file);
        std::fs::copy(&drawn, &file)
            .map_err(|e| format!("cannot copy {} to {}: {e}", drawn.display(), file.display()))?;
        println!("wrote {}", file.display());
    }
    Ok(())
}
