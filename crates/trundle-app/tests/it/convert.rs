//! Each form of a sequence converted into each other form, and run by a robot without a mission.

use crate::body::run_into;
use std::path::{Path, PathBuf};
use trundle_app::convert::{SequenceForm, convert_sequence};
use trundle_app::sequence::SequenceRequest;
use trundle_app::sequence_input::{SequenceInput, SequenceOptions};
use trundle_app::sequence_run::{SequenceBody, SequenceEvents, sequence_setup};
use trundle_app::{EncodedBody, FinishedRun, RunReplayer, RunSetup};
use trundle_core::{Cell, Pose2, RgbdImage, RobotBody, SensorEvent, Stamp, Twist2};
use trundle_io::OutputFolder;
use trundle_runtime::DriveState;
use trundle_sim::{Scene, SimConfig, Simulator};

/// Largest difference of a position or an angle after a conversion \[m, rad\]: decimals of a TUM folder, f32 of a grid. Source: ours.
const MAX_POSE_DIFFERENCE: f64 = 1e-5;

/// Largest difference of a depth after a conversion: a bit of an f32 \[m\]. Source: depth of a recording is in whole millimetres.
const MAX_DEPTH_DIFFERENCE_M: f32 = 1e-6;
/// Largest mean difference of colours by JPEG, of 255. Source: ours.
const MAX_JPEG_DIFFERENCE: f64 = 3.0;
/// Twist of the simulated base. Source: ours.
const TWIST: Twist2 = Twist2 { v: 0.2, omega: 0.1 };

/// A simulated base that something else drives.
struct DrivenBody(Simulator);

impl RobotBody for DrivenBody {
    type Error = <Simulator as RobotBody>::Error;

    fn next_event(&mut self) -> Result<Option<SensorEvent>, Self::Error> {
        self.0.next_event()
    }

    fn command(&mut self, _twist: Twist2) -> Result<(), Self::Error> {
        self.0.command(TWIST)
    }
}

/// A recording of the driven base over `seconds`.
fn recording(scratch: &Path, seconds: f64) -> PathBuf {
    let simulator = Simulator::new(Scene::by_name("demo", 1).unwrap(), SimConfig::default(), 1).unwrap();
    let mut body = DrivenBody(simulator);
    let folder = OutputFolder::create(&scratch.join("live")).unwrap();
    run_into(&crate::body::setup().with_time_limit(seconds), &mut body, &folder).unwrap();
    folder.commit().unwrap().join("recording.mcap")
}

fn open(path: &Path) -> SequenceInput {
    SequenceInput::open(&SequenceOptions::new(path)).unwrap()
}

/// The input in another form, in a folder of its own; the path to open it.
fn converted(input: &SequenceInput, form: SequenceForm, folder: &Path) -> PathBuf {
    let out = OutputFolder::create(folder).unwrap();
    let count = convert_sequence(input, form, &out, &()).unwrap();
    assert_eq!((count.images, count.skipped), (input.len(), 0), "{form:?}");
    let folder = out.commit().unwrap();
    match form {
        SequenceForm::TumFolder => folder,
        SequenceForm::RosBag => folder.join("bag.mcap"),
        SequenceForm::Recording => folder.join("recording.mcap"),
    }
}

fn images(input: &SequenceInput) -> Vec<RgbdImage> {
    input.frames().unwrap().map(|frame| frame.unwrap().decode().unwrap()).collect()
}

fn odometry(input: &SequenceInput) -> Vec<(Stamp, [f64; 3])> {
    let numbers = |pose: Pose2| [pose.x, pose.y, pose.theta];
    input.odometry().unwrap().iter().map(|(stamp, pose)| (*stamp, numbers(*pose))).collect()
}

fn truth(input: &SequenceInput) -> Vec<(Stamp, [f64; 3])> {
    let numbers = |(stamp, pose): &(Stamp, trundle_core::Pose3)| {
        let at = pose.translation;
        (*stamp, [at.x, at.y, at.z])
    };
    input.ground_truth().unwrap().iter().map(numbers).collect()
}

fn assert_near(found: &[(Stamp, [f64; 3])], expected: &[(Stamp, [f64; 3])], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for ((stamp, numbers), (at, wanted)) in found.iter().zip(expected) {
        assert_eq!(stamp, at, "{what}");
        let is_near = numbers.iter().zip(wanted).all(|(a, b)| (a - b).abs() < MAX_POSE_DIFFERENCE);
        assert!(is_near, "{what} at {at} s: {numbers:?}, expected {wanted:?}");
    }
}

/// Mean difference of the colours, of 255.
fn color_difference(image: &RgbdImage, other: &RgbdImage) -> f64 {
    let channels = |image: &RgbdImage| image.color().data().iter().flatten().map(|v| f64::from(*v)).collect();
    let (ours, theirs): (Vec<f64>, Vec<f64>) = (channels(image), channels(other));
    assert_eq!(ours.len(), theirs.len());
    ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).sum::<f64>() / ours.len() as f64
}

