//! An operator's requests reach the robot, views are published, and a replay applies the requests at the same steps.

use crate::body::{GOAL, StillBody, setup};
use std::path::Path;
use trundle_app::operator::{FrontEnd, MissionView, Operator, ZONES_FILE, operator_link};
use trundle_app::report::write_run;
use trundle_app::{FinishedRun, Progress, RunLog, RunRecorder, RunReplayer, RunSetup, run_on_body};
use trundle_core::{Cell, MapAnnotations, NamedPlace, OccupancyGrid, Pose2, Twist2, Vector2, Zone, ZoneKind};
use trundle_io::{OutputFolder, annotations_text, read_annotations};
use trundle_runtime::{Mission, MotionHold, OperatorCommand, PoseGuess, Task};

fn operated() -> RunSetup {
    RunSetup::new("nowhere", Mission::default(), setup().robot).operated()
}

/// Runs a body at rest for 4 s with requests that wait from the start.
fn run_with(commands: &[OperatorCommand], folder: &Path) -> (FinishedRun, Operator) {
    let folder = OutputFolder::create(folder).unwrap();
    let (operator, link) = operator_link();
    for command in commands {
        operator.send(command.clone()).unwrap();
    }
    let front_end = FrontEnd { progress: Progress::hidden(), operator: Some(link) };
    let recorder = RunRecorder::to_folder(&folder).unwrap();
    let run =
        run_on_body(&operated(), &mut StillBody::new(200), recorder, RunLog::default(), front_end).unwrap();
    folder.commit().unwrap();
    (run, operator)
}

fn go(x: f64) -> OperatorCommand {
    OperatorCommand::Begin(Mission::new(vec![Task::go(Pose2 { x, ..GOAL })]).unwrap())
}

#[test]
fn the_newest_mission_replaces_the_last_one_and_is_shown_by_its_number() {
    let place = tempfile::tempdir().unwrap();
    let (_, operator) = run_with(&[go(1.0), OperatorCommand::Pause, go(2.0)], &place.path().join("run"));
    let view = operator.view().unwrap();
    let MissionView { id, task, is_over, .. } = view.mission.clone();
    assert_eq!((id, is_over), (3, false));
    assert!(matches!(task, Some(Task::Go(goal)) if goal.pose.x == 2.0), "{task:?}");
    assert_eq!(view.hold, Some(MotionHold::Paused));
    assert!(view.odometry.is_some() && view.map.is_some());
}

#[test]
fn a_mission_that_is_taken_away_leaves_the_robot_idle_and_the_run_goes_on() {
    let place = tempfile::tempdir().unwrap();
    let (run, operator) = run_with(&[go(1.0), OperatorCommand::cancel()], &place.path().join("run"));
    assert!(run.log.elapsed() > 3.9, "{} s", run.log.elapsed());
    let mission = &operator.view().unwrap().mission;
    assert_eq!((mission.id, mission.task, mission.is_over), (2, None, false));
    assert_eq!(run.log.state.name(), "idle");
}

#[test]
fn a_given_pose_replaces_the_estimate_and_a_replay_gives_the_same() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let pose = Pose2::new(3.0, -2.0, 1.0);
    let guess = PoseGuess { pose, position_sigma: 0.3, heading_sigma: 0.2 };
    // The estimate that the pose replaces begins with the first reading: the second run of the same body comes from its recording.
    let (run, _) = run_with(&[OperatorCommand::SetPose(guess), OperatorCommand::Pause], &folder);
    let (mut replayer, setup) = RunReplayer::open(&folder.join("recording.mcap")).unwrap();
    assert!(setup.is_operated);
    let other = OutputFolder::create(&place.path().join("replay")).unwrap();
    let recorder = RunRecorder::to_folder(&other).unwrap();
    let replay = run_on_body(&setup, &mut replayer, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(replay.robot.estimate(), run.robot.estimate());
    assert_eq!(replay.log.state, run.log.state);
    assert_eq!(replay.robot.hold(), Some(MotionHold::Paused));
}

#[test]
fn driving_by_hand_pauses_the_mission_and_a_replay_does_so_too() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let drive = OperatorCommand::Drive(Twist2::new(0.2, 0.1));
    let (run, operator) = run_with(&[go(1.0), drive], &folder);
    let view = operator.view().unwrap();
    assert_eq!(view.hold, Some(MotionHold::Paused));
    assert_eq!(view.mission.left.len(), 1, "the mission is kept");
    assert_eq!(view.twist, Twist2::ZERO, "silence and a missing camera stop the robot");
    let (mut replayer, setup) = RunReplayer::open(&folder.join("recording.mcap")).unwrap();
    let other = OutputFolder::create(&place.path().join("replay")).unwrap();
    let recorder = RunRecorder::to_folder(&other).unwrap();
    let replay = run_on_body(&setup, &mut replayer, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(replay.robot.hold(), Some(MotionHold::Paused));
    assert_eq!(replay.robot.estimate(), run.robot.estimate());
}

