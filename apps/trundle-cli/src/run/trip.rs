use super::{Run, RunSetup, TapeCost};
use crate::body::{Input, Mark, MarkMessage, WiredBody};
use crate::{console, failure::Failure, logbook::Logbook, tape::Tape, view::BestView};
use indicatif::ProgressBar;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle::core::{FrameId, Pose2, Stamp, Twist2};
use trundle::io::{EncodedEvent, PoseInFrame, PosesInFrame};
use trundle::runtime::{Answer, DriveState, Helper, LazyImage, Robot, Stage, StepReport};

/// A run under way: the robot is fed, and all that goes in and comes out is written down.
pub(super) struct Trip<'s> {
    setup: &'s RunSetup,
    robot: Robot,
    tape: Tape,
    pub(super) log: Logbook,
    view: BestView,
    line: ProgressBar,
    start: Instant,
    pub(super) is_interrupted: bool,
}

impl<'s> Trip<'s> {
    pub(super) fn begin(
        setup: &'s RunSetup,
        mut tape: Tape,
        log: Logbook,
        quiet: bool,
    ) -> Result<Self, Failure> {
        let mut robot = setup.robot_at_work()?;
        if setup.real_time {
            robot = robot.deferring();
        }
        if tape.keeps() {
            robot = robot.remembering();
        }
        let config = setup.clone();
        tape.put(move |tape| tape.record_json("/config", "trundle.Config", Stamp::default(), &config))?;
        let view = BestView::default();
        let (line, start) = (console::live_line(quiet), Instant::now());
        Ok(Self { setup, robot, tape, log, view, line, start, is_interrupted: false })
    }

    /// Feeds the robot once; whether its mission is over.
    pub(super) fn step(&mut self, input: Input, body: &mut dyn WiredBody) -> Result<bool, Failure> {
        self.judge(body)?;
        let (stamp, report) = match input {
            Input::Event(event) => (event.stamp(), self.feel(event)?),
            Input::Answer(answer) => (self.log.now, self.take_up(answer)?),
            Input::Interrupted => return self.interrupt(body),
        };
        if let Some(twist) = report.twist {
            body.command(twist)?;
        }
        if let Some(problem) = &report.broken_image {
            let at = stamp.as_secs();
            return Err(Failure::Input(format!("the image that came at {at:.3} s is broken: {problem}")));
        }
        self.record(stamp, &report)?;
        self.log.note(stamp, &report);
        if let Some(memory) = &report.memory {
            self.tape.keep(Arc::clone(memory));
        }
        if let Some(image) = report.image {
            self.show()?;
            self.view.looked_at(image, &self.robot, &report);
        }
        while let Some(job) = self.robot.next_job() {
            body.give(job);
        }
        Ok(report.finished)
    }

    /// Takes down what the body has touched, where it knows.
    fn judge(&mut self, body: &dyn WiredBody) -> Result<(), Failure> {
        match body.contacts() {
            contacts @ Some(count) if contacts != self.log.true_contacts => {
                self.log.true_contacts = contacts;
                self.mark(Mark::Contacts(count))
            }
            _ => Ok(()),
        }
    }

    /// The user has seen enough: the robot stops here.
    fn interrupt(&mut self, body: &mut dyn WiredBody) -> Result<bool, Failure> {
        body.command(Twist2::ZERO)?;
        self.mark(Mark::Interrupted)?;
        self.is_interrupted = true;
        Ok(true)
    }

