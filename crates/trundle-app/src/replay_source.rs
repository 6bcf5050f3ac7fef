//! What is replayed: the recording of a run, or the sensors of a bag or a folder.

use crate::encoded_body::EncodedBody;
use crate::replayer::RunReplayer;
use crate::sequence::SequenceRequest;
use crate::sequence_input::{SequenceInput, SequenceOptions};
use crate::sequence_run::{SequenceBody, sequence_setup};
use crate::{AppError, FinishedRun, RunSetup};
use std::path::PathBuf;
use trundle_io::FileKind;
use trundle_runtime::RobotConfig;

/// What is replayed.
pub struct ReplaySource {
    path: PathBuf,
    setup: RunSetup,
    content: Content,
}

enum Content {
    /// A recording: the same run again.
    Recording(Box<RunReplayer>),
    /// Sensors with odometry of another program: the run of a robot without a mission.
    Sensors(Box<SequenceInput>),
}

impl ReplaySource {
    /// Opens a recording, a bag or a TUM folder. `robot` has the settings for a bag or a folder.
    ///
    /// # Errors
    /// When the input cannot be read or run, or an option has no effect on it.
    pub fn open(options: &SequenceOptions<'_>, robot: Option<RobotConfig>) -> Result<Self, AppError> {
        let path = options.path.to_owned();
        let kind = FileKind::of(&path)?;
        let open = if options.recover { RunReplayer::open_to_cut } else { RunReplayer::open };
        // Another program may have written a recording anew: its content tells, not the name of the program in its header.
        let is_foreign_bag = kind.is_bag() && !RunReplayer::is_run(&path);
        if is_foreign_bag || kind == FileKind::SequenceFolder {
            let input = SequenceRequest::of_options(&options.clone().for_robot(), robot).open()?;
            let setup = sequence_setup(&input);
            return Ok(Self { path, setup, content: Content::Sensors(Box::new(input)) });
        }
        refuse_idle(options, robot.is_some())?;
        let (replayer, setup) = open(&path)?;
        Ok(Self { path, setup, content: Content::Recording(Box::new(replayer)) })
    }

    /// The setup of the run.
    #[must_use]
    pub fn setup(&self) -> &RunSetup {
        &self.setup
    }

    /// Runs the robot on the input with `run`. Returns the finished run, and warnings about the end of a recording.
    ///
    /// # Errors
    /// Those of `run`, with the name of the input.
    pub fn run(
        self,
        run: impl FnOnce(&mut dyn EncodedBody) -> Result<FinishedRun, AppError>,
    ) -> Result<(FinishedRun, Vec<String>), AppError> {
        let name = self.path.display();
        match self.content {
            Content::Recording(mut body) => {
                let mut finished = run(&mut *body).map_err(|error| error.in_context(&name))?;
                let rest = body.read_to_end().err().map(|problem| problem.in_context(&name));
                let rest = rest.map(|problem| format!("the run was over before, but {problem}"));
                finished.cut = body.cut_report();
                let cut = finished.cut.as_ref().map(|report| format!("{name}: {report}"));
                Ok((finished, rest.into_iter().chain(cut).collect()))
            }
            Content::Sensors(input) => {
                let mut finished =
                    run(&mut SequenceBody::new(&input)?).map_err(|error| error.in_context(&name))?;
                finished.cut = input.cut_report().map(str::to_owned);
                Ok((finished, Vec::new()))
            }
        }
    }
}

/// Refuses the options of a bag for a recording.
fn refuse_idle(options: &SequenceOptions<'_>, has_robot: bool) -> Result<(), AppError> {
    let given = [
        ("--camera", options.camera.is_some()),
        ("--depth-scale", options.depth_scale.is_some()),
        ("--config", has_robot),
    ];
    let option = given.into_iter().find_map(|(option, is_given)| is_given.then_some(option));
    let Some(option) = option.or(options.first_topic().map(|(option, _)| option)) else { return Ok(()) };
    Err(AppError::Input(format!(
        "{option} has no effect on {}, expected a ROS 2 bag or a TUM RGB-D folder, or no {option}: a recording has its own robot",
        options.path.display()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_recording_that_another_program_wrote_anew_is_a_recording() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/golden/real_time.mcap");
        assert_eq!(FileKind::of(&file).unwrap(), FileKind::OtherMcap, "written by mcap-python");
        let source = ReplaySource::open(&SequenceOptions::new(&file), None).unwrap();
        assert!(matches!(source.content, Content::Recording(_)));
    }

    #[test]
    fn options_of_a_bag_are_refused_for_a_recording() {
        let refused = |options: &SequenceOptions<'_>, has_robot| {
            refuse_idle(options, has_robot).err().map(|error| error.to_string())
        };
        let plain = SequenceOptions::new(Path::new("run.mcap"));
        assert_eq!(refused(&plain, false), None);
        assert!(
            refused(&plain, true)
                .unwrap()
                .contains("--config has no effect on run.mcap, expected a ROS 2 bag")
        );
        let mut named = plain.clone();
        named.topics.odometry_topic = Some("/odom".to_owned());
        assert!(refused(&named, false).unwrap().contains("no --odom-topic"));
        assert!(
            refused(&SequenceOptions { camera: Some("freiburg1"), ..plain }, false)
                .unwrap()
                .contains("--camera")
        );
    }
}
