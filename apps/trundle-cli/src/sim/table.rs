use super::{SimArgs, journey::Journey};
use crate::console;
use std::path::Path;
use trundle::io::Summary;
use trundle::sim::Simulator;

impl Journey {
    /// Prints what happened, and what to do with the data.
    pub fn print(&self, scene: &str, place: Option<&Path>, robot: &Simulator) {
        console::print(&format!("{scene}: {}", self.verdict()));
        console::print_table(&self.rows());
        if let Some(place) = place {
            let height = robot.config().base_from_camera.translation.z;
            let ahead = robot.config().base_from_camera.rotate(trundle::core::Vector3::z());
            let tilt = (-ahead.z).asin().to_degrees();
            console::print(&format!(
                "Wrote {0}; try: trundle slam {0} --height {height:.2} --tilt {tilt:.0}",
                place.display()
            ));
        }
    }

    /// The numbers for scripts; nothing of the wall clock, so that equal drives make equal files.
    pub fn summary(&self, args: &SimArgs, scene: &str) -> Summary {
        let mut summary = Summary::new("sim");
        summary
            .set("scene", scene)
            .set("seed", args.seed)
            .set("success", self.is_complete)
            .set("duration_s", self.time)
            .set("path_length_m", self.distance)
            .set("contacts", self.contacts)
            .set("images", self.images)
            .set("scans", self.scans)
            .set("waypoints_reached", self.waypoints.map(|(reached, _)| reached))
            .set("waypoints", self.waypoints.map(|(_, all)| all));
        summary
    }

    fn verdict(&self) -> String {
        match self.waypoints {
            Some((reached, all)) if reached == all => "every way-point reached.".to_owned(),
            Some((reached, all)) => format!("way-point {} of {all} not reached.", reached + 1),
            None => "done.".to_owned(),
        }
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        let mut rows = vec![
            row("driven", format!("{:.2} m", self.distance)),
            row("time", format!("{:.1} s", self.time)),
            row("contacts", self.contacts.to_string()),
            row("images", self.images.to_string()),
        ];
        if self.scans > 0 {
            rows.push(row("laser sweeps", self.scans.to_string()));
        }
        if let Some((reached, all)) = self.waypoints {
            rows.push(row("way-points reached", format!("{reached} of {all}")));
        }
        let factor = self.time / self.seconds.max(1e-3);
        rows.push(row("wall clock", format!("{:.1} s", self.seconds)));
        rows.push(row("times real time", format!("{factor:.1}")));
        rows
    }
}
