//! Data sent to a viewer: the newest of each kind, at the viewer's own rate.

use super::outbox::Outbox;
use super::progress::ViewProgress;
use crate::page_state::PageState;
use crate::viewer_list::ViewerId;
use crate::wire::{
    RecordingText, Reply, SeriesText, SettingText, StateMessage, TileCursor, WheelText, depth_message,
    features_message, image_message, path_message, scan_message, trail_message, visual_map_message,
};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::sync::mpsc::Receiver;
use tokio::time::{Instant, MissedTickBehavior, interval};
use trundle_app::operator::{FeatureView, PlanView, RunView, SeriesView, VisualMapView};
use trundle_core::{MapAnnotations, Stamp};
use trundle_runtime::{RunSetting, RunSettings};

/// Period of views. Source: ours.
const VIEW_PERIOD: Duration = Duration::from_millis(100);
/// Maximum number of sent views not yet drawn by the page. Above it no view is sent, which keeps old views out of a slow network. Source:
/// ours; three views hide a delay of 0.3 s.
const MAX_UNSEEN: u64 = 3;
/// Period of images. Source: ours.
const IMAGE_PERIOD: Duration = Duration::from_millis(180);
/// Longest time without a message during a constant state: the page then knows that the link works. Source: ours.
const QUIET_PERIOD: Duration = Duration::from_secs(1);

/// Sends answers and views until the viewer takes none; why it ends.
pub async fn send(
    outbox: &mut Outbox,
    state: &PageState,
    id: ViewerId,
    progress: &ViewProgress,
    mut answers: Receiver<Reply>,
) -> &'static str {
    const VIEWER_CLOSED: &str = "the viewer takes no messages";
    let mut updates = Updates::new(id);
    let mut ticks = interval(VIEW_PERIOD);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    if !updates.begin(outbox, state).await {
        return VIEWER_CLOSED;
    }
    loop {
        let is_taken = tokio::select! {
            biased;
            Some(answer) = answers.recv() => outbox.send_json(&answer).await,
            _ = ticks.tick() => updates.send(outbox, state, progress).await,
        };
        if !is_taken {
            return VIEWER_CLOSED;
        }
    }
}

/// State of the data sent to a viewer.
struct Updates {
    id: ViewerId,
    batch: u64,
    view: Option<Arc<RunView>>,
    view_sent: Instant,
    tiles: TileCursor,
    scan: Option<Stamp>,
    plan: Option<Arc<PlanView>>,
    image: Option<Stamp>,
    image_sent: Instant,
    /// Number of the view with the last image.
    image_batch: u64,
    features: Option<Arc<FeatureView>>,
    notes: SentNotes,
    visual_map: Option<Arc<VisualMapView>>,
    states: usize,
}

/// Versions of the notes sent to a viewer in addition to the state.
#[derive(Default)]
struct SentNotes {
    annotations: Option<Arc<MapAnnotations>>,
    settings: Option<RunSettings>,
    series: Option<Arc<SeriesView>>,
    recording: Option<RecordingText>,
    depth_camera: bool,
}

impl SentNotes {
    /// Zones, places, settings, depth camera, series and recording that changed.
    fn changed(&mut self, view: &RunView, state: &PageState) -> Vec<Reply> {
        let annotations = state.operator.annotations();
        let is_new = self.annotations.as_ref().is_none_or(|known| !Arc::ptr_eq(known, &annotations));
        let zones = is_new.then(|| Reply::Annotations { annotations: annotations.as_ref().clone() });
        self.annotations = Some(annotations);
        let known = std::mem::replace(&mut self.settings, view.settings);
        let changed = view.settings.filter(|_| known != view.settings);
        let limits = &state.facts.limits;
        let text = |setting: &RunSetting| SettingText::of(*setting, limits);
        let settings = changed.map(|all| Reply::Settings { settings: all.iter().map(text).collect() });
        let others = self.series_note(state).into_iter().chain(self.recording_note(state));
        zones.into_iter().chain(settings).chain(self.depth_camera_note(view)).chain(others).collect()
    }

    /// Sent once, after the first depth image of a known camera.
    fn depth_camera_note(&mut self, view: &RunView) -> Option<Reply> {
        let is_new = !self.depth_camera && view.perception.depth_viewpoint.is_some();
        self.depth_camera |= is_new;
        is_new.then_some(Reply::DepthCamera)
    }

    fn recording_note(&mut self, state: &PageState) -> Option<Reply> {
        let recording = RecordingText::of(&state.operator.recording()?.state());
        let is_new = self.recording.as_ref() != Some(&recording);
        self.recording = Some(recording.clone());
        is_new.then_some(Reply::Recording(recording))
    }

    fn series_note(&mut self, state: &PageState) -> Option<Reply> {
        let series = state.operator.series()?;
        let is_new = self.series.as_ref().is_none_or(|known| *known != series);
        let note = is_new.then(|| Reply::Series(SeriesText::of(&series)));
        self.series = Some(series);
        note
    }
}

impl Updates {
    fn new(id: ViewerId) -> Self {
        let now = Instant::now();
        Self {
            id,
            batch: 0,
            view: None,
            view_sent: now,
            tiles: TileCursor::default(),
            scan: None,
            plan: None,
            image: None,
            image_sent: now,
            image_batch: 0,
            features: None,
            notes: SentNotes::default(),
            visual_map: None,
            states: 0,
        }
    }

