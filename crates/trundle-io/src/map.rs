//! Maps in the format of the ROS `map_server`: a picture and a YAML file.

mod annotations;
mod areas;
mod degrees;
mod graph;
mod mask;
mod picture;
mod picture_map;
mod places;
mod source;
mod turned;
mod yaml;

pub use annotations::{annotations_text, parse_annotations, read_annotations};
pub use areas::{NamedArea, areas_text};
pub use degrees::degrees_hint;
pub use graph::{GraphFile, read_graph};
pub use mask::{KeepOutFile, SpeedFile, read_keep_out_mask, read_speed_mask, write_speed_mask};
pub use picture::picture_size;
pub use picture_map::{PictureMap, read_picture_map};
pub use places::read_places;
pub use source::MapDescription;
pub use yaml::{MAX_CELL_M, MIN_CELL_M};

use crate::codec::encode_grey8;
use crate::{CodecError, IoError, OutputFolder, Warnings};
use source::MapSource;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid};

/// Grey of a free cell. Source: ROS's `map_saver`.
const FREE_GREY: u8 = 254;
/// Grey of an occupied cell. Source: ROS's `map_saver`.
const OCCUPIED_GREY: u8 = 0;
/// Grey of an unknown cell: its occupancy of 0.19608 is just above the usual `free_thresh`. Source: ROS's `map_saver`.
const UNKNOWN_GREY: u8 = 205;

/// A map of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFile {
    /// The map.
    pub grid: OccupancyGrid,
    /// Warnings about the file.
    pub warnings: Warnings,
}

/// The map of [`read_map_file`].
///
/// # Errors
/// As [`read_map_file`].
pub fn read_map(yaml_path: &Path) -> Result<OccupancyGrid, IoError> {
    Ok(read_map_file(yaml_path)?.grid)
}

/// Reads a map from its YAML file and the picture named in it: a PGM, PNG or BMP; colours are averaged to grey.
///
/// A pixel's occupancy is `(maxval - v) / maxval`, or `v / maxval` with `negate`. A pixel above `occupied_thresh` is occupied, below
/// `free_thresh` free, otherwise unknown. A pixel that is not opaque is unknown. In mode `raw` the occupancy is `v / 100`; values above 100
/// are unknown. A picture with a yaw is resampled along the map's axes: a cell that touches an occupied one is occupied, so walls may become a cell
/// thicker. A `free_thresh` above `map_saver`'s grey of unknown cells gives a warning, because these cells become free.
///
/// # Errors
/// When a file is missing or truncated, a field is missing or invalid, thresholds are out of order, or the picture is larger than 2^28
/// cells.
pub fn read_map_file(yaml_path: &Path) -> Result<MapFile, IoError> {
    map_of(&MapSource::read(yaml_path)?)
}

impl MapDescription {
    /// The map with this picture, as [`read_map_file`] reads it.
    ///
    /// # Errors
    /// When the picture is truncated, of another format or larger than 2^28 cells.
    pub fn map(self, picture: &[u8]) -> Result<MapFile, IoError> {
        map_of(&self.with_picture(picture)?)
    }
}

/// The map from its files.
fn map_of(source: &MapSource) -> Result<MapFile, IoError> {
    let (geometry, cells) = picture_cells(source)?;
    let rank = |cell| match cell {
        Cell::Occupied => 0,
        Cell::Unknown => 1,
        Cell::Free => 2,
    };
    let (geometry, cells) = turned::straightened(geometry, cells, source.yaml.yaw, Cell::Unknown, rank)
        .map_err(IoError::field(&source.yaml_path))?;
    let grid = OccupancyGrid::new(geometry, cells).map_err(IoError::field(&source.picture_path))?;
    Ok(MapFile { grid, warnings: warnings(source) })
}

/// The cells of the picture before its rotation.
fn picture_cells(source: &MapSource) -> Result<(GridGeometry, Vec<Cell>), IoError> {
    Ok((source.geometry()?, source.picture.indices().map(|i| cell(source, i)).collect()))
}

/// The map on the cells of the picture.
fn picture_grid(source: &MapSource) -> Result<OccupancyGrid, IoError> {
    let (geometry, cells) = picture_cells(source)?;
    OccupancyGrid::new(geometry, cells).map_err(IoError::field(&source.picture_path))
}

/// Cell of pixel `i`.
fn cell(source: &MapSource, i: usize) -> Cell {
    let MapSource { yaml, picture, .. } = source;
    let is_unknown = yaml.reads_transparency() && picture.is_transparent(i);
    if is_unknown { Cell::Unknown } else { yaml.cell(picture.values[i], picture.maxval) }
}

/// Warnings about pixels that `map_saver` writes for unknown and this file makes free, and about a picture that is resampled.
fn warnings(source: &MapSource) -> Warnings {
    let yaml = &source.yaml;
    let mut warnings = Warnings::default();
    freed_warning(source, &mut warnings);
    if turned::is_resampled(yaml.yaw) {
        let problem = format!(
            "the picture is turned by the origin's yaw of {} rad and resampled: walls become up to a cell of {} m thicker, so a \
             narrow gap may close; save the map with a yaw of 0 to avoid this",
            yaml.yaw, yaml.resolution
        );
        warnings.add(&problem, &source.yaml_path.display().to_string());
    }
    warnings
}

