//! Parser of the YAML file of a map_server map.

use crate::IoError;
use serde::Deserialize;
use std::path::Path;
use trundle_core::{Cell, Invalid, Vector2, require_finite, require_in, require_positive};

/// The checked content of a map's YAML file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapYaml {
    /// The picture, relative to the YAML file.
    pub image: String,
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lower-left corner of the picture, map frame, m.
    pub origin: Vector2,
    /// How far the picture is turned about that corner, counter-clockwise, rad.
    pub yaw: f64,
    negate: bool,
    occupied: f64,
    free: f64,
    mode: Mode,
}

#[derive(Deserialize)]
struct File {
    image: String,
    resolution: f64,
    origin: Vec<f64>,
    negate: Flag,
    occupied_thresh: f64,
    free_thresh: f64,
    #[serde(default)]
    mode: Mode,
}

/// `0`, `1`, `false` or `true`.
#[derive(Deserialize)]
#[serde(untagged)]
enum Flag {
    Bool(bool),
    Number(u8),
}

/// `scale` differs from `trinary` only in the grades between the thresholds, which a trinary grid does not hold, but a mask does.
#[derive(Debug, Clone, Copy, Deserialize, Default, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Mode {
    #[default]
    Trinary,
    Scale,
    Raw,
}

impl MapYaml {
    pub fn parse(path: &Path, text: &str) -> Result<Self, IoError> {
        let file: File = serde_saphyr::from_str(text).map_err(|error| located(path, &error))?;
        Self::checked(file).map_err(IoError::field(path))
    }

    fn checked(file: File) -> Result<Self, Invalid> {
        let negate = match file.negate {
            Flag::Bool(negate) => negate,
            Flag::Number(number @ (0 | 1)) => number == 1,
            Flag::Number(number) => return Err(Invalid::new("negate", number, "", "0 or 1")),
        };
        let [x, y, yaw] = file.origin[..] else {
            let found = format!("{} numbers", file.origin.len());
            return Err(Invalid::new("origin", found, "", "[x, y, yaw] (m, m, rad)"));
        };
        let yaw = require_in("origin yaw", yaw, "rad", -7.0, 7.0)?;
        let occupied = require_in("occupied_thresh", file.occupied_thresh, "", 0.0, 1.0)?;
        let free = require_in("free_thresh", file.free_thresh, "", 0.0, 1.0)?;
        if free >= occupied {
            return Err(Invalid::new(
                "free_thresh",
                free,
                "",
                format!("less than occupied_thresh ({occupied})"),
            ));
        }
        Ok(Self {
            image: file.image,
            resolution: coarse_enough(file.resolution)?,
            origin: Vector2::new(require_finite("origin x", x, "m")?, require_finite("origin y", y, "m")?),
            yaw,
            negate,
            occupied,
            free,
            mode: file.mode,
        })
    }

    /// What a pixel says.
    pub fn cell(&self, value: u16, maxval: u16) -> Cell {
        let occupancy = match self.mode {
            Mode::Raw if value > 100 => return Cell::Unknown,
            Mode::Raw => f64::from(value) / 100.0,
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

    /// What a pixel of a mask says, 0 to 100, as map_server fills an OccupancyGrid message; `None`: unknown.
    pub fn value(&self, value: u16, maxval: u16) -> Option<u8> {
        if self.mode == Mode::Raw {
            return u8::try_from(value).ok().filter(|value| *value <= 100);
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

/// The parser's complaint in one line, with the line it is about.
fn located(path: &Path, error: &serde_saphyr::Error) -> IoError {
    let error = error.without_snippet();
    let message = error.to_string();
    let message = message.lines().next().unwrap_or_default().to_owned();
    match error.location() {
        Some(location) if !message.contains("missing field") => {
            IoError::line(path, usize::try_from(location.line()).unwrap_or(0), message)
        }
        _ => IoError::malformed(path, message),
    }
}

/// A cell larger than a house is a wrong unit, and would make any plan endless.
fn coarse_enough(resolution: f64) -> Result<f64, Invalid> {
    require_positive("resolution", resolution, "m")?;
    require_in("resolution", resolution, "m", 0.0, 10.0)
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
        // `scale` keeps the grades between the thresholds, for masks; a three-valued map does not know them.
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
            assert!(
                error.starts_with("m.yaml") && error.contains(&format!("missing field `{key}`")),
                "{error}"
            );
        }
    }

    #[test]
    fn wrong_values_are_named() {
        for (from, to, problem) in [
            ("0.050000", "-1", "resolution is -1 m, expected a finite number above 0"),
            ("0.050000", ".nan", "resolution is NaN m, expected a finite number above 0"),
            ("negate: 0", "negate: 2", "negate is 2, expected 0 or 1"),
            ("[-10.0, 2, 0.000000]", "[1, 2]", "origin is 2 numbers, expected [x, y, yaw] (m, m, rad)"),
            ("0.000000]", "90]", "origin yaw is 90 rad, expected -7 to 7"),
            ("0.65", "1.5", "occupied_thresh is 1.5, expected 0 to 1"),
            ("0.65", "0.1", "free_thresh is 0.196, expected less than occupied_thresh (0.1)"),
        ] {
            assert_eq!(parse(&GOOD.replace(from, to)).unwrap_err(), format!("m.yaml: {problem}"));
        }
        for (from, to) in [("0.050000", "fine"), ("[-10.0", "[x"), ("0.65", "[1]")] {
            let error = parse(&GOOD.replace(from, to)).unwrap_err();
            assert!(error.starts_with("m.yaml, line "), "{error}");
        }
        assert!(parse(&format!("{GOOD}mode: colour\n")).unwrap_err().starts_with("m.yaml, line 7: "));
        assert!(parse("{").is_err() && parse("").is_err() && parse("- a").is_err());
    }

    proptest! {
        #[test]
        fn any_text_is_no_panic(cut in 0..GOOD.len(), text in "[a-z0-9 :.'\"\\[\\]{}&*!|>-]{0,30}") {
            let _ = parse(&format!("{}{text}", &GOOD[..cut]));
        }
    }
}
