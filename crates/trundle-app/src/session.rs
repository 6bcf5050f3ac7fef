//! A run in progress: feeds the robot and records each input and output.

use crate::encoded_body::{EncodedBody, RunInput};
use crate::operator::{FrontEnd, OperatorLink, OperatorRequest};
use crate::overload_watch::OverloadWatch;
use crate::run_mark::{RunMark, RunMarkMessage};
use crate::run_messages::RunMessages;
use crate::setup::mission_text;
use crate::{
    AppError, BestView, DisplayedState, FinishedRun, Progress, RecordingContent, RecordingCost, RunLog,
    RunRecorder, RunSetup,
};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{Stamp, Twist2};
use trundle_io::EncodedEvent;
use trundle_runtime::{
    Answer, DriveState, LazyImage, Reason, Robot, Stage, StepReport, TaskEnd, TaskRecord, Worker,
};

/// A run in progress: feeds the robot and records each input and output.
pub struct RunSession<'s> {
    setup: &'s RunSetup,
    robot: Robot,
    recorder: RunRecorder,
    log: RunLog,
    messages: RunMessages,
    view: BestView,
    overload: OverloadWatch,
    progress: Progress,
    operator: Option<OperatorLink>,
    /// Tasks of missions that the operator replaced.
    earlier_tasks: Vec<TaskRecord>,
    /// Tasks of the present mission that are done, as last known.
    tasks_done: usize,
    start: Instant,
    is_interrupted: bool,
    /// Content of the present recording.
    recorded: RecordingContent,
    /// Time of the last report of the free space.
    space_reported: Option<Stamp>,
}

/// Period of reports of the free space \[s\]. Source: ours.
const SPACE_PERIOD_S: f64 = 5.0;

impl<'s> RunSession<'s> {
    /// Starts the robot of `setup` and records the setup.
    ///
    /// # Errors
    /// When the robot or the checkpoint is invalid.
    pub fn new(
        setup: &'s RunSetup,
        mut recorder: RunRecorder,
        log: RunLog,
        front_end: FrontEnd,
    ) -> Result<Self, AppError> {
        let mut robot = setup.start_robot()?;
        if setup.real_time {
            robot = robot.with_background_jobs();
        }
        if recorder.writes_checkpoints() {
            robot = robot.with_checkpoints();
        }
        record_setup(&mut recorder, Stamp::default(), setup.clone());
        tracing::info!("run in '{}', seed {}: {}", setup.scene, setup.seed, mission_text(&setup.mission));
        let (view, overload) = (BestView::default(), OverloadWatch::default());
        let start = Instant::now();
        let messages = RunMessages::default();
        let FrontEnd { progress, mut operator } = front_end;
        if let Some(link) = &mut operator {
            link.note_camera(&setup.robot.camera);
            link.begin_annotations(robot.annotations(), setup.annotations_file.as_deref());
            link.show_recording(recorder.switch().clone());
        }
        Ok(Self {
            setup,
            robot,
            recorder,
            log,
            messages,
            view,
            overload,
            progress,
            operator,
            earlier_tasks: Vec::new(),
            tasks_done: 0,
            start,
            is_interrupted: false,
            recorded: setup.recording,
            space_reported: None,
        })
    }

    /// The log so far.
    #[must_use]
    pub fn log(&self) -> &RunLog {
        &self.log
    }

