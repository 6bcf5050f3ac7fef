//! Masks of Nav2's costmap filters: a map_server picture whose greys forbid, or slow down.

use super::picture::Picture;
use super::source::MapSource;
use super::turned::straightened;
use super::yaml::MapYaml;
use crate::IoError;
use crate::yaml_document::YamlDocument;
use crate::{OutputFolder, map::pgm};
use std::path::Path;
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, require_in};

/// A mask's value that forbids. Source: `nav_msgs/OccupancyGrid`.
const LETHAL_VALUE: u8 = 100;

/// Meaning of the values of a speed mask, by Nav2's filter-info server: limit = base + multiplier * value.
///
/// Read from the mask's own YAML, whose keys `type`, `base` and `multiplier` map_server leaves alone.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FilterInfo {
    /// 1: per cent of the robot's maximum speed; 2: m/s.
    kind: u8,
    base: f64,
    multiplier: f64,
}

impl FilterInfo {
    /// Reads the values of a mask's YAML; defaults 1, 100 and -1.
    fn of(document: &YamlDocument<'_>) -> Result<Self, IoError> {
        let kind = document.number_or("type", 1.0, "1 (per cent) or 2 (m/s)")?;
        let base = document.number_or("base", 100.0, "a number")?;
        let multiplier = document.number_or("multiplier", -1.0, "a number")?;
        Self::checked(kind, base, multiplier).map_err(|invalid| document.invalid(invalid))
    }

    fn checked(kind: f64, base: f64, multiplier: f64) -> Result<Self, Invalid> {
        if kind != 1.0 && kind != 2.0 {
            return Err(Invalid::new("type", kind, "", "1 (per cent) or 2 (m/s)"));
        }
        require_in("base", base, "", -1e6, 1e6)?;
        require_in("multiplier", multiplier, "", -1e6, 1e6)?;
        Ok(Self { kind: if kind == 1.0 { 1 } else { 2 }, base, multiplier })
    }

    /// The limit of a value, m/s; infinite for no limit: value 0, unknown, and values that Nav2 reports as out of range.
    fn limit(self, value: Option<u8>, full_speed: f64) -> f32 {
        let Some(value) = value.filter(|value| *value > 0) else { return f32::INFINITY };
        let limit = self.base + self.multiplier * f64::from(value);
        let limit = match self.kind {
            1 if limit <= 100.0 => limit / 100.0 * full_speed,
            1 => f64::INFINITY,
            _ => limit,
        };
        if limit > 0.0 { limit as f32 } else { f32::INFINITY }
    }
}

/// A keep-out mask of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct KeepOutFile {
    /// Occupied in forbidden cells, else free.
    pub forbidden: OccupancyGrid,
    /// Cost of each cell, 0 to 100; 0 if the cell is forbidden or unknown.
    pub costs: Vec<u8>,
}

/// A speed mask of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedFile {
    /// Geometry of the cells.
    pub geometry: GridGeometry,
    /// Maximum speed of each cell, row by row from the lowest y, m/s; infinite without a limit.
    pub limits: Vec<f32>,
    /// Number of cells with a value above 0 and no limit, because the computed limit is not above 0, or is above 100 %.
    pub out_of_range: usize,
}

/// A keep-out mask from its YAML file and the picture named in it: forbidden and costly cells.
///
/// Semantics of Nav2's keep-out filter. A value of 100 forbids a cell: darker than `occupied_thresh` in modes `trinary` and `scale`, 100 in
/// mode `raw`. Values of 1 to 99 (modes `scale` and `raw`) make a cell costly; unknown cells are free.
///
/// # Errors
/// As [`read_map`](crate::read_map).
pub fn read_keep_out_mask(yaml_path: &Path) -> Result<KeepOutFile, IoError> {
    let (geometry, values) = values(&MapSource::read(yaml_path)?)?;
    let cell = |value: &Option<u8>| if *value == Some(LETHAL_VALUE) { Cell::Occupied } else { Cell::Free };
    let costs = values.iter().map(|value| value.filter(|value| *value < LETHAL_VALUE).unwrap_or(0)).collect();
    let forbidden = OccupancyGrid::new(geometry, values.iter().map(cell).collect());
    Ok(KeepOutFile { forbidden: forbidden.map_err(IoError::field(yaml_path))?, costs })
}