    /// Events before the viewer came.
    async fn begin(&mut self, outbox: &mut Outbox, state: &PageState) -> bool {
        let trail = trail_message(state.history().points());
        outbox.send_bytes(trail).await
    }

    /// Sends new data, if the viewer has drawn the previous data. Returns whether the viewer received it.
    async fn send(&mut self, outbox: &mut Outbox, state: &PageState, progress: &ViewProgress) -> bool {
        if self.batch.saturating_sub(progress.seen.load(Ordering::Relaxed)) >= MAX_UNSEEN {
            return true;
        }
        let Some(view) = state.operator.view() else { return true };
        let is_new = self.view.as_ref().is_none_or(|last| !Arc::ptr_eq(last, &view));
        if !is_new && self.view_sent.elapsed() < QUIET_PERIOD {
            return true;
        }
        self.batch += 1;
        self.view_sent = Instant::now();
        let parts = self.parts(&view, state, progress);
        let message = self.state_message(&view, state);
        let notes = self.notes.changed(&view, state);
        self.view = Some(view);
        let (states, so_far) = state.history().states_after(self.states);
        self.states = so_far;
        if !outbox.send_json(&message).await
            || !states.is_empty() && !outbox.send_json(&Reply::States { states }).await
        {
            return false;
        }
        for note in notes {
            if !outbox.send_json(&note).await {
                return false;
            }
        }
        for part in parts {
            if !outbox.send_bytes(part).await {
                return false;
            }
        }
        true
    }

    fn state_message(&self, view: &RunView, state: &PageState) -> StateMessage {
        let viewer_list = state.viewer_list();
        let wheel = viewer_list.holder().map(|(id, name)| WheelText { name, is_you: id == self.id });
        StateMessage::of(view, self.batch, wheel, viewer_list.count())
    }

    /// The binary messages with the parts that the viewer lacks.
    fn parts(&mut self, view: &RunView, state: &PageState, progress: &ViewProgress) -> Vec<Vec<u8>> {
        let mut parts = Vec::new();
        parts.extend(self.scan_part(view));
        parts.extend(self.plan_part(view));
        if let Some(map) = &view.map {
            let mut tiles = state.tiles();
            tiles.update(map);
            parts.extend(tiles.message(&mut self.tiles));
        }
        if progress.wants_images.load(Ordering::Relaxed) {
            parts.extend(self.features_part(view));
            parts.extend(self.image_part(view, progress));
            if progress.wants_depth.load(Ordering::Relaxed) {
                parts.extend(self.depth_part(view));
            }
        }
        if progress.wants_visual_map.load(Ordering::Relaxed) {
            parts.extend(self.visual_map_part(view));
        }
        parts
    }

    fn scan_part(&mut self, view: &RunView) -> Option<Vec<u8>> {
        let (scan, pose) = (view.scan.as_ref()?, view.scan_pose?);
        let is_new = self.scan.replace(scan.stamp()) != Some(scan.stamp());
        is_new.then(|| scan_message(scan, pose))
    }

    /// A plan that is the same is the same allocation.
    fn plan_part(&mut self, view: &RunView) -> Option<Vec<u8>> {
        let is_same = match (&self.plan, &view.plan) {
            (Some(known), Some(plan)) => Arc::ptr_eq(known, plan),
            (None, None) => true,
            _ => false,
        };
        self.plan.clone_from(&view.plan);
        (!is_same).then(|| path_message(view.plan.as_deref()))
    }

    /// The next image waits until the page has drawn a view that came after the last one: then it has that image too.
    fn image_part(&mut self, view: &RunView, progress: &ViewProgress) -> Option<Vec<u8>> {
        let image = view.perception.image.as_ref()?;
        let is_taken = self.image_batch == 0 || progress.seen.load(Ordering::Relaxed) > self.image_batch;
        if self.image == Some(image.stamp) || self.image_sent.elapsed() < IMAGE_PERIOD || !is_taken {
            return None;
        }
        self.image_batch = self.batch;
        self.image = Some(image.stamp);
        self.image_sent = Instant::now();
        Some(image_message(image))
    }

    /// The depth is only sent together with its image.
    fn depth_part(&mut self, view: &RunView) -> Option<Vec<u8>> {
        let depth = view.perception.depth.as_ref().filter(|_| self.image_batch == self.batch)?;
        let map_number = view.map.as_ref().map_or(0, |map| map.number);
        Some(depth_message(depth.picture()?, view.perception.depth_viewpoint, map_number))
    }

    fn features_part(&mut self, view: &RunView) -> Option<Vec<u8>> {
        let features = view.perception.features.as_ref()?;
        let is_new = self.features.as_ref().is_none_or(|known| !Arc::ptr_eq(known, features));
        self.features = Some(Arc::clone(features));
        is_new.then(|| features_message(features))
    }

    fn visual_map_part(&mut self, view: &RunView) -> Option<Vec<u8>> {
        let map = view.perception.visual_map.as_ref()?;
        let is_new = self.visual_map.as_ref().is_none_or(|known| !Arc::ptr_eq(known, map));
        self.visual_map = Some(Arc::clone(map));
        is_new.then(|| visual_map_message(map))
    }
}