    /// Whether the user ended the run.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        self.is_interrupted
    }

    /// The operator's next request, if one waits.
    pub(crate) fn next_request(&self) -> Option<OperatorRequest> {
        self.operator.as_ref()?.next_request()
    }

    /// Feeds one input to the robot; returns whether the mission is over.
    ///
    /// # Errors
    /// When an event cannot be decoded or the body refuses the command.
    pub fn step(&mut self, input: RunInput, body: &mut dyn EncodedBody) -> Result<bool, AppError> {
        self.follow_switch();
        self.record_contacts(body);
        let (stamp, report) = match input {
            RunInput::Event(event) => (event.stamp(), self.on_event(event)?),
            RunInput::Answer(answer) => (self.log.now, self.apply_answer(answer)),
            RunInput::Operator(request) => (self.log.now, self.execute(request)?),
            RunInput::Interrupted => return self.interrupt(body),
        };
        if let Some(twist) = report.twist {
            body.send_command(twist)?;
        }
        if let Some(problem) = &report.broken_image {
            let at = stamp.as_secs();
            return Err(AppError::Input(format!("the image that came at {at:.3} s is broken: {problem}")));
        }
        self.record(stamp, &report);
        self.log.on_report(stamp, &report);
        self.show_state(&report.state, report.finished, body);
        if let Some(link) = &mut self.operator {
            link.publish(stamp, &self.robot, &report);
        }
        if let Some(checkpoint) = &report.checkpoint {
            self.recorder.write_checkpoint(Arc::clone(checkpoint));
        }
        if let Some(image) = report.image {
            self.show_status(body.fraction_read());
            self.view.on_tracked(image, &self.robot, &report);
        }
        while let Some(job) = self.robot.next_job() {
            body.start_job(job);
        }
        Ok(report.finished)
    }

    /// Follows the switch of the recording. A further file contains no images only if the recording was started without images.
    fn follow_switch(&mut self) {
        match self.recorder.switch().take_request() {
            Some(true) => self.begin_part(),
            Some(false) => self.recorder.end(),
            None => {}
        }
        let now = self.log.now;
        let is_due = self.space_reported.is_none_or(|last| now - last >= SPACE_PERIOD_S);
        if is_due && self.operator.as_ref().is_some_and(OperatorLink::is_watched) {
            self.space_reported = Some(now);
            self.recorder.report_space();
        }
    }

    fn begin_part(&mut self) {
        if self.recorded == RecordingContent::None {
            self.recorded = RecordingContent::All;
        }
        let (now, recording) = (self.log.now, self.recorded);
        let setup = RunSetup { recording, recorded_from_s: Some(self.log.elapsed()), ..self.setup.clone() };
        self.recorder.begin_part();
        record_setup(&mut self.recorder, now, setup);
        // Everything is new to this file: mount, map, goal and state.
        self.messages = RunMessages::default();
    }

    /// Shows the state of the run on the body.
    fn show_state(&mut self, state: &DriveState, is_finished: bool, body: &mut dyn EncodedBody) {
        // The records are not at hand while a decision job runs.
        if let Some(mission) = self.robot.mission_progress() {
            self.tasks_done = mission.ended.iter().filter(|record| record.end == TaskEnd::Done).count();
        }
        let (is_held, tasks_done) = (self.robot.hold().is_some(), self.tasks_done);
        body.show_state(&DisplayedState { state, is_finished, is_held, tasks_done });
    }

    /// Records the body's contacts, if it counts them.
    fn record_contacts(&mut self, body: &dyn EncodedBody) {
        if let contacts @ Some(count) = body.true_contacts()
            && contacts != self.log.true_contacts
        {
            self.log.true_contacts = contacts;
            self.record_mark(RunMark::Contacts(count));
        }
    }

    /// The user ends the run: the robot stops.
    fn interrupt(&mut self, body: &mut dyn EncodedBody) -> Result<bool, AppError> {
        body.send_command(Twist2::ZERO)?;
        self.show_state(&DriveState::Stopped { reason: Reason::Interrupted }, true, body);
        self.record_mark(RunMark::Interrupted);
        self.is_interrupted = true;
        Ok(true)
    }

    /// Applies the results of running jobs in a fixed order, and closes the recording.
    ///
    /// # Errors
    /// None at present; a body that fails at the end may be reported here.
    pub fn finish(mut self, body: &mut dyn EncodedBody) -> Result<FinishedRun, AppError> {
        if self.setup.real_time {
            self.record_mark(RunMark::End);
            self.robot.drop_queued_image();
            for worker in Worker::ALL {
                if let Some(answer) = body.finish_job(worker) {
                    let report = self.apply_answer(answer);
                    let stamp = self.log.now;
                    self.record(stamp, &report);
                    self.log.on_report(stamp, &report);
                    report.checkpoint.into_iter().for_each(|last| self.recorder.write_checkpoint(last));
                }
            }
        }
        if self.is_interrupted {
            self.log.state = DriveState::Stopped { reason: Reason::Interrupted };
        }
        tracing::info!("run over after {:.1} s: {}", self.log.elapsed(), self.log.state);
        let (queue_lengths, lines_lost) = (self.recorder.queue_lengths.clone(), self.recorder.lines_lost);
        let last = if self.recorder.writes_checkpoints() { self.robot.checkpoint() } else { None };
        let checkpoint_error = self.recorder.finish_checkpoints(last).err();
        let switch = self.recorder.switch().clone();
        let (cpu_time, error) = match self.recorder.finish() {
            Ok(spent) => (spent, None),
            Err(error) => (Duration::ZERO, Some(error)),
        };
        let failed_files = switch.state().failed_files;
        let recording =
            RecordingCost { queue_lengths, lines_lost, cpu_time, error, failed_files, checkpoint_error };
        let seconds = self.start.elapsed().as_secs_f64();
        let Self { robot, log, view, earlier_tasks, .. } = self;
        Ok(FinishedRun { robot, log, earlier_tasks, view, seconds, recording, cut: None })
    }

    fn on_event(&mut self, event: EncodedEvent) -> Result<StepReport, AppError> {
        let is_recorded = self.recorded.is_all() || !matches!(event, EncodedEvent::Rgbd(_));
        if is_recorded {
            let recorded = event.clone();
            self.recorder.write(move |file| file.record_event(&recorded));
        }
        if let EncodedEvent::Rgbd(mut image) = event {
            // The recording contains the driver's stamp: a replay applies the same correction once.
            image.stamp = image.stamp.after(-self.setup.robot.image_delay);
            self.view.on_image(&image);
            if let Some(link) = &mut self.operator {
                link.note_image(&image);
            }
            let stamp = image.stamp;
            if let Some(sentence) = self.overload.on_image(stamp, self.robot.dropped_images().len()) {
                tracing::warn!("{:.3} s: {sentence}", stamp.as_secs());
            }
            let load = move || image.decode().map_err(|error| error.to_string());
            return Ok(self.robot.queue_image(LazyImage::new(stamp, load)));
        }
        let event = event.decode().map_err(|error| AppError::Input(error.to_string()))?;
        self.log.on_event(&event, self.setup.map_from_world);
        Ok(self.robot.step(&event))
    }

    fn apply_answer(&mut self, answer: Answer) -> StepReport {
        self.record_mark(RunMark::Applied(answer.worker()));
        self.robot.apply_answer(answer)
    }

    /// The robot follows an operator from here on.
    fn execute(&mut self, request: OperatorRequest) -> Result<StepReport, AppError> {
        self.record_mark(RunMark::Operator(request.clone()));
        if let Some(link) = &mut self.operator {
            link.note_request(&request);
        }
        let ended = self.robot.tasks_ended().to_vec();
        let report = self.robot.execute(request.command)?;
        if report.mission_replaced {
            self.earlier_tasks.extend(ended);
        }
        if let Some(link) = &mut self.operator {
            link.note_executed(request.id, &report);
        }
        Ok(report)
    }

    fn record_mark(&mut self, mark: RunMark) {
        let (stamp, message) = (self.log.now, RunMarkMessage { mark });
        self.recorder.write(move |file| file.record_json(RunMark::TOPIC, RunMark::SCHEMA, stamp, &message));
    }

    fn record(&mut self, stamp: Stamp, report: &StepReport) {
        self.messages.record(stamp, report, &self.robot, self.setup, &mut self.recorder);
    }

    fn show_status(&mut self, fraction_read: Option<f64>) {
        if self.progress.is_hidden() {
            return;
        }
        let (line, progress) = (self.status_line(fraction_read), self.progress.clone());
        // A slow terminal delays the recorder, not control.
        self.recorder.beside(move || progress.show(&line));
    }

    fn status_line(&self, fraction_read: Option<f64>) -> String {
        let (log, robot) = (&self.log, &self.robot);
        let pose = robot.estimate().pose;
        let wall = self.start.elapsed().as_secs_f64();
        let rate = |stage: Stage| robot.times().runs(stage) as f64 / log.elapsed().max(0.1);
        format!(
            "{}{:5.1} s ({:.1}x)  pose {:6.2} {:6.2} m {:6.1} deg  {:<10}  slam {:4.1} Hz  map {:3.1} Hz  control {:4.1} Hz",
            fraction_read.map_or(String::new(), |fraction| format!("{:3.0} %  ", fraction * 100.0)),
            log.elapsed(),
            log.elapsed() / wall.max(1e-3),
            pose.x,
            pose.y,
            pose.theta.to_degrees(),
            log.state.to_string(),
            rate(Stage::Slam),
            rate(Stage::Mapping),
            rate(Stage::Control),
        )
    }
}

/// Records the setup, which a recording begins with.
fn record_setup(recorder: &mut RunRecorder, stamp: Stamp, setup: RunSetup) {
    let camera = setup.robot.camera;
    recorder.write(move |file| {
        file.set_camera(camera);
        Ok(())
    });
    recorder.write(move |file| file.record_json("/config", "trundle.Config", stamp, &setup));
}
