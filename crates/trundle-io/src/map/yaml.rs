//! Parser of the YAML file of a map_server map.

use crate::IoError;
use crate::excerpt::excerpt;
use crate::yaml_document::{YamlDocument, YamlValue};
use std::path::Path;
use trundle_core::{Cell, Invalid, Vector2, require_finite, require_in, require_positive};

/// Grey of an unknown cell, of 255. Source: ROS's `map_saver`.
const UNKNOWN_GREY: u32 = 205;

/// Smallest side of a cell \[m\]: the noise of a laser is larger. Source: ours.
pub const MIN_CELL_M: f64 = 0.001;
/// Largest side of a cell \[m\]: no robot drives by larger ones. Source: ours.
pub const MAX_CELL_M: f64 = 2.0;

/// The checked content of a map's YAML file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapYaml {
    /// The picture, relative to the YAML file.
    pub image: String,
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lower-left corner of the picture, map frame, m.
    pub origin: Vector2,
    /// Rotation of the picture around that corner, counter-clockwise, rad.
    pub yaw: f64,
    negate: bool,
    occupied: f64,
    free: f64,
    mode: Mode,
}

/// `scale` differs from `trinary` only in the grades between the thresholds, which a trinary grid does not hold, but a mask does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Trinary,
    Scale,
    Raw,
}

impl MapYaml {
    pub fn parse(path: &Path, text: &str) -> Result<Self, IoError> {
        Self::of(&YamlDocument::parse(path, text)?)
    }

    /// The checked fields of a document.
    pub fn of(document: &YamlDocument<'_>) -> Result<Self, IoError> {
        let image = image_name(document)?.to_owned();
        let resolution = document.number("resolution", "metres a cell, as 0.05")?;
        let origin = document.numbers("origin", ORIGIN)?;
        let negate = negate(document)?;
        let occupied = document.number("occupied_thresh", "0 to 1, as 0.65")?;
        let free = document.number("free_thresh", "0 to 1, as 0.196")?;
        let (origin, yaw) = pose(&origin).map_err(|invalid| document.invalid(invalid))?;
        let resolution = of_a_floor(resolution).map_err(|invalid| document.invalid(invalid))?;
        check_thresholds(occupied, free).map_err(|invalid| document.invalid(invalid))?;
        Ok(Self { image, resolution, origin, yaw, negate, occupied, free, mode: mode(document)? })
    }

    /// Whether transparent pixels are unknown, as in every mode but raw.
    pub fn reads_transparency(&self) -> bool {
        self.mode != Mode::Raw
    }

    /// Whether a pixel is the 205 that `map_saver` writes for unknown, and `free_thresh` makes it free.
    pub fn frees_unknown(&self, value: u16, maxval: u16) -> bool {
        let is_unknown_grey = u32::from(value) * 255 == UNKNOWN_GREY * u32::from(maxval);
        self.mode != Mode::Raw && is_unknown_grey && self.cell(value, maxval) == Cell::Free
    }

    /// The occupancy below which a pixel is free.
    pub fn free_thresh(&self) -> f64 {
        self.free
    }

    /// Cell of a pixel value.
    pub fn cell(&self, value: u16, maxval: u16) -> Cell {
        let occupancy = match self.mode {
            Mode::Raw => match raw(value, maxval) {
                value if value > 100 => return Cell::Unknown,
                value => f64::from(value) / 100.0,
            },
            _ => self.darkness(value, maxval),
        };
        if occupancy > self.occupied {
            Cell::Occupied
        } else if occupancy < self.free {
            Cell::Free
        } else {
            Cell::Unknown
        }
    }

    /// Value of a pixel of a mask, 0 to 100, as map_server fills an OccupancyGrid message; `None`: unknown.
    pub fn value(&self, value: u16, maxval: u16) -> Option<u8> {
        if self.mode == Mode::Raw {
            return u8::try_from(raw(value, maxval)).ok().filter(|value| *value <= 100);
        }
        let darkness = self.darkness(value, maxval);
        if darkness > self.occupied {
            return Some(100);
        }
        if darkness < self.free {
            return Some(0);
        }
        let grade = (darkness - self.free) / (self.occupied - self.free) * 100.0;
        (self.mode == Mode::Scale).then(|| grade.round() as u8)
    }