    /// Takes up what is still under way, in a fixed order, and closes the recording.
    pub(super) fn end(mut self, body: &mut dyn WiredBody) -> Result<Run, Failure> {
        if self.setup.real_time {
            self.mark(Mark::End)?;
            self.robot.drop_waiting_image();
            for helper in Helper::ALL {
                if let Some(answer) = body.last_answer(helper) {
                    let report = self.take_up(answer)?;
                    let stamp = self.log.now;
                    self.record(stamp, &report)?;
                    self.log.note(stamp, &report);
                }
            }
        }
        if self.is_interrupted {
            self.log.state = DriveState::Stopped { reason: "the user ended the run".to_owned() };
        }
        self.line.finish_and_clear();
        let (waiting, lost) = (self.tape.lengths.clone(), self.tape.lost);
        let last = if self.tape.keeps() { self.robot.memory() } else { None };
        let (spent, failure) = match self.tape.finish(last) {
            Ok(spent) => (spent, None),
            Err(failure) => (Duration::ZERO, Some(failure)),
        };
        let tape = TapeCost { waiting, lost, spent, failure };
        let seconds = self.start.elapsed().as_secs_f64();
        Ok(Run { robot: self.robot, log: self.log, view: self.view, seconds, tape })
    }

    fn feel(&mut self, event: EncodedEvent) -> Result<StepReport, Failure> {
        let recorded = event.clone();
        self.tape.put(move |tape| tape.record_event(&recorded))?;
        if let EncodedEvent::Rgbd(image) = event {
            self.view.arrived(&image);
            let stamp = image.stamp;
            let load = move || image.decode().map_err(|error| error.to_string());
            return Ok(self.robot.leave_image(LazyImage::new(stamp, load)));
        }
        let event = event.decode().map_err(|error| Failure::Input(error.to_string()))?;
        self.log.judge(&event, self.setup.map_from_world);
        Ok(self.robot.step(&event))
    }

    fn take_up(&mut self, answer: Answer) -> Result<StepReport, Failure> {
        self.mark(Mark::TakenUp(answer.helper()))?;
        Ok(self.robot.take_up(answer))
    }

    fn mark(&mut self, mark: Mark) -> Result<(), Failure> {
        let (stamp, message) = (self.log.now, MarkMessage { mark });
        self.tape.put(move |tape| tape.record_json(Mark::TOPIC, Mark::SCHEMA, stamp, &message))
    }

    fn record(&mut self, stamp: Stamp, report: &StepReport) -> Result<(), Failure> {
        if let Some(twist) = report.twist {
            self.tape.put(move |tape| tape.record_json("/twist", "trundle.Twist", stamp, &twist))?;
        }
        let frame = || FrameId::Map.to_string();
        if let (Some(estimate), Some(_)) = (report.estimate, &report.track) {
            self.tape.put(move |tape| {
                let pose = PoseInFrame::planar(stamp, &frame(), estimate.pose);
                tape.record_json("/pose", PoseInFrame::SCHEMA, stamp, &pose)
            })?;
        }
        if let (true, Some(plan)) = (report.replanned, self.robot.plan()) {
            let poses: Vec<Pose2> = plan.trajectory.points().iter().map(|point| point.pose).collect();
            self.tape.put(move |tape| {
                let poses = PosesInFrame::planar(stamp, &frame(), poses);
                tape.record_json("/trajectory", PosesInFrame::SCHEMA, stamp, &poses)
            })?;
        }
        Ok(())
    }

    fn show(&mut self) -> Result<(), Failure> {
        if self.line.is_hidden() {
            return Ok(());
        }
        let message = self.told();
        let line = self.line.clone();
        // A terminal that is slow holds up whoever writes the recording, not control.
        self.tape.put(move |_| {
            line.set_message(message);
            line.tick();
            Ok(())
        })
    }

    fn told(&self) -> String {
        let (log, robot) = (&self.log, &self.robot);
        let pose = robot.estimate().pose;
        let wall = self.start.elapsed().as_secs_f64();
        let rate = |stage: Stage| robot.times().runs(stage) as f64 / log.elapsed().max(0.1);
        format!(
            "{:5.1} s ({:.1}x)  pose {:6.2} {:6.2} m {:6.1} deg  {:<10}  slam {:4.1} Hz  map {:3.1} Hz  control {:4.1} Hz",
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