#[test]
fn a_second_front_end_shares_the_link() {
    let (_, link) = operator_link();
    let (first, second) = (link.operator(), link.operator());
    assert_eq!(first.send(go(1.0)).unwrap(), 1);
    assert_eq!(second.send(OperatorCommand::Pause).unwrap(), 2);
}

#[test]
fn zones_reach_the_robot_its_folder_and_a_replay() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let outline = vec![[1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [1.0, 1.0]];
    let stairs = Zone { id: 1, name: "stairs".to_owned(), kind: ZoneKind::NoGo, outline };
    let desk = NamedPlace { id: 2, name: "desk".to_owned(), pose: Pose2::new(-0.5, 0.0, 0.5) };
    let annotations = MapAnnotations { zones: vec![stairs], places: vec![desk] };
    let wrong = Zone { outline: vec![], ..annotations.zones[0].clone() };
    assert!(
        operator_link()
            .0
            .send(OperatorCommand::Annotate(MapAnnotations { zones: vec![wrong], places: vec![] }))
            .is_err()
    );
    let commands = [OperatorCommand::Annotate(annotations.clone()), go(1.5)];
    let (run, operator) = run_with(&commands, &folder);
    assert_eq!((&**run.robot.annotations(), &*operator.annotations()), (&annotations, &annotations));
    assert_eq!(operator.goal_of_place("desk").unwrap(), Pose2::new(-0.5, 0.0, 0.5));
    let (mut replayer, setup) = RunReplayer::open(&folder.join("recording.mcap")).unwrap();
    let other = OutputFolder::create(&place.path().join("replay")).unwrap();
    let recorder = RunRecorder::to_folder(&other).unwrap();
    let mut replay =
        run_on_body(&setup, &mut replayer, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(replay.log.state, run.log.state);
    let written = write_run(&setup, &mut replay, None, other).unwrap().folder;
    assert_eq!(read_annotations(&written.join(ZONES_FILE)).unwrap(), annotations);
    assert!(written.join("keepout_mask.yaml").exists() && !written.join("speed_mask.yaml").exists());
}

#[test]
fn a_loaded_map_reaches_the_robot_and_a_replay_and_drops_the_places_of_the_old_one() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let desk = NamedPlace { id: 2, name: "desk".to_owned(), pose: Pose2::new(-0.5, 0.0, 0.5) };
    let annotations = MapAnnotations { zones: vec![], places: vec![desk] };
    let wall = OccupancyGrid::from_ascii(0.05, &"#########\n#.......#\n".repeat(40)).unwrap();
    let commands =
        [OperatorCommand::Annotate(annotations), go(1.0), OperatorCommand::LoadMap(Box::new(wall))];
    let (run, operator) = run_with(&commands, &folder);
    assert!(operator.annotations().is_empty() && operator.goal_of_place("desk").is_err());
    let mission = &operator.view().unwrap().mission;
    assert_eq!((mission.id, mission.task), (3, None));
    assert_eq!(run.robot.grid().at(Vector2::new(0.02, 0.07)), Cell::Occupied);
    assert_eq!(run.robot.grid().at(Vector2::new(0.07, 0.02)), Cell::Free);
    let (mut replayer, setup) = RunReplayer::open(&folder.join("recording.mcap")).unwrap();
    let other = OutputFolder::create(&place.path().join("replay")).unwrap();
    let recorder = RunRecorder::to_folder(&other).unwrap();
    let replay = run_on_body(&setup, &mut replayer, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(replay.robot.grid(), run.robot.grid());
    assert_eq!(replay.robot.estimate(), run.robot.estimate());
}

#[test]
fn a_run_begins_with_the_zones_of_its_file() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("zones.geojson");
    let desk = NamedPlace { id: 2, name: "desk".to_owned(), pose: Pose2::new(-0.5, 0.0, 0.5) };
    let annotations = MapAnnotations { zones: vec![], places: vec![desk] };
    assert_eq!(operated().with_annotations_of(&file).unwrap().annotations, None, "no file yet");
    std::fs::write(&file, annotations_text(&annotations)).unwrap();
    let setup = operated().with_annotations_of(&file).unwrap();
    assert_eq!(**setup.start_robot().unwrap().annotations(), annotations);
    let recorded = serde_json::to_string(&setup).unwrap();
    assert!(recorded.contains("desk") && !recorded.contains("geojson"), "{recorded}");
    std::fs::write(&file, "{}").unwrap();
    assert!(operated().with_annotations_of(&file).is_err());
}