/// A warning about pixels that `map_saver` writes for unknown and this file makes free.
fn freed_warning(source: &MapSource, warnings: &mut Warnings) {
    let MapSource { yaml, picture, .. } = source;
    let freed = picture.values.iter().filter(|&&value| yaml.frees_unknown(value, picture.maxval)).count();
    if freed > 0 {
        let free = yaml.free_thresh();
        let problem = format!(
            "{freed} cells of pixel 205, which map_saver writes for unknown, are free by free_thresh {free}; 0.196 keeps them unknown"
        );
        warnings.add(&problem, &source.yaml_path.display().to_string());
    }
}

/// The format of a map's picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MapImage {
    /// PGM, as `map_saver` writes it.
    #[default]
    Pgm,
    /// PNG, 8-bit grey, a tenth of the size.
    Png,
}

impl MapImage {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 2] =
        [("pgm", "As map_saver writes it", Self::Pgm), ("png", "Compressed, without loss", Self::Png)];
}

/// Writes `NAME.pgm` and `NAME.yaml` into the folder, as `map_saver` does: free 254, occupied 0, unknown 205.
///
/// # Errors
/// When a file cannot be written.
pub fn write_map(folder: &OutputFolder, name: &str, grid: &OccupancyGrid) -> Result<(), IoError> {
    write_map_as(folder, name, grid, MapImage::Pgm)
}

/// Writes a map with its picture in the format `image`.
///
/// # Errors
/// When a file cannot be written.
pub fn write_map_as(
    folder: &OutputFolder,
    name: &str,
    grid: &OccupancyGrid,
    image: MapImage,
) -> Result<(), IoError> {
    let (file, bytes) = map_picture(name, grid, image)?;
    folder.write(&file, &bytes)?;
    folder.write(&format!("{name}.yaml"), map_yaml(grid, &file).as_bytes())
}

/// Writes the files of a map outside a folder of results: the picture next to `file`, then `file` itself.
///
/// # Errors
/// When the name of `file` does not end in .yaml, or the picture cannot be encoded.
pub fn map_files(
    file: &Path,
    grid: &OccupancyGrid,
    image: MapImage,
) -> Result<[(PathBuf, Vec<u8>); 2], IoError> {
    let is_yaml = file.extension().is_some_and(|extension| extension == "yaml");
    let Some(name) = file.file_stem().and_then(|stem| stem.to_str()).filter(|_| is_yaml) else {
        return Err(IoError::malformed(file, "expected a map file whose name ends in .yaml"));
    };
    let (picture, bytes) = map_picture(name, grid, image)?;
    let yaml = map_yaml(grid, &picture).into_bytes();
    Ok([(file.with_file_name(&picture), bytes), (file.to_owned(), yaml)])
}

/// The name and the bytes of a map's picture in this format.
///
/// # Errors
/// When the picture cannot be encoded.
pub fn map_picture(name: &str, grid: &OccupancyGrid, image: MapImage) -> Result<(String, Vec<u8>), IoError> {
    match image {
        MapImage::Pgm => Ok((format!("{name}.pgm"), map_pgm(grid))),
        MapImage::Png => {
            let file = format!("{name}.png");
            let bytes = map_png(grid).map_err(IoError::image(Path::new(&file)))?;
            Ok((file, bytes))
        }
    }
}

/// The greys of a map, the highest y on top.
fn greys(grid: &OccupancyGrid) -> impl Iterator<Item = u8> + '_ {
    let GridGeometry { width, height, .. } = *grid.geometry();
    let cells = (0..height).rev().flat_map(move |row| (0..width).map(move |col| CellIndex { col, row }));
    cells.map(|index| match grid.get(index) {
        Cell::Free => FREE_GREY,
        Cell::Occupied => OCCUPIED_GREY,
        Cell::Unknown => UNKNOWN_GREY,
    })
}

/// The picture of a map: a binary PGM, the highest y on top.
pub fn map_pgm(grid: &OccupancyGrid) -> Vec<u8> {
    pgm(grid.geometry(), greys(grid))
}

/// A binary PGM of greys, row by row from the highest y.
fn pgm(geometry: &GridGeometry, greys: impl Iterator<Item = u8>) -> Vec<u8> {
    let GridGeometry { width, height, resolution, .. } = *geometry;
    let mut bytes = format!("P5\n# trundle {resolution} m/px\n{width} {height}\n255\n").into_bytes();
    bytes.extend(greys);
    bytes
}

/// The picture of a map: an 8-bit grey PNG, the highest y on top.
fn map_png(grid: &OccupancyGrid) -> Result<Vec<u8>, CodecError> {
    let GridGeometry { width, height, .. } = *grid.geometry();
    encode_grey8((width, height), &greys(grid).collect::<Vec<u8>>())
}

