//! Jobs of the robot: given out, run anywhere, and their results applied between two events.

use super::{Robot, event_log::DroppedImage};
use crate::{
    lazy_image::LazyImage,
    report::StepReport,
    stage::Stage,
    workers::job::{Answer, Job, Outcome, Work},
};
use trundle_core::Stamp;

impl Robot {
    /// The robot with its long work as jobs: fetch each with [`Robot::next_job`], run it anywhere, give the result to
    /// [`Robot::apply_answer`].
    #[must_use]
    pub fn with_background_jobs(mut self) -> Self {
        self.steering.background.is_used = true;
        self
    }

    /// Queues an image for a perception job. Of those that arrive while a job runs only the newest is kept; the others are dropped, see
    /// [`Robot::dropped_images`]. A robot without background jobs processes the image at once.
    pub fn queue_image(&mut self, image: LazyImage) -> StepReport {
        let mut report = StepReport::default();
        if self.steering.background.is_used() {
            self.images.push(image);
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
        if let Some(job) = self.steering.next_job() {
            return Some(job);
        }
        self.perception.as_ref()?;
        let image = self.images.take()?;
        let Some(odometer) = self.odometry_at(image.stamp()) else {
            self.images.drop_image(image.stamp(), DroppedImage::NoOdometry);
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
                let is_of_replaced_map = self.end_void_search(&mut report);
                match perceived {
                    Ok(Some(mut result)) => {
                        result.place = result.place.filter(|_| !is_of_replaced_map);
                        self.apply_perception(*result, &mut report);
                    }
                    Ok(None) => self.drop_frozen(stamp),
                    Err(problem) => report.broken_image = Some(problem),
                }
            }
            Outcome::Decided { decision_worker, decision, asked } => {
                let is_newest = self.latest.odometry.is_some_and(|odometry| odometry.stamp == asked);
                let is_held = self.latest.body.hold(self.range_sensor.source).is_some();
                report.twist = self.steering.on_decided(decision_worker, &decision, is_newest && !is_held);
                report.twist.into_iter().for_each(|twist| self.odometry.set_command(twist));
                report.replanned = decision.replanned;
            }
        }
        self.complete(&mut report);
        report
    }

    /// Ends the search of a perception job that began before the map was replaced, whatever became of its image. Whether it did.
    fn end_void_search(&mut self, report: &mut StepReport) -> bool {
        let is_void = std::mem::take(&mut self.mapping.voids_search);
        if is_void {
            self.on_map_replaced(report);
        }
        is_void
    }

    /// Stamps of the images that a newer one replaced before they were processed.
    pub fn dropped_images(&self) -> &[Stamp] {
        self.images.dropped()
    }

    /// Drops the queued image, if there is one: the run is over.
    pub fn drop_queued_image(&mut self) {
        if let Some(image) = self.images.take() {
            self.images.drop_image(image.stamp(), DroppedImage::RunOver);
        }
    }
}
