//! Long work given out, and its answers taken up.

use super::Robot;
use crate::world_state::{OwnedWorldState, WorldState};
use crate::{
    lazy_image::LazyImage,
    mission::MissionState,
    report::StepReport,
    stage::Stage,
    workers::decision_worker::DecisionWorker,
    workers::fallback_controller::FallbackController,
    workers::job::{Answer, Job, Outcome, Work},
};
use trundle_core::{Stamp, Twist2};

/// What is under way beside the control loop.
#[derive(Debug, Default)]
pub(super) struct Background {
    is_used: bool,
    /// The captain's job, not yet fetched.
    decision: Option<Job>,
    /// While the captain thinks.
    fallback: Option<FallbackController>,
    /// A mission given meanwhile.
    orders: Option<MissionState>,
    /// What bumper and cliff sensors said meanwhile.
    felt: Vec<Felt>,
    /// The newest image that nobody has looked at yet.
    waiting: Option<LazyImage>,
    dropped: Vec<Stamp>,
}

#[derive(Debug, Clone, Copy)]
enum Felt {
    Touched(bool),
    OverEdge(bool),
}

impl Background {
    /// Whether long work is given out.
    pub(super) fn is_used(&self) -> bool {
        self.is_used
    }

    /// Whether the next decision is to be made here.
    pub(super) fn is_for(&self, decision_worker: &DecisionWorker, s: &WorldState<'_>) -> bool {
        self.is_used && decision_worker.may_take_long(s)
    }

    /// A control step while the captain thinks, which is from now on where one is given.
    pub(super) fn steer(
        &mut self,
        decision_worker: Option<Box<DecisionWorker>>,
        s: &WorldState<'_>,
    ) -> Option<Twist2> {
        if let Some(decision_worker) = decision_worker {
            self.fallback = Some(decision_worker.fallback());
            self.decision =
                Some(Job(Work::Decide { decision_worker, around: Box::new(OwnedWorldState::from(s)) }));
        }
        self.fallback.as_mut().map(|fallback| fallback.step(s))
    }

    /// A mission for the captain when it is back; to stand is done at once.
    pub(super) fn set_mission(&mut self, mission: &MissionState) {
        if let (true, Some(fallback)) = (mission.left.tasks().is_empty(), &mut self.fallback) {
            fallback.wanted = Some(Twist2::ZERO);
        }
        self.orders = Some(mission.clone());
    }

    /// Leaves an image to be looked at: the newest wins.
    pub(super) fn leave(&mut self, image: LazyImage) {
        let old = self.waiting.replace(image);
        self.dropped.extend(old.map(|old| old.stamp()));
    }
}

impl Robot {
    /// The robot with its long work given out: fetch it with [`Robot::next_job`], run it anywhere, give the answers to
    /// [`Robot::take_up`].
    #[must_use]
    pub fn with_background_jobs(mut self) -> Self {
        self.background.is_used = true;
        self
    }

    /// An image to be looked at in the background. Of those that arrive while one is looked at only the newest is kept: the
    /// others are dropped, see [`Robot::dropped_images`]. A robot that does not defer looks at it at once.
    pub fn queue_image(&mut self, image: LazyImage) -> StepReport {
        let mut report = StepReport::default();
        if self.background.is_used() {
            self.background.leave(image);
        } else {
            match self.times.measure(Stage::Decoding, || image.load()) {
                Ok(image) => self.look(&image, &mut report),
                Err(problem) => report.broken_image = Some(problem),
            }
        }
        self.close(&mut report);
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
            // Before the wheels have said anything an image is of no use.
            self.background.dropped.push(image.stamp());
            return None;
        };
        let perception = self.perception.take()?;
        let odometer = Box::new(odometer);
        Some(Job(Work::Look { perception, image, odometer }))
    }

    /// Takes up what a job came to, between two events.
    ///
    /// The report has a twist where the decision is for the newest reading of the wheels; a later one has been overtaken, and
    /// the next control step acts by it.
    pub fn apply_answer(&mut self, answer: Answer) -> StepReport {
        let mut report = StepReport::default();
        self.times.add(&answer.times);
        match answer.result {
            Outcome::Looked { perception, stamp, sighting } => {
                self.perception = Some(perception);
                report.image = Some(stamp);
                match sighting {
                    Ok(Some(sighting)) => self.apply_perception(*sighting, &mut report),
                    Ok(None) => self.latest.frozen += 1,
                    Err(problem) => report.broken_image = Some(problem),
                }
            }
            Outcome::Decided { decision_worker, decision, asked } => {
                let is_newest = self.latest.odometry.is_some_and(|odometry| odometry.stamp == asked);
                report.twist = (is_newest && self.background.felt.is_empty()).then_some(decision.twist);
                report.twist.into_iter().for_each(|twist| self.odometry.set_command(twist));
                self.take_back(decision_worker, report.twist);
                report.replanned = decision.replanned;
            }
        }
        self.close(&mut report);
        report
    }

    /// Stamps of the images that were dropped because newer ones came before anybody had looked at them.
    pub fn dropped_images(&self) -> &[Stamp] {
        &self.background.dropped
    }

    /// Drops the image that waits to be looked at, if there is one: the run is over.
    pub fn drop_queued_image(&mut self) {
        let waiting = self.background.waiting.take();
        self.background.dropped.extend(waiting.map(|image| image.stamp()));
    }

    /// The captain is back: it learns what happened meanwhile, and what the base was asked for last.
    fn take_back(&mut self, mut decision_worker: Box<DecisionWorker>, sent: Option<Twist2>) {
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
        if let Some(mission) = self.background.orders.take() {
            decision_worker.begin(&mission);
        }
        self.latest.mission = decision_worker.executor.mission();
        self.decision_worker = Some(decision_worker);
    }

    /// What the bumper says.
    pub(super) fn tell_touch(&mut self, pressed: bool) {
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.touch(pressed),
            None => self.background.felt.push(Felt::Touched(pressed)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.touched = pressed;
        }
    }

    /// What the cliff sensors say.
    pub(super) fn cliff(&mut self, over_edge: bool) {
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.cliff(over_edge),
            None => self.background.felt.push(Felt::OverEdge(over_edge)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.over_edge = over_edge;
        }
    }
}
