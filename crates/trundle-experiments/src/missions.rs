//! Missions through unknown places: a room with obstacles crossed while it is mapped, and a house with ten goals.

use crate::data_sets::SMALL_HOUSE;
use crate::simulated::{MeshOptions, SceneOptions, load_scene, require_free};
use crate::trial::{self, Trial, TrialPlan};
use crate::{ExperimentContext, ExperimentReport, RunsRequest};
use std::path::Path;
use trundle_app::report::GoalOutcome;
use trundle_app::{AppError, PoseSample};
use trundle_core::{Pose2, Vector2};
use trundle_io::{OutputFolder, Summary, table_csv, write_map};
use trundle_runtime::{Mission, Task, TaskEnd};
use trundle_sim::Scene;
use trundle_sim::import::UpAxis;
use trundle_viz::{Color, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict};

/// An experiment of this kind.
struct MissionExperiment {
    /// Name on the command line.
    name: &'static str,
    /// Title of the report.
    title: &'static str,
    /// The requirement, in a sentence.
    subtitle: &'static str,
}

/// The room of [Li18] with obstacles: a drive to its other end with mapping.
const OBSTACLES: MissionExperiment = MissionExperiment {
    name: "obstacles",
    title: "An unknown room with obstacles",
    subtitle: "The second experiment of Li, Wang, Yu: a room with obstacles is crossed while it is mapped.",
};

/// The furnished house of AWS RoboMaker: ten goals in six rooms.
const HOUSE: MissionExperiment = MissionExperiment {
    name: "house",
    title: "Ten goals in a furnished house",
    subtitle: "From an empty map to ten goals in six rooms of small_house (AWS RoboMaker).",
};

/// The runs through an unknown place.
pub struct MissionsOutcome {
    experiment: &'static MissionExperiment,
    /// A run for each seed.
    pub trials: Vec<Trial>,
}

/// Crosses the room of obstacles, with each seed.
///
/// # Errors
/// When a run cannot be created, or no run has the requested name.
pub fn run_obstacles(
    request: &RunsRequest,
    context: &ExperimentContext,
) -> Result<MissionsOutcome, AppError> {
    run_story(&OBSTACLES, request, context, |seed| {
        let scene = Scene::by_name("obstacles", seed)?;
        let mission = Mission::new(vec![Task::go(scene.start_from_goal())])?;
        Ok((scene, mission))
    })
}

/// The goals, world frame: m, m, deg; by rooms. Source: ours.
const HOUSE_GOALS: [(f64, f64, f64); 10] = [
    (3.0, -1.0, 0.0),
    (6.2, -2.6, -90.0),
    (6.8, 2.5, 90.0),
    (3.0, 1.3, 180.0),
    (0.5, 2.6, 90.0),
    (-3.2, 0.0, 180.0),
    (-7.6, -0.6, 180.0),
    (-6.6, -2.8, -90.0),
    (-4.2, -4.0, 0.0),
    (1.0, -4.1, 0.0),
];

/// Drives to the ten goals of the house, whose mesh is the file `mesh` (z up), with each seed.
///
/// # Errors
/// When the mesh does not exist, a run cannot be created, or no run has the requested name.
pub fn run_house(
    request: &RunsRequest,
    mesh: &Path,
    context: &ExperimentContext,
) -> Result<MissionsOutcome, AppError> {
    if !mesh.exists() {
        let problem = format!("is not there, --mesh names its file: {}", SMALL_HOUSE.how_to_get());
        return Err(AppError::Input(format!("{} {problem}", mesh.display())));
    }
    let pose = |(x, y, degrees): (f64, f64, f64)| Pose2::new(x, y, degrees.to_radians());
    let start = Pose2::IDENTITY;
    run_story(&HOUSE, request, context, |seed| {
        let options = SceneOptions {
            seed,
            mesh: MeshOptions { up: UpAxis::Z, ..MeshOptions::default() },
            start: Some(start),
            station: None,
        };
        let scene = load_scene(&mesh.display().to_string(), options)?;
        for goal in HOUSE_GOALS {
            require_free("goal", &scene, pose(goal), &request.robot)?;
        }
        let goals = HOUSE_GOALS.map(|goal| Task::go(start.inverse() * pose(goal)));
        Ok((scene, Mission::new(goals.to_vec())?))
    })
}

