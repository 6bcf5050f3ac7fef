//! Annotations of a map: zones and named places.

use crate::zone::require_name;
use crate::{Invalid, MAX_COORDINATE_M, Pose2, Vector2, Zone, require_in};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Largest number of zones and places of a map. Source: ours; a floor of a hotel has 100 rooms.
const MAX_ANNOTATIONS: usize = 400;
/// Largest number of corners of all zones together. Each change is recorded as a whole list. Source: ours; 100 kB.
const MAX_CORNERS_OF_MAP: usize = 4000;

/// Zones and named places of a map, map frame.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapAnnotations {
    /// The zones.
    pub zones: Vec<Zone>,
    /// The named places.
    pub places: Vec<NamedPlace>,
}

/// A pose with a name, map frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedPlace {
    /// Number of the place, unique among zones and places of a map.
    pub id: u32,
    /// Name of the place, unique among the places of a map.
    pub name: String,
    /// `map_from_base` of a robot at the place.
    pub pose: Pose2,
}

impl MapAnnotations {
    /// Whether the map has no zones and no places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.zones.is_empty() && self.places.is_empty()
    }

    /// A number that no zone and no place has.
    #[must_use]
    pub fn free_id(&self) -> u32 {
        self.ids().max().map_or(1, |max| max.saturating_add(1))
    }

    /// The pose of the place of this name.
    #[must_use]
    pub fn pose_of(&self, name: &str) -> Option<Pose2> {
        self.places.iter().find(|place| place.name == name).map(|place| place.pose)
    }

    /// The zones and places in another map frame; `frame` is the pose of the present frame in it.
    #[must_use]
    pub fn moved(mut self, frame: Pose2) -> Self {
        for corner in self.zones.iter_mut().flat_map(|zone| &mut zone.outline) {
            let at = frame.transform(Vector2::new(corner[0], corner[1]));
            *corner = [at.x, at.y];
        }
        self.places.iter_mut().for_each(|place| place.pose = frame * place.pose);
        self
    }

    /// The annotations, their numbers checked.
    ///
    /// # Errors
    /// When a zone or place is invalid, their number is too large, a number is repeated, or two places have one name.
    pub fn validated(self) -> Result<Self, Invalid> {
        let count = self.zones.len() + self.places.len();
        if count > MAX_ANNOTATIONS {
            let expected = format!("at most {MAX_ANNOTATIONS}");
            return Err(Invalid::new("number of zones and places", count, "", expected));
        }
        let corners: usize = self.zones.iter().map(|zone| zone.outline.len()).sum();
        if corners > MAX_CORNERS_OF_MAP {
            let expected = format!("at most {MAX_CORNERS_OF_MAP}");
            return Err(Invalid::new("number of corners of all zones", corners, "", expected));
        }
        let mut ids = BTreeSet::new();
        if let Some(id) = self.ids().find(|id| !ids.insert(*id)) {
            return Err(Invalid::new("id of a zone or place", format!("{id} twice"), "", "another for each"));
        }
        let mut names = BTreeSet::new();
        if let Some(place) = self.places.iter().find(|place| !names.insert(&place.name)) {
            let value = format!("'{}' twice", place.name);
            return Err(Invalid::new("name of a place", value, "", "another for each place"));
        }
        let zones = self.zones.into_iter().map(Zone::validated).collect::<Result<_, _>>()?;
        let places = self.places.into_iter().map(NamedPlace::validated).collect::<Result<_, _>>()?;
        Ok(Self { zones, places })
    }

    fn ids(&self) -> impl Iterator<Item = u32> + '_ {
        self.zones.iter().map(|zone| zone.id).chain(self.places.iter().map(|place| place.id))
    }
}

impl NamedPlace {
    fn validated(self) -> Result<Self, Invalid> {
        require_name("a place", &self.name)?;
        if self.name.trim().is_empty() {
            return Err(Invalid::new("name of a place", "empty", "", "a word or more"));
        }
        let range = (-MAX_COORDINATE_M, MAX_COORDINATE_M);
        require_in(&format!("x of the place '{}'", self.name), self.pose.x, "m", range.0, range.1)?;
        require_in(&format!("y of the place '{}'", self.name), self.pose.y, "m", range.0, range.1)?;
        let turn = std::f64::consts::TAU;
        require_in(&format!("heading of the place '{}'", self.name), self.pose.theta, "rad", -turn, turn)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ZoneKind;

    fn place(id: u32, name: &str) -> NamedPlace {
        NamedPlace { id, name: name.to_owned(), pose: Pose2::new(1.0, 2.0, 0.5) }
    }

    fn zone(id: u32) -> Zone {
        let outline = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        Zone { id, name: String::new(), kind: ZoneKind::Slow(0.25), outline }
    }

    #[test]
    fn places_are_found_by_name_and_numbers_are_free() {
        let map = MapAnnotations { zones: vec![zone(4)], places: vec![place(2, "desk"), place(7, "door")] };
        let map = map.validated().unwrap();
        assert_eq!((map.pose_of("door"), map.pose_of("Door")), (Some(Pose2::new(1.0, 2.0, 0.5)), None));
        assert_eq!((map.free_id(), MapAnnotations::default().free_id()), (8, 1));
    }

    #[test]
    fn repeated_names_and_invalid_places_are_refused() {
        let refusal = |zones, places| MapAnnotations { zones, places }.validated().unwrap_err().to_string();
        assert!(refusal(vec![zone(1)], vec![place(1, "a")]).contains("1 twice"));
        assert!(refusal(vec![], vec![place(1, "a"), place(2, "a")]).contains("'a' twice"));
        assert!(refusal(vec![], vec![place(1, " ")]).contains("a word or more"));
        let nowhere = NamedPlace { pose: Pose2 { x: f64::NAN, y: 0.0, theta: 0.0 }, ..place(1, "a") };
        assert_eq!(
            refusal(vec![], vec![nowhere]),
            "x of the place 'a' is NaN m, expected -1000000 to 1000000"
        );
        assert!(refusal((0..401).map(zone).collect(), vec![]).contains("is 401, expected at most 400"));
    }

    #[test]
    fn annotations_keep_their_form_in_recordings() {
        let map = MapAnnotations { zones: vec![zone(4)], places: vec![place(2, "desk")] };
        let text = serde_json::to_string(&map).unwrap();
        assert_eq!(
            text,
            r#"{"zones":[{"id":4,"name":"","kind":{"slow":0.25},"outline":[[0.0,0.0],[1.0,0.0],[0.0,1.0]]}],"places":[{"id":2,"name":"desk","pose":{"x":1.0,"y":2.0,"theta":0.5}}]}"#
        );
        assert_eq!(serde_json::from_str::<MapAnnotations>(&text).unwrap(), map);
    }
}
