//! Consistency of a loaded map with the scans of a run.

use crate::filter_models::FilterModels;
use crate::scan_match::cloud_match::CloudMatcher;
use crate::scan_match::scan_points::ScanPoints;
use trundle_core::{Pose2, Stamp};
use trundle_grid::tiles::TileMap;

/// The loaded map of a run. Scans are compared with this map, not with the run's additions.
#[derive(Debug)]
pub(crate) struct GivenMap {
    pub(crate) map: TileMap,
    /// Number of stored scans in the map.
    pub(crate) scans: usize,
    /// Contradicting scans since the last agreeing one, if any.
    streak: Option<Streak>,
}

/// Scans that contradict the given map, without an agreeing one in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Streak {
    /// Stamp of the first contradicting scan.
    pub(crate) since: Stamp,
    /// Number of stored scans before the first contradicting one.
    pub(crate) scans_before: usize,
    count: usize,
}

/// Relation of a scan at a pose to the given map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Agrees,
    Contradicts,
    /// Almost all hits are beyond the map, or the contradiction is small enough for a changed room.
    Unclear,
}

/// Number of contradicting scans in a row after which the pose counts as wrong. A moved piece of furniture contradicts fewer hits, and a
/// person fewer scans. Source: ours.
const MIN_CONTRADICTING_SCANS: usize = 5;
/// Smallest fraction of contradicting hits on known ground in a contradicting scan \[1\]. Source: ours; 0.65 and more in sena.log after the
/// robot was carried, 0.45 to 0.65 in a drawn hall.
const MIN_SHARE_CONTRADICTED: f64 = 0.45;
/// Largest fraction of contradicting hits in an agreeing scan \[1\]. Source: ours; moved furniture in a drawn hall has up to 0.28, single
/// scans at a correct pose in sena.log up to 0.46.
const MAX_SHARE_AGREEING: f64 = 0.25;
/// Smallest fraction of hits on known ground of the map \[1\]. A scan with less is beyond the map. Source: ours.
const MIN_SHARE_ON_MAP: f64 = 0.15;

impl GivenMap {
    /// The map of a run before its first scan is drawn; `scans` is the number of stored scans in it.
    pub(crate) fn new(map: TileMap, scans: usize) -> Self {
        Self { map, scans, streak: None }
    }

    /// Compares a scan at `map_from_base` (cells) with the map; `scans_before` is the number of stored scans without this one. Returns the
    /// streak if it is long enough.
    pub(crate) fn check(
        &mut self,
        models: &FilterModels,
        points: &ScanPoints,
        map_from_base: Pose2,
        (stamp, scans_before): (Stamp, usize),
    ) -> Option<Streak> {
        let matcher = CloudMatcher { config: &models.config, likelihood: &models.likelihood, cloud: points };
        let (explained, contradicted) = matcher.fit(&self.map, map_from_base);
        match verdict(explained, contradicted) {
            Verdict::Agrees => self.streak = None,
            Verdict::Unclear => {}
            Verdict::Contradicts => {
                let streak = self.streak.get_or_insert(Streak { since: stamp, scans_before, count: 0 });
                streak.count += 1;
            }
        }
        self.streak.take_if(|streak| streak.count >= MIN_CONTRADICTING_SCANS)
    }
}

/// Verdict by the fractions of hits at obstacles of the map and on its free ground.
fn verdict(explained: f64, contradicted: f64) -> Verdict {
    let on_map = explained + contradicted;
    if on_map < MIN_SHARE_ON_MAP {
        Verdict::Unclear
    } else if contradicted > MIN_SHARE_CONTRADICTED * on_map {
        Verdict::Contradicts
    } else if contradicted <= MAX_SHARE_AGREEING * on_map {
        Verdict::Agrees
    } else {
        Verdict::Unclear
    }
}