/// The YAML for the picture `image`; every number is read back as the same f64.
pub fn map_yaml(grid: &OccupancyGrid, image: &str) -> String {
    let GridGeometry { resolution, origin, .. } = *grid.geometry();
    let mut text = String::new();
    writeln!(text, "image: {image}\nmode: trinary\nresolution: {resolution:?}").expect("invariant: a String");
    writeln!(text, "origin: [{:?}, {:?}, 0.0]", origin.x, origin.y).expect("invariant: a String");
    text.push_str("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::Vector2;

    fn round_trip(grid: &OccupancyGrid) -> OccupancyGrid {
        let png = written_and_read(grid, MapImage::Png);
        assert_eq!(png, written_and_read(grid, MapImage::Pgm));
        png
    }

    fn written_and_read(grid: &OccupancyGrid, image: MapImage) -> OccupancyGrid {
        let dir = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&dir.path().join("out")).unwrap();
        write_map_as(&folder, "map", grid, image).unwrap();
        read_map(&folder.commit().unwrap().join("map.yaml")).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn a_map_comes_back_the_same(
            width in 1usize..20, height in 1usize..20, resolution in 1e-3..2f64,
            x in prop::num::f64::NORMAL, y in -1e3..1e3f64, seed in any::<u64>(),
        ) {
            // Any origin; the constructor refuses one that the grid cannot hold.
            let Ok(geometry) = GridGeometry::new(resolution, Vector2::new(x, y), width, height) else {
                prop_assert!(x.abs() > 1e12 * resolution);
                let near = GridGeometry::new(resolution, Vector2::new(y, y), width, height).unwrap();
                let grid = OccupancyGrid::filled(near, Cell::Free);
                prop_assert_eq!(round_trip(&grid), grid);
                return Ok(());
            };
            let cell = |i: usize| [Cell::Unknown, Cell::Free, Cell::Occupied][(seed >> (i % 60)) as usize % 3];
            let grid = OccupancyGrid::new(geometry, (0..width * height).map(cell).collect()).unwrap();
            prop_assert_eq!(round_trip(&grid), grid);
        }
    }

    #[test]
    fn an_origin_beyond_all_cells_is_refused_by_file_and_field() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#").unwrap();
        let yaml = map_yaml(&grid, "m.pgm").replace("origin: [0.0,", "origin: [8.126587341910605e94,");
        std::fs::write(&path, yaml).unwrap();
        std::fs::write(dir.path().join("m.pgm"), map_pgm(&grid)).unwrap();
        let error = read_map(&path).unwrap_err().to_string();
        assert!(error.contains("m.yaml") && error.contains("origin x is 8.126587341910605e94 m"), "{error}");
    }

    #[test]
    fn a_missing_picture_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#").unwrap();
        std::fs::write(&path, map_yaml(&grid, "nowhere.pgm")).unwrap();
        let error = read_map(&path).unwrap_err().to_string();
        assert!(error.contains("m.yaml: image is '") && error.contains("nowhere.pgm'"), "{error}");
    }

    #[test]
    fn a_picture_that_is_resampled_is_warned_of() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#?.?").unwrap();
        std::fs::write(dir.path().join("m.pgm"), map_pgm(&grid)).unwrap();
        for (yaw, expected) in [("0.0", 0), ("-1.5707963", 0), ("0.3", 1), ("0.001", 1)] {
            let yaml = map_yaml(&grid, "m.pgm").replace(", 0.0]", &format!(", {yaw}]"));
            std::fs::write(&path, yaml).unwrap();
            let warnings = read_map_file(&path).unwrap().warnings;
            assert_eq!(warnings.iter().count(), expected, "{yaw}");
            assert!(warnings.iter().all(|warning| {
                warning.to_string().contains("resampled: walls become up to a cell of 0.05 m")
            }));
        }
    }

    #[test]
    fn unknown_that_becomes_free_is_counted_and_transparent_pixels_are_unknown() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.yaml");
        let grid = OccupancyGrid::from_ascii(0.05, "#?.?").unwrap();
        let yaml = map_yaml(&grid, "m.png").replace("free_thresh: 0.196", "free_thresh: 0.25");
        std::fs::write(&path, yaml).unwrap();
        std::fs::write(dir.path().join("m.png"), map_png(&grid).unwrap()).unwrap();
        let file = read_map_file(&path).unwrap();
        assert_eq!(file.grid, OccupancyGrid::from_ascii(0.05, "#...").unwrap());
        let message: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
        assert!(
            message[0].starts_with("2 cells of pixel 205") && message[0].contains("free_thresh 0.25"),
            "{message:?}"
        );
        let clear = image::RgbaImage::from_raw(2, 1, vec![0, 0, 0, 255, 0, 0, 0, 0]).unwrap();
        clear.save(dir.path().join("m.png")).unwrap();
        assert_eq!(read_map(&path).unwrap().cells(), [Cell::Occupied, Cell::Unknown]);
    }
}