/// The content of `found` is that of `expected`: images, stamps, camera, odometry, ground truth.
fn assert_same(found: &SequenceInput, expected: &SequenceInput, max_color_difference: f64, what: &str) {
    let (ours, theirs) = (images(found), images(expected));
    assert_eq!(ours.len(), theirs.len(), "{what}");
    for (image, other) in ours.iter().zip(&theirs) {
        assert_eq!(image.stamp(), other.stamp(), "{what}");
        let (depth, wanted) = (image.depth().data(), other.depth().data());
        let apart = depth.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(
            depth.len() == wanted.len() && apart < MAX_DEPTH_DIFFERENCE_M,
            "{what}: depth is {apart} m off"
        );
        let apart = color_difference(image, other);
        assert!(apart <= max_color_difference, "{what}: colour is {apart} of 255 off");
    }
    let camera = |input: &SequenceInput| {
        let camera = input.camera.model.camera;
        ([camera.fx(), camera.fy(), camera.cx(), camera.cy()], camera.width(), camera.height())
    };
    assert_eq!(camera(found), camera(expected), "{what}");
    assert_near(&odometry(found), &odometry(expected), what);
    assert_near(&truth(found), &truth(expected), what);
}

#[test]
fn each_form_converts_into_each_other_form_without_a_loss() {
    use SequenceForm::{Recording, RosBag, TumFolder};
    let scratch = tempfile::tempdir().unwrap();
    let place = |name: &str| scratch.path().join(name);
    let original = open(&recording(scratch.path(), 0.5));
    assert!(original.len() > 5 && odometry(&original).len() > 20);
    let folder = open(&converted(&original, TumFolder, &place("folder")));
    let bag = open(&converted(&original, RosBag, &place("bag")));
    let recording = open(&converted(&bag, Recording, &place("recording")));
    for (from, input) in [("folder", &folder), ("bag", &bag), ("recording", &recording)] {
        assert_same(input, &original, 0.0, from);
        for form in [TumFolder, RosBag, Recording] {
            if input.is_recording() && form == Recording {
                continue;
            }
            let what = format!("{from} to {form:?}");
            let back = open(&converted(input, form, &place(&what.replace(' ', "_"))));
            // The PNG images of a folder become JPEG images.
            let is_compressed = from == "folder" && form != TumFolder;
            assert_same(&back, &original, if is_compressed { MAX_JPEG_DIFFERENCE } else { 0.0 }, &what);
            let has_mount = from != "folder" && form != TumFolder;
            let (mount, known) = (back.level_from_first_camera(), original.level_from_first_camera());
            if let Some(known) = known.filter(|_| has_mount) {
                let apart = mount.unwrap().inverse() * known;
                let is_same =
                    apart.translation.norm() < MAX_POSE_DIFFERENCE && apart.angle() < MAX_POSE_DIFFERENCE;
                assert!(is_same, "{what}: {mount:?}, expected {known:?}");
            }
        }
    }
}

#[test]
fn a_recording_is_not_converted_into_a_recording() {
    let scratch = tempfile::tempdir().unwrap();
    let input = open(&recording(scratch.path(), 0.2));
    let out = OutputFolder::create(&scratch.path().join("again")).unwrap();
    let refused = convert_sequence(&input, SequenceForm::Recording, &out, &()).unwrap_err().to_string();
    assert!(refused.contains("a recording of trundle already, expected a ROS 2 bag"), "{refused}");
}

#[test]
fn a_sequence_without_odometry_is_refused_with_what_takes_it() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = converted(
        &open(&recording(scratch.path(), 0.2)),
        SequenceForm::TumFolder,
        &scratch.path().join("tum"),
    );
    std::fs::remove_file(folder.join("odometry.txt")).unwrap();
    let refused = SequenceEvents::of(&open(&folder)).err().unwrap().to_string();
    assert!(
        refused.contains("no odometry") && refused.contains("`trundle slam` and `trundle map`"),
        "{refused}"
    );
}

fn run_of(setup: &RunSetup, body: &mut dyn EncodedBody, folder: &Path) -> FinishedRun {
    run_into(setup, body, &OutputFolder::create(folder).unwrap()).unwrap()
}

#[test]
fn a_bag_and_the_recording_made_of_it_are_run_alike_and_near_the_truth() {
    let scratch = tempfile::tempdir().unwrap();
    let place = |name: &str| scratch.path().join(name);
    let original = open(&recording(scratch.path(), 6.0));
    let bag = converted(&original, SequenceForm::RosBag, &place("bag"));
    let input = SequenceRequest::of_options(&SequenceOptions::new(&bag), None).open().unwrap();
    let file = converted(&input, SequenceForm::Recording, &place("recording"));
    let of_bag = run_of(&sequence_setup(&input), &mut SequenceBody::new(&input).unwrap(), &place("one"));
    let (mut body, setup) = RunReplayer::open(&file).unwrap();
    let of_recording = run_of(&setup, &mut body, &place("two"));
    let (pose, other) = (of_bag.robot.estimate().pose, of_recording.robot.estimate().pose);
    assert_eq!((pose.x, pose.y, pose.theta), (other.x, other.y, other.theta));
    assert_eq!(of_bag.robot.grid().cells(), of_recording.robot.grid().cells());
    assert!(of_bag.log.state == DriveState::Idle && of_bag.log.tracked.ok > 60, "{:?}", of_bag.log.tracked);
    let rmse = of_bag.log.estimate_rmse().unwrap();
    println!("estimate against truth {rmse:.4} m, ended at {pose:?}");
    assert!(rmse < 0.03 && pose.x > 0.6, "{rmse} m, {pose:?}");
    let free = of_bag.robot.grid().cells().iter().filter(|cell| **cell == Cell::Free).count();
    assert!(free > 2000, "{free} free cells");
    let numbers = trundle_app::report::RunNumbers::of(&setup, &of_recording);
    assert!(numbers.is_success() && numbers.verdict().contains("no mission"), "{}", numbers.verdict());
}
