//! Zones and named places as front ends read and change them.

use super::annotation_edit::AnnotationEdit;
use super::link::Operator;
use super::operator_error::OperatorError;
use std::sync::Arc;
use trundle_core::{MapAnnotations, OccupancyGrid, Pose2};
use trundle_io::{annotations_text, replace_file};
use trundle_runtime::OperatorCommand;

impl Operator {
    /// Zones and named places of the map. Equal annotations share one allocation.
    #[must_use]
    pub fn annotations(&self) -> Arc<MapAnnotations> {
        Arc::clone(&self.annotation_store().newest)
    }

    /// Changes zones or places: sends them to the robot, and writes the file that keeps them.
    ///
    /// # Errors
    /// When the change is invalid, the run accepts no command, or the file cannot be written. In the last case the change is valid until
    /// the run ends.
    pub fn edit_annotations(&self, edit: &AnnotationEdit) -> Result<(), OperatorError> {
        // The file is written without the lock of the store, for which the run may wait.
        let _one_at_a_time = self.editing();
        let (text, file) = {
            let mut store = self.annotation_store();
            let next = edit.applied_to(&store.newest)?;
            self.send(OperatorCommand::Annotate(next.clone()))?;
            store.waiting += 1;
            store.newest = Arc::new(next);
            (annotations_text(&store.newest), store.file.clone())
        };
        let kept = file.map_or(Ok(()), |file| replace_file(&file, text.as_bytes()));
        kept.map_err(|error| OperatorError::NotKept(error.to_string()))
    }

    /// Gives the robot a map with its zones and places. They replace those of the old map once the robot has the new one.
    ///
    /// # Errors
    /// When the map is too large, too many requests wait, or the run is over.
    pub fn load_map(&self, grid: OccupancyGrid, annotations: MapAnnotations) -> Result<(), OperatorError> {
        let mut store = self.annotation_store();
        let id = self.send(OperatorCommand::LoadMap(Box::new(grid)))?;
        store.of_sent_map = Some((id, annotations));
        Ok(())
    }

    /// The goal pose of the place of this name, map frame.
    ///
    /// # Errors
    /// When the place does not exist; the error lists the known places.
    pub fn goal_of_place(&self, name: &str) -> Result<Pose2, OperatorError> {
        let annotations = self.annotations();
        annotations.pose_of(name).ok_or_else(|| {
            let known: Vec<&str> = annotations.places.iter().map(|place| place.name.as_str()).collect();
            OperatorError::NoPlace { name: name.to_owned(), known: known.join(", ") }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::operator_link;
    use super::*;
    use trundle_core::NamedPlace;
    use trundle_io::read_annotations;
    use trundle_runtime::StepReport;

    fn desk() -> NamedPlace {
        NamedPlace { id: 0, name: "desk".to_owned(), pose: Pose2::new(1.0, 2.0, 0.5) }
    }

    #[test]
    fn a_change_reaches_the_robot_and_the_file_and_two_changes_at_once_are_both_kept() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("zones.geojson");
        let (operator, link) = operator_link();
        operator.annotation_store().file = Some(file.clone());
        operator.edit_annotations(&AnnotationEdit::SetPlace(desk())).unwrap();
        let door = NamedPlace { name: "door".to_owned(), ..desk() };
        operator.edit_annotations(&AnnotationEdit::SetPlace(door)).unwrap();
        assert_eq!(read_annotations(&file).unwrap().places.len(), 2);
        assert_eq!(operator.goal_of_place("door").unwrap(), Pose2::new(1.0, 2.0, 0.5));
        link.next_request();
        let Some(OperatorCommand::Annotate(sent)) = link.next_request().map(|request| request.command) else {
            panic!("a command")
        };
        assert_eq!(sent, *operator.annotations());
    }

    #[test]
    fn a_change_that_waits_while_the_map_is_replaced_does_not_reach_the_new_map() {
        let (operator, mut link) = operator_link();
        operator.edit_annotations(&AnnotationEdit::SetPlace(desk())).unwrap();
        let mut report = StepReport::default();
        report.map_replaced = true;
        link.note_executed(0, &report);
        assert!(operator.annotations().places.is_empty());
        let door = NamedPlace { name: "door".to_owned(), ..desk() };
        operator.edit_annotations(&AnnotationEdit::SetPlace(door)).unwrap();
        let request = link.next_request().unwrap();
        link.note_request(&request);
        let OperatorCommand::Annotate(executed) = request.command else { panic!("a change") };
        assert_eq!((executed.places.len(), executed.places[0].name.as_str()), (1, "door"));
        assert_eq!((executed, link.next_request()), ((*operator.annotations()).clone(), None));
        assert_eq!(operator.annotation_store().waiting, 0);
    }

    #[test]
    fn the_zones_of_a_loaded_map_come_with_it_and_not_without() {
        let own = MapAnnotations { places: vec![desk()], ..MapAnnotations::default() };
        let grid = OccupancyGrid::from_ascii(0.05, "#.").unwrap();
        for is_replaced in [true, false] {
            let (operator, mut link) = operator_link();
            let old = NamedPlace { name: "old".to_owned(), ..desk() };
            operator.edit_annotations(&AnnotationEdit::SetPlace(old)).unwrap();
            let first = link.next_request().unwrap();
            link.note_request(&first);
            link.note_executed(first.id, &StepReport::default());
            operator.load_map(grid.clone(), own.clone()).unwrap();
            let load = link.next_request().unwrap();
            link.note_request(&load);
            let mut report = StepReport::default();
            report.map_replaced = is_replaced;
            link.note_executed(load.id, &report);
            let sent = link.next_request();
            if is_replaced {
                let sent = sent.unwrap();
                link.note_request(&sent);
                assert_eq!(sent.command, OperatorCommand::Annotate(own.clone()));
                assert_eq!(*operator.annotations(), own);
            } else {
                assert_eq!(sent, None);
                assert_eq!(operator.annotations().places[0].name, "old");
            }
            assert_eq!(operator.annotation_store().waiting, 0);
        }
    }

    #[test]
    fn an_unknown_place_and_a_wrong_change_are_refused_and_change_nothing() {
        let (operator, link) = operator_link();
        operator.edit_annotations(&AnnotationEdit::SetPlace(desk())).unwrap();
        let refusal = operator.goal_of_place("Desk").unwrap_err().to_string();
        assert_eq!(refusal, "no place 'Desk'; there are: desk");
        assert!(operator.edit_annotations(&AnnotationEdit::SetPlace(desk())).is_err());
        drop(link);
        assert!(matches!(
            operator.edit_annotations(&AnnotationEdit::RemovePlace(1)),
            Err(OperatorError::Over)
        ));
        assert_eq!(operator.annotations().places.len(), 1);
    }

    #[test]
    fn a_file_that_cannot_be_written_is_named() {
        let (operator, _link) = operator_link();
        operator.annotation_store().file = Some("/proc/nowhere/zones.geojson".into());
        let error = operator.edit_annotations(&AnnotationEdit::SetPlace(desk())).unwrap_err().to_string();
        assert!(error.contains("until the run ends") && error.contains("/proc/nowhere"), "{error}");
    }
}
