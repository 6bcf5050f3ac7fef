//! Jobs of the robot: given out, run anywhere, and their results applied between two events.

use super::{Robot, background::Felt, event_log::DroppedImage};
use crate::{
    lazy_image::LazyImage,
    report::StepReport,
    stage::Stage,
    workers::decision_worker::DecisionWorker,
    workers::job::{Answer, Job, Outcome, Work},
};
use trundle_core::{Stamp, Twist2};

impl Robot {
    /// The robot with its long work as jobs: fetch each with [`Robot::next_job`], run it anywhere, give the result to
    /// [`Robot::apply_answer`].
    #[must_use]
    pub fn with_background_jobs(mut self) -> Self {
        self.background.is_used = true;
        self
    }

    /// Queues an image for a perception job. Of those that arrive while a job runs only the newest is kept; the others are dropped, see
    /// [`Robot::dropped_images`]. A robot without background jobs processes the image at once.
    pub fn queue_image(&mut self, image: LazyImage) -> StepReport {
        let mut report = StepReport::default();
        if self.background.is_used() {
            self.background.queue_image(image);
        } else {
            match self.times.measure(Stage::Decoding, || image.load()) {
                Ok(image) => self.on_image(&image, &mut report),
                Err(problem) => report.broken_image = Some(problem),
            }
        }
        self.complete(&mut report);
        report
    }

    /// The next work that shall be done in the background, after every event and every answer; none where there is none, or
    /// the robot does not defer.
    pub fn next_job(&mut self) -> Option<Job> {
        if let Some(job) = self.background.decision.take() {
            return Some(job);
        }
        self.perception.as_ref()?;
        let image = self.background.waiting.take()?;
        let Some(odometer) = self.odometry_at(image.stamp()) else {
            self.background.drop_image(image.stamp(), DroppedImage::NoOdometry);
            return None;
        };
        let perception = self.perception.take()?;
        let odometer = Box::new(odometer);
        Some(Job(Work::Perceive { perception, image, odometer }))
    }

    /// Applies the result of a job, between two events.
    ///
    /// The report has a twist where the decision is for the newest reading of the wheels, and neither bumper, cliff sensors nor a
    /// mission came after it. Any other decision has been overtaken, and the next control step acts by it.
    pub fn apply_answer(&mut self, answer: Answer) -> StepReport {
        let mut report = StepReport::default();
        self.times.add(&answer.times);
        match answer.result {
            Outcome::Perceived { perception, stamp, perceived } => {
                self.perception = Some(perception);
                report.image = Some(stamp);
                match perceived {
                    Ok(Some(result)) => self.apply_perception(*result, &mut report),
                    Ok(None) => self.drop_frozen(stamp),
                    Err(problem) => report.broken_image = Some(problem),
                }
            }
            Outcome::Decided { decision_worker, decision, asked } => {
                let is_newest = self.latest.odometry.is_some_and(|odometry| odometry.stamp == asked);
                let is_held = self.latest.body.hold(self.range_source).is_some();
                let is_current = is_newest && !is_held && !self.background.knows_more();
                report.twist = is_current.then_some(decision.twist);
                report.twist.into_iter().for_each(|twist| self.odometry.set_command(twist));
                self.return_decision_worker(decision_worker, report.twist);
                report.replanned = decision.replanned;
            }
        }
        self.complete(&mut report);
        report
    }

    /// Stamps of the images that a newer one replaced before they were processed.
    pub fn dropped_images(&self) -> &[Stamp] {
        &self.background.dropped
    }

    /// Drops the queued image, if there is one: the run is over.
    pub fn drop_queued_image(&mut self) {
        if let Some(image) = self.background.waiting.take() {
            self.background.drop_image(image.stamp(), DroppedImage::RunOver);
        }
    }

    /// The decision worker is back: it receives the readings and the mission that came meanwhile, and the last command.
    fn return_decision_worker(&mut self, mut decision_worker: Box<DecisionWorker>, sent: Option<Twist2>) {
        let fallback = self.background.fallback.take();
        if let Some(sent) = sent.or(fallback.map(|fallback| fallback.sent)) {
            decision_worker.navigator.sent(sent);
        }
        for felt in self.background.felt.drain(..) {
            match felt {
                Felt::Touched(pressed) => decision_worker.navigator.touch(pressed),
                Felt::OverEdge(over_edge) => decision_worker.navigator.cliff(over_edge),
            }
        }
        let navigator = &mut decision_worker.navigator;
        self.background.changes.drain(..).for_each(|setting| navigator.change(setting));
        if let Some(mission) = self.background.orders.take() {
            decision_worker.begin(&mission);
        }
        self.latest.mission = decision_worker.executor.mission();
        self.decision_worker = Some(decision_worker);
    }

    /// A reading of the bumper.
    pub(super) fn forward_touch(&mut self, pressed: bool) {
        self.teleop.touched = pressed;
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.touch(pressed),
            None => self.background.felt.push(Felt::Touched(pressed)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.touched = pressed;
        }
    }

    /// A reading of the cliff sensors.
    pub(super) fn on_cliff(&mut self, over_edge: bool) {
        self.teleop.over_edge = over_edge;
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.cliff(over_edge),
            None => self.background.felt.push(Felt::OverEdge(over_edge)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.over_edge = over_edge;
        }
    }
}