/// Executes one run per seed, with the scene and the mission of `story_of`.
fn run_story(
    experiment: &'static MissionExperiment,
    request: &RunsRequest,
    context: &ExperimentContext,
    story_of: impl Fn(u64) -> Result<(Scene, Mission), AppError>,
) -> Result<MissionsOutcome, AppError> {
    let plan = |seed| -> Result<TrialPlan, AppError> {
        let (scene, mission) = story_of(seed)?;
        Ok(TrialPlan::new(&format!("seed {seed}"), seed, scene, mission, &request.robot))
    };
    let plans = (1..=u64::from(request.seeds)).map(plan).collect::<Result<Vec<_>, _>>()?;
    Ok(MissionsOutcome { experiment, trials: trial::run_all(plans, request, context)? })
}

impl ExperimentReport for MissionsOutcome {
    fn is_success(&self) -> bool {
        self.trials.iter().all(|trial| trial.numbers.is_success())
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(self.trials.iter().map(row)).collect()
    }

    fn verdict(&self) -> String {
        verdict(&self.trials)
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (experiment, trials, success) = (self.experiment, &self.trials, self.is_success());
        let text = self.verdict();
        let verdict = if success { Verdict::Ok(text) } else { Verdict::Failed(text) };
        let table = trials.iter().map(row).fold(Table::new("Runs", HEADER), Table::row);
        let mut report =
            Report::new(experiment.title).subtitle(experiment.subtitle).verdict(verdict).table(table);
        for trial in trials {
            let png = picture(trial);
            folder.write(&format!("seed-{}.png", trial.seed), &png)?;
            write_map(folder, &format!("seed-{}", trial.seed), &trial.grid)?;
            folder.write(&format!("seed-{}.csv", trial.seed), poses_csv(trial).as_bytes())?;
            let figure = Figure::png(&trial.name, &png).caption(&trial.numbers.verdict());
            report = report.figure(figure).table(trial.state_table());
        }
        folder.write(&format!("{}.csv", experiment.name), csv(trials).as_bytes())?;
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.write("summary.json", summary(experiment, trials, success).to_json().as_bytes())?;
        Ok(())
    }
}

/// Estimated and true pose at every image, map frame.
fn poses_csv(trial: &Trial) -> String {
    let header = [
        "t_s",
        "x_m",
        "y_m",
        "theta_rad",
        "true_x_m",
        "true_y_m",
        "true_theta_rad",
        "bound_95_m",
        "bound_95_rad",
        "nees",
    ];
    let row = |&PoseSample { at_s, estimate: here, truth, bound, nees }: &PoseSample| {
        [
            at_s,
            here.x,
            here.y,
            here.theta,
            truth.x,
            truth.y,
            truth.theta,
            bound.distance,
            bound.heading,
            nees.unwrap_or(f64::NAN),
        ]
    };
    table_csv(header, trial.poses.iter().map(row))
}

const HEADER: [&str; 7] =
    ["run", "goals reached", "worst goal, cm", "contacts", "driven, m", "time, s", "estimate rmse, cm"];

/// The number of reached goals, and of all.
fn reached(trial: &Trial) -> (usize, usize) {
    let there = trial.numbers.goals.iter().filter(|goal| goal.is_reached());
    (there.count(), trial.numbers.goals_asked.unwrap_or(0))
}

fn worst(trial: &Trial) -> f64 {
    let done = trial.numbers.goals.iter().filter(|goal: &&GoalOutcome| goal.end == TaskEnd::Done);
    done.filter_map(|goal| Some(goal.error?.distance)).fold(0.0, f64::max)
}

fn row(trial: &Trial) -> Vec<String> {
    let (good, all) = reached(trial);
    let numbers = &trial.numbers;
    vec![
        trial.name.clone(),
        format!("{good} of {all}"),
        format!("{:.1}", worst(trial) * 100.0),
        numbers.contacts.to_string(),
        format!("{:.1}", numbers.path_length),
        format!("{:.1}", numbers.duration),
        numbers.estimate_rmse.map_or_else(String::new, |e| format!("{:.1}", e * 100.0)),
    ]
}

fn verdict(trials: &[Trial]) -> String {
    let good = trials.iter().filter(|trial| trial.numbers.is_success()).count();
    let failed: Vec<String> = trials
        .iter()
        .filter(|trial| !trial.numbers.is_success())
        .map(|trial| format!("{}: {}", trial.name, trial.numbers.verdict()))
        .collect();
    let head = format!("{good} of {} runs reached every goal and touched nothing.", trials.len());
    std::iter::once(head).chain(failed).collect::<Vec<_>>().join("\n")
}

