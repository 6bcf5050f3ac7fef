//! Views of a tracked sequence for a front end that watches.

use crate::operator::{
    Activity, DepthViewpoint, ImageFeed, MapCopy, OperatorLink, PerceptionFeed, PerceptionView, RunCounts,
    RunView, SeriesView, VisualMapFeed, on_floor, twist_between,
};
use std::sync::Arc;
use trundle_core::{PinholeCamera, Pose2, Pose3, RgbdImage, Scan, Stamp, Twist2};
use trundle_mapping::{GridMapper, MapperConfig};
use trundle_runtime::{LevelMap, Stage, StageTimes};
use trundle_slam::{RgbdSlam, TrackReport, Tracking};

/// Makes views of a tracked sequence. Without a watching front end, a view contains only pose and counts.
pub(super) struct SequenceFeed {
    link: OperatorLink,
    camera: PinholeCamera,
    images: ImageFeed,
    /// Pose of the camera at the newest depth image of the feed; `None` for an image that was not located.
    depth_pose: Option<Pose3>,
    perception: PerceptionFeed,
    visual_map: VisualMapFeed,
    map: MapFeed,
    scan: Option<(Pose2, Arc<Scan>)>,
    tracked: u64,
    last: Option<(Stamp, Pose2)>,
    /// Time of the first image, the zero of the views' time.
    first: Option<Stamp>,
}

/// Parts of the tracker that a view shows.
pub(super) struct Tracker<'t> {
    pub(super) slam: &'t RgbdSlam,
    pub(super) map: &'t LevelMap,
    pub(super) times: &'t StageTimes,
}

impl SequenceFeed {
    /// Views for `link` of the images of `camera`; the map is drawn by `config`.
    pub(super) fn new(link: OperatorLink, camera: PinholeCamera, config: MapperConfig) -> Self {
        Self {
            link,
            camera,
            images: ImageFeed::default(),
            depth_pose: None,
            perception: PerceptionFeed::default(),
            visual_map: VisualMapFeed::default(),
            map: MapFeed { config, mapper: None, count: 0, copy: MapCopy::default() },
            scan: None,
            tracked: 0,
            last: None,
            first: None,
        }
    }

    /// Publishes the state after an image; `done` images of `total` are tracked.
    pub(super) fn note(
        &mut self,
        image: &RgbdImage,
        jpeg: &[u8],
        report: &TrackReport,
        tracker: &Tracker<'_>,
        (done, total): (usize, usize),
    ) {
        let pose = on_floor(&report.visual_from_camera);
        self.tracked += 1;
        self.perception.note_loop(report, pose);
        if self.link.is_watched() {
            self.images.note_jpeg(report.stamp, jpeg);
            self.note_depth(image, report);
            let size_px = [image.color().width(), image.color().height()];
            self.perception.update(size_px, report, tracker.slam);
            self.visual_map.update(report.stamp, Some(tracker.slam), Some(Pose3::identity()));
            self.map.update(report, tracker);
            let scan = tracker.map.scan_at(report.stamp, &report.visual_from_camera);
            self.scan = scan.map(|(base, scan)| (base, Arc::new(scan.clone()))).or(self.scan.take());
        }
        let view = self.view(report, pose, tracker);
        self.link.publish_view(view);
        let (unit, total) = ("images", Some(total));
        self.link.operator().show_series(SeriesView { unit, done, total, ..SeriesView::default() });
    }

    fn note_depth(&mut self, image: &RgbdImage, report: &TrackReport) {
        self.images.note_depth(report.stamp, image.depth());
        if self.images.depth().is_some_and(|depth| depth.stamp == report.stamp) {
            self.depth_pose = report.tracking.is_located().then_some(report.visual_from_camera);
        }
    }

    fn perception(&self) -> PerceptionView {
        let viewpoint = DepthViewpoint { camera: self.camera, map_from_camera: self.depth_pose };
        let depth_viewpoint = self.images.depth().map(|_| viewpoint);
        PerceptionView { depth_viewpoint, ..self.perception.view(&self.images, &self.visual_map) }
    }

    fn view(&mut self, report: &TrackReport, pose: Pose2, tracker: &Tracker<'_>) -> RunView {
        let stamp = report.stamp;
        let twist =
            self.last.replace((stamp, pose)).map_or(Twist2::ZERO, |last| twist_between(last, (stamp, pose)));
        let reason = format!(
            "features on the map: {} of {}, keyframes: {}, landmarks: {}",
            report.inliers, report.features, report.keyframes, report.landmarks
        );
        let activity = Activity { name: state_name(report.tracking), reason: Some(reason) };
        let stages = [Stage::Slam, Stage::Scan];
        let since_first = Stamp::default().after(stamp - *self.first.get_or_insert(stamp));
        RunView {
            scan_pose: self.scan.as_ref().map(|(base, _)| *base),
            scan: self.scan.as_ref().map(|(_, scan)| Arc::clone(scan)),
            map: self.map.copy.view(),
            perception: self.perception(),
            counts: RunCounts {
                slam: self.tracked,
                mapping: tracker.map.scan_count() as u64,
                stages: stages.map(|stage| (stage.name(), tracker.times.total(stage))).to_vec(),
                ..RunCounts::default()
            },
            ..RunView::of_activity(since_first, pose, twist, activity)
        }
    }
}

/// The growing floor map: each scan is drawn once, and all scans again after a loop closure.
struct MapFeed {
    config: MapperConfig,
    mapper: Option<GridMapper>,
    /// Scans that the mapper has.
    count: usize,
    copy: MapCopy,
}

impl MapFeed {
    fn update(&mut self, report: &TrackReport, tracker: &Tracker<'_>) {
        let is_corrected = report.closed_loop.is_some() || report.merged.is_some();
        let count = tracker.map.scan_count();
        // Scans that arrived while no front end watched are missing.
        if is_corrected || self.mapper.is_none() || count > self.count + 1 {
            self.mapper = redrawn(tracker, &self.config);
        } else if count > self.count
            && let (Some(mapper), Some((base, scan))) =
                (&mut self.mapper, tracker.map.scan_at(report.stamp, &report.visual_from_camera))
        {
            mapper.insert(base, scan);
        }
        self.count = count;
        if let Some(mapper) = &self.mapper {
            self.copy.update(count as u64, is_corrected, || mapper.grid().clone());
        }
    }
}

fn redrawn(tracker: &Tracker<'_>, config: &MapperConfig) -> Option<GridMapper> {
    tracker.map.mapper(&tracker.slam.trajectory(), config.clone()).ok()
}

fn state_name(tracking: Tracking) -> &'static str {
    match tracking {
        Tracking::Ok => "tracking",
        Tracking::Weak => "tracking weakly",
        Tracking::DeadReckoning => "dead reckoning",
        Tracking::Lost => "lost",
    }
}
