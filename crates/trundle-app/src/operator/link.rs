//! The two ends of the link between a run and its operator.

use super::annotation_store::AnnotationStore;
use super::hands::HandId;
use super::operator_error::OperatorError;
use super::request::OperatorRequest;
use super::request_queue::{RequestReceiver, RequestSender, request_queue};
use super::run_view::RunView;
use super::series::SeriesView;
use super::view_feed::ViewFeed;
use crate::RecordingSwitch;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::{MapAnnotations, PinholeCamera, RgbdImage, SensorEvent, Stamp, Twist2};
use trundle_io::EncodedRgbd;
use trundle_runtime::{OperatorCommand, Robot, StepReport};

/// Time without a request for a view after which the run counts as unwatched. Source: ours; a viewer requests a view ten times a second.
const UNWATCHED_AFTER: Duration = Duration::from_secs(1);

/// A front end's end of the link. Clones share the end.
#[derive(Debug, Clone)]
pub struct Operator {
    shared: Arc<Shared>,
}

/// A run's end of the link.
#[derive(Debug)]
pub struct OperatorLink {
    /// `None` for a run that takes no commands.
    requests: Option<RequestReceiver>,
    shared: Arc<Shared>,
    feed: ViewFeed,
    /// Time of the last request for a view, as noticed by the run.
    asked: Instant,
}

#[derive(Debug)]
struct Shared {
    requests: RequestSender,
    view: Mutex<Option<Arc<RunView>>>,
    /// Whether a front end requested a view since the last step.
    is_asked: AtomicBool,
    series: Mutex<Option<Arc<SeriesView>>>,
    recording: Mutex<Option<RecordingSwitch>>,
    annotations: Mutex<AnnotationStore>,
    /// Held while zones or places are changed and written.
    editing: Mutex<()>,
}

/// A link: the front end's end and the run's end.
#[must_use]
pub fn operator_link() -> (Operator, OperatorLink) {
    let (sender, requests) = request_queue();
    let view = Mutex::default();
    let (is_asked, annotations, editing) = (AtomicBool::new(false), Mutex::default(), Mutex::default());
    let (series, recording) = (Mutex::default(), Mutex::default());
    let shared =
        Arc::new(Shared { requests: sender, view, is_asked, series, recording, annotations, editing });
    let link = OperatorLink::new(Some(requests), Arc::clone(&shared));
    (Operator { shared }, link)
}

impl Operator {
    /// Sends a command; returns its number, by which [`RunView::mission`] identifies the mission that the command starts. The twists of a person
    /// go by [`Self::drive`], so that a stop holds against them.
    ///
    /// # Errors
    /// When the command cannot be carried out, too many wait, or the run is over.
    pub fn send(&self, command: OperatorCommand) -> Result<u64, OperatorError> {
        self.shared.requests.send(command.validated()?)
    }

    /// Sends a twist of a person who drives by hand; returns its number.
    ///
    /// # Errors
    /// When the twist is not valid, the person has driven without release since a stop, too many requests wait, or the run is over.
    pub fn drive(&self, hand: HandId, twist: Twist2) -> Result<u64, OperatorError> {
        OperatorCommand::Drive(twist).validated()?;
        self.shared.requests.drive(hand, twist)
    }

    /// Notes a twist of a person that is refused elsewhere, so that a stop bars this person too.
    pub fn note_refused_drive(&self, hand: HandId, twist: Twist2) {
        self.shared.requests.note_hand(hand, twist);
    }

    /// Stops the robot, holds it and ends its mission, before all waiting requests; drops those that would move it afterwards. A full queue
    /// does not refuse a stop. Who drives by hand must release the control before the robot obeys again. Returns the number of the pause.
    ///
    /// # Errors
    /// When the run is over.
    pub fn stop(&self) -> Result<u64, OperatorError> {
        self.shared.requests.stop(true)
    }

    /// Ends the mission as [`Self::stop`] does, without a hold: the robot obeys the next task.
    ///
    /// # Errors
    /// When the run is over.
    pub fn end_mission(&self) -> Result<u64, OperatorError> {
        self.shared.requests.stop(false)
    }

    /// Number of the last request that begins or ends a pause: of any front end.
    #[must_use]
    pub fn last_pause(&self) -> u64 {
        self.shared.requests.last_pause()
    }

    pub(super) fn editing(&self) -> MutexGuard<'_, ()> {
        self.shared.editing.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn annotation_store(&self) -> MutexGuard<'_, AnnotationStore> {
        self.shared.annotations.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The newest view, without a request for its large parts: scan, image and map may be old.
    #[must_use]
    pub fn peek(&self) -> Option<Arc<RunView>> {
        self.shared.view.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The newest view; `None` before the first step. Scan, image and map are updated while a front end calls this at least once per
    /// second.
    #[must_use]
    pub fn view(&self) -> Option<Arc<RunView>> {
        self.shared.is_asked.store(true, Ordering::Relaxed);
        self.peek()
    }
}

impl Operator {
    /// The end of this link for another displayed run without commands.
    #[must_use]
    pub fn link_of_shown_run(&self) -> OperatorLink {
        OperatorLink::new(None, Arc::clone(&self.shared))
    }

    /// Shows the progress of a series.
    pub fn show_series(&self, series: SeriesView) {
        *self.shared.series.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(series));
    }