/// The map with the driven path and the goals.
pub(super) fn picture(trial: &Trial) -> Vec<u8> {
    let map_from_world = trial.world_from_map.inverse();
    let line = |points: &[Vector2]| points.iter().map(|&p| map_from_world.transform(p)).collect::<Vec<_>>();
    let mut picture = MapPicture::over(&trial.grid)
        .axes("x, m", "y, m")
        .polyline("planned last", &line(&trial.planned), LineStyle::dashed(Color::VERMILLION))
        .polyline("driven", &line(&trial.driven), LineStyle::solid(Color::BLUE))
        .pose("start", Pose2::IDENTITY, PoseStyle::named(Color::GREEN));
    for goal in &trial.numbers.goals {
        picture = picture.pose(&format!("{}", goal.task + 1), goal.goal, PoseStyle::named(Color::VERMILLION));
    }
    picture.to_png()
}

fn csv(trials: &[Trial]) -> String {
    let header =
        ["seed", "goal", "done", "dx_m", "dy_m", "distance_m", "dtheta_rad", "at_s", "contacts_of_run"];
    let rows = trials.iter().flat_map(|trial| {
        trial.numbers.goals.iter().map(move |goal| {
            let number =
                |value: fn(&trundle_eval::GoalError) -> f64| goal.error.as_ref().map_or(f64::NAN, value);
            [
                trial.seed as f64,
                (goal.task + 1) as f64,
                f64::from(u8::from(goal.end == TaskEnd::Done)),
                number(|e| e.dx),
                number(|e| e.dy),
                number(|e| e.distance),
                number(|e| e.dtheta),
                goal.at_s,
                trial.numbers.contacts as f64,
            ]
        })
    });
    table_csv(header, rows)
}

fn summary(experiment: &MissionExperiment, trials: &[Trial], success: bool) -> Summary {
    let mut summary = Summary::new(&format!("experiment {}", experiment.name));
    let good = trials.iter().filter(|trial| trial.numbers.is_success()).count();
    summary
        .set("success", success)
        .set("runs", trials.len())
        .set("runs_without_fault", good)
        .set("contacts", trials.iter().map(|trial| trial.numbers.contacts).sum::<usize>())
        .set("worst_goal_m", trials.iter().map(worst).fold(0.0, f64::max));
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::fixtures::{arrived, under_way};

    fn outcome(trials: Vec<Trial>) -> MissionsOutcome {
        MissionsOutcome { experiment: &OBSTACLES, trials }
    }

    #[test]
    fn the_verdict_gives_the_reason_of_each_failed_run() {
        let outcome = outcome(vec![arrived("seed 1", 1, (0.0, 0.0, 0.0), 0), under_way("seed 2", 2)]);
        assert!(!outcome.is_success());
        let text = outcome.verdict();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("1 of 2 runs"), "{text}");
        assert_eq!(lines.len(), 2);
        assert!(lines[1].starts_with("seed 2: "), "{text}");
    }

    #[test]
    fn the_table_has_a_row_for_each_run() {
        let outcome = outcome(vec![arrived("seed 1", 1, (0.0, 0.0, 0.0), 0), under_way("seed 2", 2)]);
        let table = outcome.table();
        assert!(table.len() == 3 && table.iter().all(|row| row.len() == HEADER.len()));
        assert_eq!(table[1][1], "0 of 1");
    }

    #[test]
    fn a_house_that_is_not_there_is_named() {
        let request = RunsRequest { seeds: 1, only: None, robot: trundle_runtime::RobotConfig::default() };
        let refused = run_house(&request, Path::new("no/house.glb"), &ExperimentContext::default());
        assert!(refused.err().unwrap().to_string().starts_with("no/house.glb is not there"));
    }

    #[test]
    fn the_folder_holds_map_poses_and_page_of_each_run() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&scratch.path().join("out")).unwrap();
        outcome(vec![arrived("seed 7", 7, (0.0, 0.0, 0.0), 0)]).write(&folder).unwrap();
        let place = folder.commit().unwrap();
        for name in ["seed-7.png", "seed-7.pgm", "seed-7.csv", "obstacles.csv", "report.html", "summary.json"]
        {
            assert!(place.join(name).exists(), "{name}");
        }
    }
}
