//! Jobs of the robot: fetched, run on any thread, and applied between two events.

use super::{Robot, event_log::DroppedImage};
use crate::{
    lazy_image::LazyImage,
    report::StepReport,
    stage::Stage,
    workers::job::{Answer, Job, Outcome, Work},
};
use trundle_core::Stamp;

impl Robot {
    /// The robot with long work as jobs. Fetch each with [`Robot::next_job`], run it on any thread, and pass the result to
    /// [`Robot::apply_answer`].
    #[must_use]
    pub fn with_background_jobs(mut self) -> Self {
        self.steering.background.is_used = true;
        self
    }

    /// Queues an image for a perception job. Of the images that arrive during a job only the newest is kept; [`Robot::dropped_images`]
    /// lists the others. A robot without background jobs processes the image at once.
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

    /// The next background job; call this after every event and every answer. `None` without a job, or without background jobs.
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
    /// The report has a twist if the decision is for the newest wheel reading and no bumper, cliff or mission input came after it. An older
    /// decision takes effect in the next control step.
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

    /// Ends the search of a perception job that began before the map was replaced. Returns whether a search was ended.
    fn end_void_search(&mut self, report: &mut StepReport) -> bool {
        let is_void = std::mem::take(&mut self.mapping.voids_search);
        if is_void {
            self.on_map_replaced(report);
        }
        is_void
    }

    /// Stamps of the images replaced by a newer one before processing.
    pub fn dropped_images(&self) -> &[Stamp] {
        self.images.dropped()
    }

    /// Drops a queued image at the end of the run.
    pub fn drop_queued_image(&mut self) {
        if let Some(image) = self.images.take() {
            self.images.drop_image(image.stamp(), DroppedImage::RunOver);
        }
    }
}
