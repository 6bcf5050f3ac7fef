//! Views of a log that is mapped, for a front end that watches.

use super::counts::ScanCounts;
use crate::operator::{Activity, MapCopy, OperatorLink, RunCounts, RunView, SeriesView, twist_between};
use std::sync::Arc;
use trundle_core::{OccupancyGrid, Pose2, Scan, Stamp, Twist2};
use trundle_mapping::{MapLocalizer, ParticleMapper};

/// Makes views of a log after each scan. Without a watching front end, a view contains only pose and counts.
pub(super) struct LogFeed {
    link: OperatorLink,
    map: MapCopy,
    /// The scan of the last view, and map_from_base at it.
    scan: Option<(Pose2, Arc<Scan>)>,
    last: Option<(Stamp, Pose2)>,
    /// Time of the first scan, the zero of the views' time.
    first: Option<Stamp>,
    /// Number of loop closures so far.
    corrections: usize,
}

/// State of the work after a scan.
struct LogState<'s> {
    /// Name of the activity.
    activity: &'static str,
    /// map_from_base at the scan; `None` if it is unknown.
    pose: Option<Pose2>,
    counts: &'s ScanCounts,
    /// Number of scans in the map; of a given map always 0.
    drawn: usize,
    /// Number of scans of the log.
    total: usize,
}

/// Activity without a known pose.
const SEARCHING: &str = "searching the pose";

impl LogFeed {
    pub(super) fn new(link: OperatorLink) -> Self {
        Self { link, map: MapCopy::default(), scan: None, last: None, first: None, corrections: 0 }
    }

    /// Publishes the state after a scan in a map that grows.
    pub(super) fn note_mapped(
        &mut self,
        scan: &Scan,
        counts: &ScanCounts,
        total: usize,
        mapper: &mut ParticleMapper,
    ) {
        let pose = (!counts.is_paused).then(|| mapper.pose());
        let activity = pose.map_or(SEARCHING, |_| "mapping");
        let state = LogState { activity, pose, counts, drawn: counts.processed, total };
        self.note(scan, &state, || mapper.grid().clone());
    }

    /// Publishes the state after a scan in a given map.
    pub(super) fn note_localized(
        &mut self,
        scan: &Scan,
        pose: Option<Pose2>,
        counts: &ScanCounts,
        total: usize,
        localizer: &MapLocalizer,
    ) {
        let activity = pose.map_or(SEARCHING, |_| "localizing");
        self.note(scan, &LogState { activity, pose, counts, drawn: 0, total }, || localizer.grid());
    }

    /// `grid` is the map, which is only copied for a front end that watches.
    fn note(&mut self, scan: &Scan, state: &LogState<'_>, grid: impl FnOnce() -> OccupancyGrid) {
        let stamp = scan.stamp();
        let pose = state.pose.or(self.last.map(|(_, pose)| pose)).unwrap_or_default();
        let before = self.last.replace((stamp, pose));
        let counts = state.counts;
        let is_corrected = std::mem::replace(&mut self.corrections, counts.corrections) < counts.corrections;
        if self.link.is_watched() {
            self.scan = state.pose.map(|pose| (pose, Arc::new(scan.clone())));
            self.map.update(state.drawn as u64, is_corrected, grid);
        }
        let reason = format!("scans with a pose: {}, without: {}", counts.processed, counts.lost);
        let activity = Activity { name: state.activity, reason: Some(reason) };
        let twist = before.map_or(Twist2::ZERO, |before| twist_between(before, (stamp, pose)));
        let since_first = Stamp::default().after(stamp - *self.first.get_or_insert(stamp));
        let view = RunView {
            scan_pose: self.scan.as_ref().map(|(pose, _)| *pose),
            scan: self.scan.as_ref().map(|(_, scan)| Arc::clone(scan)),
            map: self.map.view(),
            counts: RunCounts { mapping: state.drawn as u64, ..RunCounts::default() },
            ..RunView::of_activity(since_first, pose, twist, activity)
        };
        self.link.publish_view(view);
        let (done, total) = (counts.read, Some(state.total));
        self.link.operator().show_series(SeriesView { unit: "scans", done, total, ..SeriesView::default() });
    }
}