    /// The switch of the run's recording; `None` before the first step, and for work without one.
    #[must_use]
    pub fn recording(&self) -> Option<RecordingSwitch> {
        self.shared.recording.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The series that the run is a part of.
    #[must_use]
    pub fn series(&self) -> Option<Arc<SeriesView>> {
        self.shared.series.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl OperatorLink {
    fn new(requests: Option<RequestReceiver>, shared: Arc<Shared>) -> Self {
        Self { requests, shared, feed: ViewFeed::default(), asked: Instant::now() }
    }

    /// Another front end's end of this link.
    #[must_use]
    pub fn operator(&self) -> Operator {
        Operator { shared: Arc::clone(&self.shared) }
    }

    /// Copies a camera image into later views if a front end watches.
    pub(crate) fn note_image(&mut self, image: &EncodedRgbd) {
        if self.is_watched() {
            self.feed.images.note_encoded(image.stamp, &image.color_jpeg, &image.depth);
        }
    }

    /// Offers the switch of the run's recording to front ends.
    pub(crate) fn show_recording(&self, switch: RecordingSwitch) {
        *self.shared.recording.lock().unwrap_or_else(PoisonError::into_inner) = Some(switch);
    }

    /// Copies an image of a simulator into later views if a front end watches and the last copy is old; returns whether it did.
    pub fn note_rgbd(&mut self, image: &RgbdImage) -> bool {
        self.is_watched() && self.feed.images.note_rgbd(image)
    }

    /// Applies [`OperatorLink::note_rgbd`] to an event with an image; ignores other events.
    pub fn note_event(&mut self, event: &SensorEvent) {
        if let SensorEvent::Rgbd(image) = event {
            self.note_rgbd(image);
        }
    }

    /// Whether a front end watches: large parts of views are only made then.
    #[must_use]
    pub fn is_watched(&self) -> bool {
        self.asked.elapsed() < UNWATCHED_AFTER
    }

    /// Records whether a front end requested a view.
    fn note_asked(&mut self) {
        if self.shared.is_asked.swap(false, Ordering::Relaxed) {
            self.asked = Instant::now();
        }
    }

    /// The next request, if one waits. Changes to zones and places of a replaced map are dropped: the file of that map contains them.
    pub fn next_request(&self) -> Option<OperatorRequest> {
        loop {
            let request = self.requests.as_ref()?.next()?;
            let operator = self.operator();
            let mut store = operator.annotation_store();
            if !store.is_of_earlier_map(&request) {
                return Some(request);
            }
            store.waiting = store.waiting.saturating_sub(1);
            tracing::warn!(
                "a change of zones or places is dropped: it is for the map before the present one"
            );
        }
    }

    /// Notes the camera of the images.
    pub fn note_camera(&mut self, camera: &PinholeCamera) {
        self.feed.camera = Some(*camera);
    }

    /// The zones and places with which a run begins, and the file that keeps their changes.
    pub(crate) fn begin_annotations(&mut self, annotations: &Arc<MapAnnotations>, file: Option<&Path>) {
        *self.operator().annotation_store() =
            AnnotationStore::new(Arc::clone(annotations), file.map(Path::to_owned));
    }

    /// Notes the zones and places of a replay.
    pub(crate) fn note_request(&mut self, request: &OperatorRequest) {
        if let OperatorCommand::Annotate(annotations) = &request.command {
            self.operator().annotation_store().note_executed(annotations);
        }
    }

    /// Records the effect of the request `id`. Zones and places belong to the map: a robot on another map has those that came with it, and
    /// the file of the old ones does not change.
    pub(crate) fn note_executed(&mut self, id: u64, report: &StepReport) {
        if report.mission_replaced {
            self.feed.note_mission(id);
        }
        let operator = self.operator();
        // The lock of the store is held while a change is sent: each one is before the number or is made without the old map.
        let mut store = operator.annotation_store();
        let own = store.take_of_sent_map(id);
        if !report.map_replaced {
            return;
        }
        self.feed.note_map_replaced();
        store.note_map_replaced(self.shared.requests.last());
        if let Some(annotations) = own.filter(|own| *own != MapAnnotations::default()) {
            self.shared.requests.send_first(OperatorCommand::Annotate(annotations.clone()));
            store.waiting += 1;
            store.newest = Arc::new(annotations);
        }
    }

    /// Publishes the state of the robot after a step.
    pub fn publish(&mut self, stamp: Stamp, robot: &Robot, report: &StepReport) {
        self.note_asked();
        if let Some(view) = self.feed.view(stamp, robot, report, self.is_watched()) {
            self.set_view(view);
        }
    }

    /// Publishes a view of work without a robot. A view without images shows those of [`OperatorLink::note_rgbd`].
    pub fn publish_view(&mut self, mut view: RunView) {
        self.note_asked();
        let images = &self.feed.images;
        view.perception.image = view.perception.image.or_else(|| images.image());
        view.perception.depth = view.perception.depth.or_else(|| images.depth());
        self.set_view(view);
    }

    fn set_view(&self, view: RunView) {
        *self.shared.view.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(view));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Pose2;
    use trundle_runtime::PoseGuess;

    #[test]
    fn a_command_that_is_not_a_number_does_not_reach_the_run() {
        let (operator, link) = operator_link();
        let pose = Pose2::new(f64::NAN, 0.0, 0.0);
        let guess = PoseGuess { pose, position_sigma: 0.1, heading_sigma: 0.1 };
        assert!(matches!(operator.send(OperatorCommand::SetPose(guess)), Err(OperatorError::Invalid(_))));
        assert_eq!(link.next_request(), None);
    }
}
