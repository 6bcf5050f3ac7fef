//! Changes of zones and named places.

use trundle_core::{Invalid, MapAnnotations, NamedPlace, Zone};

/// A change of zones and named places.
#[derive(Debug, Clone, PartialEq)]
pub enum AnnotationEdit {
    /// Replaces the zone with the same number; number 0 adds a zone.
    SetZone(Zone),
    /// No zone with this number.
    RemoveZone(u32),
    /// Replaces the place with the same number; number 0 adds a place.
    SetPlace(NamedPlace),
    /// No place with this number.
    RemovePlace(u32),
}

impl AnnotationEdit {
    /// The annotations after the change.
    ///
    /// # Errors
    /// When no zone or place has the number, or the new one is invalid.
    pub fn applied_to(&self, annotations: &MapAnnotations) -> Result<MapAnnotations, Invalid> {
        let mut next = annotations.clone();
        let free = next.free_id();
        match self.clone() {
            Self::SetZone(zone) => set(&mut next.zones, |zone| &mut zone.id, zone, free)?,
            Self::SetPlace(place) => set(&mut next.places, |place| &mut place.id, place, free)?,
            Self::RemoveZone(id) => remove(&mut next.zones, |zone| zone.id, id)?,
            Self::RemovePlace(id) => remove(&mut next.places, |place| place.id, id)?,
        }
        next.validated()
    }
}

fn set<T>(list: &mut Vec<T>, id: fn(&mut T) -> &mut u32, mut entry: T, free: u32) -> Result<(), Invalid> {
    let number = *id(&mut entry);
    if number == 0 {
        *id(&mut entry) = free;
        list.push(entry);
        return Ok(());
    }
    let known = list.iter_mut().find_map(|known| (*id(known) == number).then_some(known));
    *known.ok_or_else(|| missing(number))? = entry;
    Ok(())
}

fn remove<T>(list: &mut Vec<T>, id: fn(&T) -> u32, number: u32) -> Result<(), Invalid> {
    let at = list.iter().position(|entry| id(entry) == number).ok_or_else(|| missing(number))?;
    list.remove(at);
    Ok(())
}

fn missing(number: u32) -> Invalid {
    Invalid::new(
        "number of a zone or place",
        number,
        "",
        "one that there is: another viewer may have deleted it",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Pose2, ZoneKind};

    fn zone(id: u32, name: &str) -> Zone {
        let outline = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        Zone { id, name: name.to_owned(), kind: ZoneKind::NoGo, outline }
    }

    fn place(id: u32, name: &str) -> NamedPlace {
        NamedPlace { id, name: name.to_owned(), pose: Pose2::new(1.0, 2.0, 0.5) }
    }

    #[test]
    fn zones_and_places_are_added_changed_and_removed() {
        let mut map = MapAnnotations::default();
        for edit in [
            AnnotationEdit::SetZone(zone(0, "stairs")),
            AnnotationEdit::SetPlace(place(0, "desk")),
            AnnotationEdit::SetZone(zone(0, "rug")),
            AnnotationEdit::SetZone(zone(1, "steps")),
            AnnotationEdit::SetPlace(place(2, "table")),
            AnnotationEdit::RemoveZone(3),
        ] {
            map = edit.applied_to(&map).unwrap();
        }
        assert_eq!(map, MapAnnotations { zones: vec![zone(1, "steps")], places: vec![place(2, "table")] });
    }

    #[test]
    fn missing_and_impossible_zones_are_refused() {
        let map = MapAnnotations { zones: vec![zone(1, "")], places: vec![place(2, "desk")] };
        for edit in [
            AnnotationEdit::RemoveZone(2),
            AnnotationEdit::RemovePlace(1),
            AnnotationEdit::SetZone(zone(7, "")),
            AnnotationEdit::SetPlace(place(0, "desk")),
            AnnotationEdit::SetZone(Zone { outline: vec![], ..zone(1, "") }),
        ] {
            assert!(edit.applied_to(&map).is_err(), "{edit:?}");
        }
    }
}