    /// 0 for a free pixel to 1 for an occupied one.
    fn darkness(&self, value: u16, maxval: u16) -> f64 {
        let value = if self.negate { value } else { maxval - value };
        f64::from(value) / f64::from(maxval)
    }
}

/// Form of `origin`.
const ORIGIN: &str = "[x, y, yaw] (m, m, rad)";

/// The name of the picture's file, in or below any folder.
fn image_name<'d>(document: &'d YamlDocument<'_>) -> Result<&'d str, IoError> {
    let expected = "the name of the map's picture";
    let name = document.text("image", expected)?;
    match Path::new(name).file_name() {
        Some(_) => Ok(name),
        None => Err(document.invalid(Invalid::new("image", format!("'{}'", excerpt(name)), "", expected))),
    }
}

fn negate(document: &YamlDocument<'_>) -> Result<bool, IoError> {
    match document.require("negate", "0 or 1")? {
        YamlValue::Bool(negate) => Ok(*negate),
        YamlValue::Number(0.0) => Ok(false),
        YamlValue::Number(1.0) => Ok(true),
        other => Err(document.wrong("negate", other, "0 or 1")),
    }
}

fn mode(document: &YamlDocument<'_>) -> Result<Mode, IoError> {
    let expected = "trinary, scale or raw";
    match document.get("mode") {
        None => Ok(Mode::Trinary),
        Some(YamlValue::Text(mode)) if mode.eq_ignore_ascii_case("trinary") => Ok(Mode::Trinary),
        Some(YamlValue::Text(mode)) if mode.eq_ignore_ascii_case("scale") => Ok(Mode::Scale),
        Some(YamlValue::Text(mode)) if mode.eq_ignore_ascii_case("raw") => Ok(Mode::Raw),
        Some(other) => Err(document.wrong("mode", other, expected)),
    }
}

/// The corner and the yaw of `origin`.
fn pose(origin: &[f64]) -> Result<(Vector2, f64), Invalid> {
    let &[x, y, yaw] = origin else {
        return Err(Invalid::new("origin", format!("{} numbers", origin.len()), "", ORIGIN));
    };
    let yaw = require_in("origin yaw", yaw, "rad", -7.0, 7.0)?;
    Ok((Vector2::new(require_finite("origin x", x, "m")?, require_finite("origin y", y, "m")?), yaw))
}

fn check_thresholds(occupied: f64, free: f64) -> Result<(), Invalid> {
    require_in("occupied_thresh", occupied, "", 0.0, 1.0)?;
    require_in("free_thresh", free, "", 0.0, 1.0)?;
    if free >= occupied {
        let expected = format!("less than occupied_thresh ({occupied})");
        return Err(Invalid::new("free_thresh", free, "", expected));
    }
    Ok(())
}

/// The value of a pixel in mode raw, of 0 to 255: pictures of more levels are scaled to these, as Nav2 does.
fn raw(value: u16, maxval: u16) -> u16 {
    if maxval <= 255 { value } else { (f64::from(value) * 255.0 / f64::from(maxval)).round() as u16 }
}

