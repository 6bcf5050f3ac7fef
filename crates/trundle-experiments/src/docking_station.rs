//! Docking at a charging station from many starts: share of docks that succeed, and the pose at contact.

#[cfg(test)]
mod tests;
mod trial;

pub use trial::{DockPlan, DockTrial, body_of, dock, docking_alone};

use crate::run_each::run_each;
use crate::{ExperimentContext, ExperimentReport, RunResult, RunsRequest};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use trundle_app::AppError;
use trundle_core::Pose2;
use trundle_io::{OutputFolder, Summary, table_csv};
use trundle_sim::Scene;
use trundle_viz::{Report, Table, Verdict};

/// Half of the side of the square of starts \[m\]. Source: the room of 6 x 6 m.
const START_HALF_SIDE_M: f64 = 2.5;
/// Smallest distance of a start from the station \[m\]: clearance for the robot and the station's box. Source: ours.
const MIN_START_DISTANCE_M: f64 = 0.5;
/// Steps of the low-discrepancy sequence of starts. Source: Roberts 2018, three dimensions.
const START_STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
/// Limits of the pose at contact. Source: ours, the plates' tolerances.
const MAX_LATERAL_ERROR_M: f64 = 0.01;

/// The docks, one for each start.
pub struct DocksOutcome {
    /// Trials in the order of the starts.
    pub trials: Vec<(Pose2, DockTrial)>,
}

/// Docks from one start per seed, in the room with a station at its east wall.
///
/// # Errors
/// When a number of the robot is outside its range.
pub fn run(request: &RunsRequest, context: &ExperimentContext) -> Result<DocksOutcome, AppError> {
    let seeds: Vec<u64> = (1..=u64::from(request.seeds)).collect();
    let dock_from = |seed: u64, watch| {
        let start = start_of(seed);
        let scene = Scene { start, ..Scene::by_name("room", seed)? }.with_station(station())?;
        let (robot, mission) = (request.robot.clone(), docking_alone()?);
        let body = body_of(&robot)?;
        let (trial, _) = dock(DockPlan { scene, robot, body, mission, seed }, watch)?;
        Ok(DockFrom(start, trial))
    };
    let docks = run_each(seeds, "docks", context, |seed| format!("seed {seed}"), dock_from)?;
    Ok(DocksOutcome { trials: docks.into_iter().map(|DockFrom(start, trial)| (start, trial)).collect() })
}

/// A dock and its start.
#[derive(Serialize, Deserialize)]
struct DockFrom(Pose2, DockTrial);

impl RunResult for DockFrom {
    fn is_success(&self) -> bool {
        self.1.is_docked() && self.1.contacts == 0
    }

    fn sentence(&self) -> String {
        format!("{} after {:.0} s, {} contacts", self.1.state, self.1.time, self.1.contacts)
    }
}

/// The station at the east wall of the room, x out of its front.
fn station() -> Pose2 {
    Pose2::new(2.9, 0.4, PI)
}

/// The start of a seed: evenly distributed over the room and over all headings.
fn start_of(seed: u64) -> Pose2 {
    let at = |i: u64| {
        let [x, y, turn] = START_STEPS.map(|step| (0.5 + i as f64 * step).fract());
        let coordinate = |part: f64| START_HALF_SIDE_M * (2.0 * part - 1.0);
        Pose2::new(coordinate(x), coordinate(y), TAU * turn)
    };
    // A start too near to the station is replaced by one far beyond the others in the sequence.
    let places = (0..).map(|k| at(seed + 100_000 * k));
    places
        .into_iter()
        .find(|pose| pose.distance(&station()) >= MIN_START_DISTANCE_M)
        .unwrap_or(Pose2::IDENTITY)
}

const HEADER: [&str; 7] =
    ["start, m, deg", "end", "time, s", "across, mm", "heading, deg", "contacts", "path, m"];

impl DocksOutcome {
    fn docked(&self) -> impl Iterator<Item = &DockTrial> {
        self.trials.iter().map(|(_, trial)| trial).filter(|trial| trial.is_docked())
    }

    /// Number of docks within the limits, without contact.
    fn within_limits(&self) -> usize {
        let is_good =
            |trial: &&DockTrial| trial.contacts == 0 && trial.lateral_error().abs() <= MAX_LATERAL_ERROR_M;
        self.docked().filter(is_good).count()
    }

    fn contacts(&self) -> u32 {
        self.trials.iter().map(|(_, trial)| trial.contacts).sum()
    }

    fn rows(&self) -> Vec<Vec<String>> {
        self.trials.iter().map(|(start, trial)| row(start, trial)).collect()
    }

    /// Root mean square over the successful docks.
    fn rms(&self, of: impl Fn(&DockTrial) -> f64) -> f64 {
        let squares: Vec<f64> = self.docked().map(|trial| of(trial).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }
}

fn row(start: &Pose2, trial: &DockTrial) -> Vec<String> {
    vec![
        format!("({:.2}, {:.2}, {:.0})", start.x, start.y, start.theta.to_degrees()),
        if trial.is_docked() { "docked".to_owned() } else { trial.state.to_string() },
        format!("{:.0}", trial.time),
        format!("{:.1}", trial.lateral_error() * 1e3),
        format!("{:.2}", trial.heading_error().to_degrees()),
        trial.contacts.to_string(),
        format!("{:.1}", trial.path_length),
    ]
}

impl ExperimentReport for DocksOutcome {
    fn is_success(&self) -> bool {
        !self.trials.is_empty() && self.within_limits() == self.trials.len()
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(self.rows()).collect()
    }

    fn verdict(&self) -> String {
        let (docked, all) = (self.docked().count(), self.trials.len());
        let (across, heading) = (self.rms(DockTrial::lateral_error), self.rms(DockTrial::heading_error));
        format!(
            "{docked} of {all} docks; at contact {:.1} mm across and {:.2} deg (root mean square); {} contacts.",
            across * 1e3,
            heading.to_degrees(),
            self.contacts()
        )
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let text = self.verdict();
        let verdict = if self.is_success() { Verdict::Ok(text) } else { Verdict::Failed(text) };
        let table = self.rows().into_iter().fold(Table::new("Docks", HEADER), Table::row);
        let report = Report::new("Docking at a charging station").verdict(verdict).table(table.wide());
        let numbers = |(start, trial): &(Pose2, DockTrial)| {
            let docked = f64::from(u8::from(trial.is_docked()));
            let (across, heading) = (trial.lateral_error(), trial.heading_error());
            [start.x, start.y, start.theta, docked, trial.time, across, heading, f64::from(trial.contacts)]
        };
        let header = ["x_m", "y_m", "theta_rad", "docked", "time_s", "across_m", "heading_rad", "contacts"];
        let mut summary = Summary::new("experiment docking-station");
        summary
            .set("success", self.is_success())
            .set("docks", self.trials.len())
            .set("docked", self.docked().count())
            .set("within_limits", self.within_limits())
            .set("contacts", self.contacts())
            .set("across_rms_m", self.rms(DockTrial::lateral_error))
            .set("heading_rms_rad", self.rms(DockTrial::heading_error));
        folder.write("docks.csv", table_csv(header, self.trials.iter().map(numbers)).as_bytes())?;
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.write("summary.json", summary.to_json().as_bytes())?;
        Ok(())
    }
}