/// A speed mask from its YAML file and the picture named in it.
///
/// Semantics of Nav2's speed filter: values are 0 to 100, limit = base + multiplier * value; value 0 and unknown set no limit. `type` (1:
/// per cent of `full_speed`, m/s; 2: m/s), `base` and `multiplier` are read from the same YAML. Defaults are 1, 100 and -1: white is full
/// speed, darker is slower. As in Nav2, a limit that is not above 0, or is above 100 %, sets no limit: black (100) therefore sets none.
///
/// # Errors
/// As [`read_map`](crate::read_map); when `type` is neither 1 nor 2, `full_speed` is not above 0, or a number is not finite.
pub fn read_speed_mask(yaml_path: &Path, full_speed: f64) -> Result<SpeedFile, IoError> {
    trundle_core::require_positive("full speed", full_speed, "m/s").map_err(IoError::field(yaml_path))?;
    let source = MapSource::read(yaml_path)?;
    let (geometry, values) = values(&source)?;
    let info = FilterInfo::of(&source.document()?)?;
    let limits: Vec<f32> = values.iter().map(|value| info.limit(*value, full_speed)).collect();
    let is_out =
        |value: &Option<u8>, limit: &f32| value.is_some_and(|value| value > 0) && limit.is_infinite();
    let out_of_range = values.iter().zip(&limits).filter(|(value, limit)| is_out(value, limit)).count();
    Ok(SpeedFile { geometry, limits, out_of_range })
}

/// Writes a speed mask as `NAME.pgm` and `NAME.yaml` for Nav2's speed filter, which then needs no other numbers. The mode is `scale`, in
/// per cent of `full_speed` \[m/s\] by `type` 1, `base` 100 and `multiplier` -1. A limit is rounded down to a whole per cent, with a
/// minimum of 1.
///
/// # Errors
/// When a file cannot be written.
pub fn write_speed_mask(
    folder: &OutputFolder,
    name: &str,
    geometry: &GridGeometry,
    limits: impl Fn(CellIndex) -> f64,
    full_speed: f64,
) -> Result<(), IoError> {
    let GridGeometry { resolution, origin, width, height } = *geometry;
    let cells = (0..height).rev().flat_map(|row| (0..width).map(move |col| CellIndex { col, row }));
    let greys = cells.map(|cell| grey_of_limit(limits(cell) / full_speed));
    folder.write(&format!("{name}.pgm"), &pgm(geometry, greys))?;
    let yaml = format!(
        "image: {name}.pgm\nmode: scale\nresolution: {resolution:?}\norigin: [{:?}, {:?}, 0.0]\nnegate: 0\n\
         occupied_thresh: 1.0\nfree_thresh: 0.0\ntype: 1\nbase: 100.0\nmultiplier: -1.0\n",
        origin.x, origin.y
    );
    folder.write(&format!("{name}.yaml"), yaml.as_bytes())
}

/// Grey of a limit as a part of the full speed, in mode `scale`: the darker the slower, white without a limit.
fn grey_of_limit(part: f64) -> u8 {
    if part >= 1.0 {
        return u8::MAX;
    }
    // Rounding of the limit, a f32, is no per cent less.
    let value = 100.0 - (100.0 * part + 1e-4).floor().clamp(1.0, 99.0);
    (f64::from(u8::MAX) * (1.0 - value / 100.0)).round() as u8
}

/// The picture's values, 0 to 100, row by row from the lowest y; `None`: unknown.
fn values(source: &MapSource) -> Result<(GridGeometry, Vec<Option<u8>>), IoError> {
    let MapSource { yaml, picture, .. } = source;
    let values = picture.indices().map(|i| value(yaml, picture, i)).collect();
    let (geometry, yaml_path) = (source.geometry()?, &source.yaml_path);
    // For a rotated picture, the darkest value that a cell touches.
    let rank = |value: Option<u8>| value.map_or(u8::MAX, |value| LETHAL_VALUE - value.min(LETHAL_VALUE));
    straightened(geometry, values, yaml.yaw, None, rank).map_err(IoError::field(yaml_path))
}