/// The side of a cell, if it is one of a map of a floor: others are in a wrong unit, or would make a plan endless.
fn of_a_floor(resolution: f64) -> Result<f64, Invalid> {
    require_positive("resolution", resolution, "m")?;
    require_in("resolution", resolution, "m", MIN_CELL_M, MAX_CELL_M).map_err(|invalid| {
        let hint = if resolution > MAX_CELL_M { "; is it in centimetres or millimetres?" } else { "" };
        let expected = format!("{}{hint}", invalid.expected);
        Invalid { expected, ..invalid }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GOOD: &str = "image: a.pgm\nresolution: 0.050000\norigin: [-10.0, 2, 0.000000]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn parse(text: &str) -> Result<MapYaml, String> {
        MapYaml::parse(Path::new("m.yaml"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn greys_mean_what_map_server_says() {
        let map = parse(GOOD).unwrap();
        assert_eq!((map.image.as_str(), map.resolution, map.origin.x), ("a.pgm", 0.05, -10.0));
        let cells = |map: &MapYaml| [0, 88, 90, 205, 206, 254].map(|v| map.cell(v, 255));
        use Cell::{Free, Occupied, Unknown};
        assert_eq!(cells(&map), [Occupied, Occupied, Unknown, Unknown, Free, Free]);
        let negated = parse(&GOOD.replace("negate: 0", "negate: true")).unwrap();
        assert_eq!(cells(&negated), [Free, Unknown, Unknown, Occupied, Occupied, Occupied]);
        let raw = parse(&format!("{GOOD}mode: raw\n")).unwrap();
        assert_eq!(
            [0, 50, 100, 101, 255].map(|v| raw.cell(v, 255)),
            [Free, Unknown, Occupied, Unknown, Unknown]
        );
        assert_eq!(map.cell(65_535, 65_535), Free);
        // `scale` keeps the grades between the thresholds, for masks; a three-valued map drops them.
        let scale = parse(&format!("{GOOD}mode: scale\n")).unwrap();
        assert_eq!(cells(&scale), cells(&map));
        assert_eq!(
            [0, 88, 128, 206, 254].map(|v| scale.value(v, 255)),
            [Some(100), Some(100), Some(67), Some(0), Some(0)]
        );
        assert_eq!([0, 128, 254].map(|v| map.value(v, 255)), [Some(100), None, Some(0)]);
        assert_eq!([0, 65, 100, 101].map(|v| raw.value(v, 255)), [Some(0), Some(65), Some(100), None]);
    }

    #[test]
    fn every_field_is_needed_and_named() {
        for (key, line) in ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"]
            .iter()
            .zip(GOOD.lines())
        {
            let error = parse(&GOOD.replace(line, "")).unwrap_err();
            assert!(error.starts_with(&format!("m.yaml: {key} is missing, expected ")), "{error}");
        }
    }

    #[test]
    fn wrong_values_are_named() {
        for (from, to, line, problem) in [
            ("0.050000", "-1", 2, "resolution is -1 m, expected a finite number above 0"),
            ("0.050000", "1e-300", 2, "resolution is 1e-300 m, expected 0.001 to 2"),
            (
                "0.050000",
                "50",
                2,
                "resolution is 50 m, expected 0.001 to 2; is it in centimetres or millimetres?",
            ),
            ("0.050000", ".nan", 2, "resolution is '.nan', expected metres a cell, as 0.05"),
            ("0.050000", "fine", 2, "resolution is 'fine', expected metres a cell, as 0.05"),
            (
                "0.050000",
                "0,05",
                2,
                "resolution is '0,05', expected a decimal point: 0.05 (metres a cell, as 0.05)",
            ),
            ("negate: 0", "negate: 2", 4, "negate is 2, expected 0 or 1"),
            ("[-10.0, 2, 0.000000]", "[1, 2]", 3, "origin is 2 numbers, expected [x, y, yaw] (m, m, rad)"),
            ("[-10.0", "[x", 3, "origin is 'x', expected [x, y, yaw] (m, m, rad)"),
            ("0.000000]", "90]", 3, "origin yaw is 90 rad, expected -7 to 7"),
            ("0.65", "1.5", 5, "occupied_thresh is 1.5, expected 0 to 1"),
            ("0.65", "[1]", 5, "occupied_thresh is a list of 1, expected 0 to 1, as 0.65"),
            ("0.65", "0.1", 6, "free_thresh is 0.196, expected less than occupied_thresh (0.1)"),
            ("0.196", "0.196\nmode: colour", 7, "mode is 'colour', expected trinary, scale or raw"),
            (
                "0.196",
                "0.196\nnegate: 1",
                7,
                "negate is there a second time, the first in line 4; expected once",
            ),
        ] {
            assert_eq!(
                parse(&GOOD.replace(from, to)).unwrap_err(),
                format!("m.yaml, line {line}: {problem}")
            );
        }
        assert!(parse("{").is_err() && parse("").is_err() && parse("- a").is_err());
    }

    #[test]
    fn the_grey_of_unknown_is_free_only_by_a_high_threshold() {
        let map = parse(GOOD).unwrap();
        assert!(!map.frees_unknown(205, 255) && !map.frees_unknown(615, 765));
        let nav2 = parse(&GOOD.replace("0.196", "0.25")).unwrap();
        assert!(
            nav2.frees_unknown(205, 255) && nav2.frees_unknown(615, 765) && !nav2.frees_unknown(254, 255)
        );
    }

    proptest! {
        #[test]
        fn any_text_does_not_panic(cut in 0..GOOD.len(), text in "[a-z0-9 :.'\"\\[\\]{}&*!|>-]{0,30}") {
            let _ = parse(&format!("{}{text}", &GOOD[..cut]));
        }
    }
}
