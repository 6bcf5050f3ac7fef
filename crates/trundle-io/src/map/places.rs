//! Named places: a TOML file, or the places of a GeoJSON file of zones.

use super::annotations::read_annotations;
use crate::files::read_text;
use crate::toml_text::parse_toml;
use crate::{Expected, IoError};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose2, require_in};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Place {
    x: f64,
    y: f64,
    heading_deg: f64,
}

/// The poses of named places, map frame: one table a place, with `x`, `y` (m) and `heading_deg`.
///
/// ```toml
/// [dock]
/// x = 1.2
/// y = 0.5
/// heading_deg = 90
///
/// ["north door"]
/// x = 7.0
/// y = 3.5
/// heading_deg = 0
/// ```
///
/// A file whose name ends with `.geojson` or `.json` is read as zones and places, as the live page and `trundle map rooms` write them.
///
/// # Errors
/// When the file cannot be read, a field is missing, unknown, or no finite number (at most 1e6), or a name is empty.
pub fn read_places(path: &Path) -> Result<BTreeMap<String, Pose2>, IoError> {
    if path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("geojson") || end.eq_ignore_ascii_case("json"))
    {
        let places = read_annotations(path)?.places;
        return Ok(places.into_iter().map(|place| (place.name, place.pose)).collect());
    }
    Expected::Toml.check(path)?;
    let text = read_text(path)?;
    let places: BTreeMap<String, Place> = parse_toml(path, &text)?;
    places.into_iter().map(|(name, place)| checked(path, name, &place)).collect()
}

fn checked(path: &Path, name: String, place: &Place) -> Result<(String, Pose2), IoError> {
    if name.trim().is_empty() {
        return Err(IoError::malformed(path, "a place has no name"));
    }
    for (field, value, unit) in
        [("x", place.x, "m"), ("y", place.y, "m"), ("heading_deg", place.heading_deg, "deg")]
    {
        require_in(&format!("{name}.{field}"), value, unit, -1e6, 1e6).map_err(IoError::field(path))?;
    }
    Ok((name, Pose2::new(place.x, place.y, place.heading_deg.to_radians())))
}

#[cfg(test)]
mod tests {
    use super::super::annotations::annotations_text;
    use super::*;
    use trundle_core::{MapAnnotations, NamedPlace};

    fn read(text: &str) -> Result<BTreeMap<String, Pose2>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let name = file.path().display().to_string();
        read_places(file.path()).map_err(|error| error.to_string().replace(&name, "p.toml"))
    }

    #[test]
    fn places_have_names_and_poses() {
        let places =
            read("[dock]\nx = 1\ny = 0.5\nheading_deg = 90\n[\"north door\"]\nx=7.0\ny=3\nheading_deg=-45")
                .unwrap();
        assert_eq!(places.keys().collect::<Vec<_>>(), ["dock", "north door"]);
        assert_eq!(places["dock"], Pose2::new(1.0, 0.5, std::f64::consts::FRAC_PI_2));
        assert!(read("").unwrap().is_empty());
    }

    #[test]
    fn places_of_the_live_page_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("zones.geojson");
        let place = NamedPlace { id: 3, name: "desk".to_owned(), pose: Pose2::new(1.0, 2.0, 0.5) };
        let zones = MapAnnotations { places: vec![place], ..MapAnnotations::default() };
        std::fs::write(&file, annotations_text(&zones)).unwrap();
        let places = read_places(&file).unwrap();
        assert!(places["desk"].distance(&Pose2::new(1.0, 2.0, 0.5)) < 1e-9 && places.len() == 1);
        std::fs::write(&file, "{}").unwrap();
        assert!(read_places(&file).unwrap_err().to_string().contains("FeatureCollection"));
    }

    #[test]
    fn errors_name_the_line_or_the_place() {
        for (text, problem) in [
            ("[a]\nx = 1\ny = 2\n", "p.toml, line 1: the key heading_deg is missing"),
            ("[a]\nx = 1\ny = 'two'\nheading_deg = 0", "p.toml, line 3: y is \"two\", expected a number"),
            ("[a]\nx = 1\ny = nan\nheading_deg = 0", "p.toml: a.y is NaN m, expected -1000000 to 1000000"),
            ("[\"\"]\nx = 1\ny = 1\nheading_deg = 0", "p.toml: a place has no name"),
        ] {
            assert_eq!(read(text).unwrap_err(), problem);
        }
        assert!(read("[a]\nx = 1\ny = 1\nheading_deg = 0\ntheta = 1").unwrap_err().contains("theta"));
        assert!(read("[a]\nx = 1\n[a]\n").unwrap_err().starts_with("p.toml, line 3: "));
    }
}