/// Value of pixel `i`.
fn value(yaml: &MapYaml, picture: &Picture, i: usize) -> Option<u8> {
    let is_unknown = yaml.reads_transparency() && picture.is_transparent(i);
    if is_unknown { None } else { yaml.value(picture.values[i], picture.maxval) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mask of one row of greys.
    fn write(folder: &Path, greys: &[u8], more: &str) -> std::path::PathBuf {
        let mut pgm = format!("P5\n{} 1\n255\n", greys.len()).into_bytes();
        pgm.extend(greys);
        std::fs::write(folder.join("m.pgm"), pgm).unwrap();
        let yaml = format!("image: m.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\nnegate: 0\n{more}");
        std::fs::write(folder.join("m.yaml"), yaml).unwrap();
        folder.join("m.yaml")
    }

    const SCALE: &str = "mode: scale\noccupied_thresh: 1.0\nfree_thresh: 0.0\n";
    const TRINARY: &str = "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    #[test]
    fn black_is_kept_out_and_grey_is_costly() {
        let scratch = tempfile::tempdir().unwrap();
        let mask = read_keep_out_mask(&write(scratch.path(), &[0, 80, 128, 205, 254], TRINARY)).unwrap();
        use Cell::{Free, Occupied};
        assert_eq!(mask.forbidden.cells(), [Occupied, Occupied, Free, Free, Free]);
        assert_eq!(mask.costs, [0; 5]);
        assert_eq!(mask.forbidden.geometry().origin, trundle_core::Vector2::new(1.0, 2.0));
        let graded = read_keep_out_mask(&write(scratch.path(), &[0, 1, 128, 255], SCALE)).unwrap();
        assert_eq!(graded.forbidden.cells(), [Occupied, Occupied, Free, Free]);
        assert_eq!(graded.costs, [0, 0, 50, 0]);
        let raw =
            read_keep_out_mask(&write(scratch.path(), &[0, 99, 100, 101], &format!("mode: raw\n{TRINARY}")));
        let raw = raw.unwrap();
        assert_eq!(raw.forbidden.cells(), [Free, Free, Occupied, Free]);
        assert_eq!(raw.costs, [0, 99, 0, 0]);
    }

    #[test]
    fn a_speed_mask_that_is_written_is_read_back_to_a_per_cent_and_never_faster() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&scratch.path().join("out")).unwrap();
        let geometry = GridGeometry::new(0.05, trundle_core::Vector2::new(-1.5, 2.0), 100, 2).unwrap();
        let limit =
            |cell: CellIndex| if cell.row == 1 { 0.005 * (cell.col + 1) as f64 } else { f64::INFINITY };
        write_speed_mask(&folder, "speed", &geometry, limit, 0.5).unwrap();
        let mask = read_speed_mask(&folder.commit().unwrap().join("speed.yaml"), 0.5).unwrap();
        assert_eq!((mask.geometry, mask.out_of_range), (geometry, 0));
        assert!(mask.limits[..100].iter().all(|limit| limit.is_infinite()));
        for (col, found) in mask.limits[100..199].iter().enumerate() {
            let asked = limit(CellIndex { col, row: 1 });
            let off = asked - f64::from(*found);
            assert!((-1e-6..0.0051).contains(&off), "{asked} m/s is {found} m/s");
        }
        assert!(mask.limits[199].is_infinite(), "the full speed is not a limit");
    }

    #[test]
    fn the_darker_the_slower() {
        let scratch = tempfile::tempdir().unwrap();
        let limits = |greys: &[u8], more: &str| {
            read_speed_mask(&write(scratch.path(), greys, more), 0.7).map(|m| m.limits)
        };
        let none = f32::INFINITY;
        assert_eq!(limits(&[255, 204, 127, 0], SCALE).unwrap(), [none, 0.56, 0.35, none]);
        let absolute = format!("{SCALE}type: 2\nbase: 0.1\nmultiplier: 0.01\n");
        assert_eq!(limits(&[255, 204, 127], &absolute).unwrap(), [none, 0.3, 0.6]);
        let error = limits(&[0], &format!("{SCALE}type: 3\n")).unwrap_err().to_string();
        assert!(error.ends_with("type is 3, expected 1 (per cent) or 2 (m/s)"), "{error}");
        assert!(limits(&[0], &format!("{SCALE}base: .nan\n")).is_err());
        let black = read_speed_mask(&write(scratch.path(), &[0, 0, 255], SCALE), 0.7).unwrap();
        assert_eq!((black.geometry.width, black.geometry.height, black.geometry.resolution), (3, 1, 0.1));
        assert_eq!((black.limits, black.out_of_range), (vec![none; 3], 2));
    }
}
