//! The numbers of a drive: verdict, table, summary.

use super::drive::SimDrive;
use std::path::Path;
use trundle_core::Vector3;
use trundle_io::Summary;
use trundle_sim::Simulator;

/// The verdict, a sentence.
#[must_use]
pub fn drive_verdict(drive: &SimDrive) -> String {
    if drive.is_interrupted {
        return "ended by the user.".to_owned();
    }
    match drive.waypoints {
        Some((reached, all)) if reached == all => "every way-point reached.".to_owned(),
        Some((reached, all)) => format!("way-point {} of {all} not reached.", reached + 1),
        None => "done.".to_owned(),
    }
}

/// The folder of a drive's recording, and a command that reads it.
#[must_use]
pub fn recording_hint(robot: &Simulator, folder: &Path) -> String {
    let base_from_camera = robot.config().base_from_camera;
    let height = base_from_camera.translation.z;
    let tilt = (-base_from_camera.rotate(Vector3::z()).z).asin().to_degrees();
    let folder = folder.display();
    format!("Wrote {folder}; try: trundle slam {folder} --height {height:.2} --tilt {tilt:.0}")
}

/// The table, with wall-clock rows at its end.
#[must_use]
pub fn drive_rows(drive: &SimDrive) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![
        row("driven", format!("{:.2} m", drive.distance)),
        row("time", format!("{:.1} s", drive.time)),
        row("contacts", drive.contacts.to_string()),
        row("images", drive.images.to_string()),
    ];
    if drive.scans > 0 {
        rows.push(row("laser sweeps", drive.scans.to_string()));
    }
    if let Some((reached, all)) = drive.waypoints {
        rows.push(row("way-points reached", format!("{reached} of {all}")));
    }
    let factor = drive.time / drive.seconds.max(1e-3);
    rows.push(row("wall clock", format!("{:.1} s", drive.seconds)));
    rows.push(row("times real time", format!("{factor:.1}")));
    rows
}

/// `summary.json`, without the wall clock: equal drives write equal files.
#[must_use]
pub fn drive_summary(drive: &SimDrive, scene: &str, seed: u64) -> Summary {
    let mut summary = Summary::new("sim");
    summary
        .set("scene", scene)
        .set("seed", seed)
        .set("success", drive.is_complete)
        .set("duration_s", drive.time)
        .set("path_length_m", drive.distance)
        .set("contacts", drive.contacts)
        .set("images", drive.images)
        .set("scans", drive.scans)
        .set("waypoints_reached", drive.waypoints.map(|(reached, _)| reached))
        .set("waypoints", drive.waypoints.map(|(_, all)| all))
        .set_interrupted(drive.is_interrupted);
    summary
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(waypoints: Option<(usize, usize)>, seconds: f64) -> SimDrive {
        let is_complete = waypoints.is_none_or(|(reached, all)| reached == all);
        SimDrive {
            time: 4.0,
            images: 8,
            scans: 0,
            distance: 1.5,
            contacts: 0,
            waypoints,
            is_complete,
            is_interrupted: false,
            seconds,
        }
    }

    #[test]
    fn the_verdict_names_the_first_way_point_that_was_missed() {
        assert_eq!(drive_verdict(&drive(Some((2, 2)), 1.0)), "every way-point reached.");
        assert_eq!(drive_verdict(&drive(Some((1, 3)), 1.0)), "way-point 2 of 3 not reached.");
        assert_eq!(drive_verdict(&drive(None, 1.0)), "done.");
    }

    #[test]
    fn the_table_has_rows_only_for_sensors_and_way_points_that_are_there() {
        let names =
            |drive: &SimDrive| drive_rows(drive).into_iter().map(|row| row[0].clone()).collect::<Vec<_>>();
        let plain = names(&drive(None, 1.0));
        assert!(
            !plain.contains(&"laser sweeps".to_owned()) && !plain.contains(&"way-points reached".to_owned())
        );
        let full = names(&SimDrive { scans: 3, ..drive(Some((1, 1)), 1.0) });
        assert!(full.contains(&"laser sweeps".to_owned()) && full.contains(&"way-points reached".to_owned()));
    }

    #[test]
    fn the_summary_does_not_depend_on_the_wall_clock() {
        let text = |seconds| drive_summary(&drive(None, seconds), "room", 1).to_json();
        assert_eq!(text(1.0), text(2.0));
    }
}
