//! Fault scenarios: failing sensors, slipping wheels, people in the path. Contacts are failures. A robot without a usable view must stop,
//! report the reason, and continue when the view is back.

use crate::trial::{self, ComputerFault, Trial, TrialPlan};
use crate::{ExperimentContext, ExperimentReport, RunsRequest, missions};
use trundle_app::AppError;
use trundle_core::{Pose2, Vector2};
use trundle_eval::GoalError;
use trundle_io::{OutputFolder, Summary};
use trundle_runtime::{DriveState, Mission, ReasonKind, RobotConfig, Task};
use trundle_sim::{Fault, FaultKind, FaultSchedule, Person, Scene, WheelSide};
use trundle_viz::{Figure, Report, Table, Verdict};

/// Required end of a scenario.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    /// The robot is at the goal, within 5 cm and 3 deg.
    Arrived,
    /// The robot is at rest, with a reason of one of these kinds.
    Stopped(&'static [ReasonKind]),
    /// The same within [`CLOSED_DOOR_TIME_S`].
    StoppedSoon(&'static [ReasonKind]),
    /// At rest with a reason of one of these kinds, or at the goal within 15 cm and 5 deg after localization by scans alone.
    FoundOrStopped(&'static [ReasonKind]),
}

/// A fault scenario.
struct FaultScenario {
    name: &'static str,
    scene: &'static str,
    /// Faults with start and end, s.
    faults: Vec<(f64, f64, FaultKind)>,
    person: Option<Person>,
    /// Whether the person is in the frame of the goal instead of the start's.
    at_goal: bool,
    computer_fault: Option<ComputerFault>,
    /// As in [`TrialPlan`].
    camera_rate_hz: Option<f64>,
    end: End,
}

/// Longest time of a run to a goal behind a door that stays closed \[s\]: the drive to the door, and a patience of 75 s. Source: ours.
const CLOSED_DOOR_TIME_S: f64 = 120.0;

/// End of a permanent fault, s.
const FOREVER_S: f64 = f64::INFINITY;

/// The fault scenarios.
fn scenarios() -> Vec<FaultScenario> {
    let broken = |name, from, to, kind, end| FaultScenario {
        name,
        scene: "demo",
        faults: vec![(from, to, kind)],
        person: None,
        at_goal: false,
        computer_fault: None,
        camera_rate_hz: None,
        end,
    };
    let plain = |name, scene, end| FaultScenario {
        scene,
        faults: Vec::new(),
        ..broken(name, 0.0, 0.0, FaultKind::CameraBlack, end)
    };
    let two = |name, faults: [(f64, f64, FaultKind); 2], end| FaultScenario {
        faults: faults.to_vec(),
        ..plain(name, "demo", end)
    };
    let slips = FaultKind::WheelSlips { side: WheelSide::Left, factor: 0.5 };
    let jump = FaultKind::OdometryJumps { left_ticks: 11_724, right_ticks: 11_724 };
    let carried = FaultKind::Kidnapped { x: 0.6, y: 0.3, heading_deg: 20.0 };
    vec![
        broken("camera black for 10 s", 8.0, 18.0, FaultKind::CameraBlack, End::Arrived),
        broken("camera frozen for 10 s", 8.0, 18.0, FaultKind::CameraFrozen, End::Arrived),
        broken(
            "camera gone",
            8.0,
            FOREVER_S,
            FaultKind::CameraDropped { probability: 1.0 },
            End::Stopped(&[ReasonKind::ImageMissing]),
        ),
        broken("lights out", 8.0, FOREVER_S, FaultKind::LightsOut, End::Arrived),
        broken("depth gone for 10 s", 8.0, 18.0, FaultKind::DepthGone, End::Arrived),
        broken("depth gone", 8.0, FOREVER_S, FaultKind::DepthGone, End::Stopped(&[ReasonKind::ImageMissing])),
        broken("frames late by 500 ms", 0.0, FOREVER_S, FaultKind::CameraLate { delay_s: 0.5 }, End::Arrived),
        broken("a wheel slips on a carpet", 8.0, 11.0, slips, End::Arrived),
        broken("gyro stuck", 8.0, FOREVER_S, FaultKind::GyroStuck, End::Arrived),
        broken("encoders stuck", 8.0, FOREVER_S, FaultKind::EncodersStuck, End::Arrived),
        broken("odometry jumps 1 m", 10.0, 10.1, jump, End::Arrived),
        broken("kidnapped while driving", 12.0, 12.1, carried, End::Arrived),
        FaultScenario {
            camera_rate_hz: Some(30.0),
            ..broken("kidnapped, camera of 30 Hz", 12.0, 12.1, carried, End::Arrived)
        },
        FaultScenario {
            camera_rate_hz: Some(6.0),
            ..broken("kidnapped, camera of 6 Hz", 12.0, 12.1, carried, End::Arrived)
        },
        two(
            "in the dark, encoders stuck",
            [(8.0, FOREVER_S, FaultKind::LightsOut), (8.0, FOREVER_S, FaultKind::EncodersStuck)],
            End::Stopped(&[ReasonKind::WheelsUnresponsive, ReasonKind::MotionUnknown]),
        ),
        two(
            "dark for 10 s, encoders stuck",
            [(8.0, 18.0, FaultKind::LightsOut), (8.0, FOREVER_S, FaultKind::EncodersStuck)],
            End::Arrived,
        ),
        two(
            "gyro stuck, encoders for 14 s",
            [(5.0, FOREVER_S, FaultKind::GyroStuck), (6.0, 20.0, FaultKind::EncodersStuck)],
            End::Arrived,
        ),
        two(
            "carried away in the dark",
            [(8.0, FOREVER_S, FaultKind::LightsOut), (12.0, 12.1, carried)],
            End::FoundOrStopped(&[ReasonKind::PoseUnknown]),
        ),
        FaultScenario {
            person: Some(in_the_door(60.0)),
            ..plain("a person in the door for a minute", "house", End::Arrived)
        },
        FaultScenario {
            person: Some(in_the_door(3600.0)),
            ..plain("the door stays closed", "house", End::StoppedSoon(&[ReasonKind::PathBlocked]))
        },
        FaultScenario {
            person: Some(onto_the_goal()),
            at_goal: true,
            ..plain("the goal becomes unreachable", "demo", End::Stopped(&[ReasonKind::NoProgress]))
        },
        FaultScenario {
            computer_fault: Some(ComputerFault::FullDisk),
            ..plain("the disk is full", "demo", End::Arrived)
        },
        FaultScenario {
            computer_fault: Some(ComputerFault::Restart(17.0)),
            ..plain("killed and restarted during the drive", "demo", End::Arrived)
        },
    ]
}

/// A person who stands in the door of the house's bedroom for `delay` s and then goes inside; frame of the robot's start.
fn in_the_door(delay: f64) -> Person {
    Person { waypoints: vec![[6.67, 0.6], [6.67, 1.3], [5.9, 2.0]], delay, once: true, ..Person::default() }
}

/// A person who steps onto the goal while the robot drives, and stays; frame of the goal.
fn onto_the_goal() -> Person {
    Person { waypoints: vec![[0.6, 0.0], [0.0, 0.0]], delay: 10.0, once: true, ..Person::default() }
}

/// The runs of the fault scenarios.
pub struct FaultsOutcome {
    /// A run for each scenario and seed.
    pub trials: Vec<Trial>,
}

/// Runs every fault scenario, with each seed.
///
/// # Errors
/// When a run cannot be created, or no run has the requested name.
pub fn run(request: &RunsRequest, context: &ExperimentContext) -> Result<FaultsOutcome, AppError> {
    let mut plans = Vec::new();
    for scenario in scenarios() {
        for seed in 1..=u64::from(request.seeds) {
            plans.push(scenario.plan(seed, &request.robot)?);
        }
    }
    Ok(FaultsOutcome { trials: trial::run_all(plans, request, context)? })
}

impl FaultScenario {
    fn plan(&self, seed: u64, robot: &RobotConfig) -> Result<TrialPlan, AppError> {
        let mut scene = Scene::by_name(self.scene, seed)?;
        let frame = if self.at_goal { scene.goal } else { scene.start };
        scene.people.extend(self.person.clone().map(|person| placed(person, frame)));
        let mission = Mission::new(vec![Task::go(scene.start_from_goal())])?;
        let fault = |&(from_s, to_s, kind)| Fault { from_s, to_s, kind: in_world(kind, &scene) };
        let faults = FaultSchedule { faults: self.faults.iter().map(fault).collect() };
        Ok(TrialPlan {
            faults,
            computer_fault: self.computer_fault,
            camera_rate_hz: self.camera_rate_hz,
            ..TrialPlan::new(self.name, seed, scene, mission, robot)
        })
    }
}

impl ExperimentReport for FaultsOutcome {
    fn is_success(&self) -> bool {
        self.trials.iter().all(is_good)
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(self.trials.iter().map(row)).collect()
    }

    fn verdict(&self) -> String {
        verdict(&self.trials)
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let success = self.is_success();
        folder.write("report.html", report(&self.trials, success).to_html().as_bytes())?;
        folder.write("summary.json", summary(&self.trials, success).to_json().as_bytes())?;
        Ok(())
    }
}

/// A person of a given frame, in the world frame.
fn placed(person: Person, world_from_frame: Pose2) -> Person {
    let world = |point: &[f64; 2]| world_from_frame.transform(Vector2::new(point[0], point[1])).into();
    Person { waypoints: person.waypoints.iter().map(world).collect(), ..person }
}

/// Converts a kidnapping from the frame of the robot's start to the world frame.
fn in_world(kind: FaultKind, scene: &Scene) -> FaultKind {
    match kind {
        FaultKind::Kidnapped { x, y, heading_deg } => {
            let Pose2 { x, y, theta } = scene.start * Pose2::new(x, y, heading_deg.to_radians());
            FaultKind::Kidnapped { x, y, heading_deg: theta.to_degrees() }
        }
        other => other,
    }
}

const HEADER: [&str; 6] = ["scenario", "seed", "as it should", "contacts", "time, s", "end"];

/// Whether the run has no contact and the required end of its scenario.
fn is_good(trial: &Trial) -> bool {
    let numbers = &trial.numbers;
    let end =
        scenarios().into_iter().find(|scenario| scenario.name == trial.name).map(|scenario| scenario.end);
    let as_it_should = match (end, &numbers.end.state) {
        (Some(End::Arrived), _) => numbers.is_success(),
        (Some(End::Stopped(kinds) | End::FoundOrStopped(kinds)), DriveState::Stopped { reason }) => {
            kinds.iter().any(|kind| reason.is_due_to(*kind))
        }
        (Some(End::StoppedSoon(kinds)), DriveState::Stopped { reason }) => {
            kinds.iter().any(|kind| reason.is_due_to(*kind)) && numbers.duration <= CLOSED_DOOR_TIME_S
        }
        (Some(End::FoundOrStopped(_)), DriveState::Arrived) => numbers.goal_error.is_some_and(has_found),
        _ => false,
    };
    as_it_should && numbers.contacts == 0
}

fn has_found(error: GoalError) -> bool {
    error.distance < 0.15 && error.dtheta.abs().to_degrees() < 5.0
}

fn row(trial: &Trial) -> Vec<String> {
    let numbers = &trial.numbers;
    let end = match (&numbers.end.state, numbers.goal_error) {
        (DriveState::Arrived, Some(error)) => {
            format!("arrived, {:.1} cm, {:.2} deg off", error.distance * 100.0, error.dtheta.to_degrees())
        }
        (state, _) => state.to_string(),
    };
    vec![
        trial.name.clone(),
        trial.seed.to_string(),
        if is_good(trial) { "yes" } else { "NO" }.to_owned(),
        numbers.contacts.to_string(),
        format!("{:.1}", numbers.duration),
        end,
    ]
}

fn verdict(trials: &[Trial]) -> String {
    let good = trials.iter().filter(|trial| is_good(trial)).count();
    let contacts: usize = trials.iter().map(|trial| trial.numbers.contacts).sum();
    format!("{good} of {} fault scenarios ended as they should; {contacts} contacts.", trials.len())
}

fn report(trials: &[Trial], success: bool) -> Report {
    let verdict = if success { Verdict::Ok(verdict(trials)) } else { Verdict::Failed(verdict(trials)) };
    let table = trials.iter().map(row).fold(Table::new("Scenarios", HEADER), Table::row).wide();
    let report = Report::new("Fault scenarios")
        .subtitle("What breaks while the robot drives, and how it ends.")
        .verdict(verdict)
        .table(table);
    trials.iter().fold(report, |report, trial| {
        let figure = Figure::png(&format!("{}, seed {}", trial.name, trial.seed), &missions::picture(trial));
        report.figure(figure.caption(&trial.numbers.verdict())).table(trial.state_table())
    })
}

fn summary(trials: &[Trial], success: bool) -> Summary {
    let mut summary = Summary::new("experiment faults");
    summary.set("success", success).set("runs", trials.len());
    summary.set("contacts", trials.iter().map(|trial| trial.numbers.contacts).sum::<usize>());
    for trial in trials {
        let end = serde_json::json!({ "good": is_good(trial), "end": trial.numbers.end.state.to_string() });
        summary.set(&format!("{}, seed {}", trial.name, trial.seed), end);
    }
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::fixtures::{arrived, under_way};
    use std::collections::BTreeSet;

    #[test]
    fn every_scenario_has_a_name_of_its_own_and_a_valid_plan() {
        let names: BTreeSet<&str> = scenarios().iter().map(|scenario| scenario.name).collect();
        assert_eq!(names.len(), scenarios().len());
        for scenario in scenarios() {
            let plan = scenario.plan(1, &RobotConfig::default()).unwrap();
            plan.faults.validated().unwrap();
            assert_eq!(plan.name, scenario.name);
        }
    }

    #[test]
    fn an_arrival_counts_only_without_contact_and_near_the_goal() {
        let name = "gyro stuck";
        assert!(is_good(&arrived(name, 1, (0.01, 0.0, 0.0), 0)));
        assert!(!is_good(&arrived(name, 1, (0.01, 0.0, 0.0), 1)), "a contact");
        assert!(!is_good(&arrived(name, 1, (0.2, 0.0, 0.0), 0)), "far from the goal");
        assert!(!is_good(&under_way(name, 1)), "not arrived");
        assert!(!is_good(&arrived("no such scenario", 1, (0.0, 0.0, 0.0), 0)));
    }

    #[test]
    fn a_robot_that_must_stop_must_not_arrive() {
        assert!(!is_good(&arrived("camera gone", 1, (0.0, 0.0, 0.0), 0)));
        assert!(
            is_good(&arrived("carried away in the dark", 1, (0.1, 0.0, 0.05), 0)),
            "it may arrive or stop"
        );
        assert!(!is_good(&arrived("carried away in the dark", 1, (0.2, 0.0, 0.0), 0)));
    }

    #[test]
    fn verdict_and_table_agree() {
        let good = arrived("gyro stuck", 1, (0.0, 0.0, 0.0), 0);
        let outcome = FaultsOutcome { trials: vec![good, arrived("lights out", 1, (0.0, 0.0, 0.0), 2)] };
        assert!(outcome.verdict().starts_with("1 of 2") && outcome.verdict().contains("2 contacts"));
        let marks: Vec<String> = outcome.table().into_iter().map(|row| row[2].clone()).collect();
        assert_eq!(marks[1..], ["yes", "NO"]);
        assert!(!outcome.is_success());
    }

    #[test]
    fn persons_and_kidnappings_move_with_their_frame() {
        let frame = Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
        let person = placed(onto_the_goal(), frame);
        let [x, y] = person.waypoints[0];
        assert!((x - 1.0).abs() < 1e-9 && (y - 2.6).abs() < 1e-9, "{person:?}");
        let mut scene = Scene::by_name("room", 1).unwrap();
        scene.start = frame;
        let kind = in_world(FaultKind::Kidnapped { x: 1.0, y: 0.0, heading_deg: 0.0 }, &scene);
        let FaultKind::Kidnapped { x, y, heading_deg } = kind else { panic!("{kind:?}") };
        assert!((x - 1.0).abs() < 1e-9 && (y - 3.0).abs() < 1e-9 && (heading_deg - 90.0).abs() < 1e-9);
    }
}
