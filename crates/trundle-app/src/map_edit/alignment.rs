//! The transform between two maps of files, and the reasons for its absence in words.

use super::output::row;
use crate::AppError;
use std::path::Path;
use trundle_core::{OccupancyGrid, Pose2};
use trundle_io::PictureMap;
use trundle_mapping::map_edit::{
    MIN_AGREEING_M, MIN_AGREEING_SHARE, MapFit, MapMatch, MatchFailure, fit_at, match_maps,
};

/// A map of a file in the frame of another map.
pub(super) struct AlignedMap {
    /// Pose of the map's frame in the frame of the other map.
    pub other_from_map: Pose2,
    /// The agreement; `None` for a given pose of maps without walls.
    pub fit: Option<MapFit>,
    /// The second-best pose of a search.
    pub rival: Option<MapFit>,
}

impl AlignedMap {
    /// Searches the pose of a map in the frame of another one.
    pub(super) fn found(
        (first_file, first): (&Path, &OccupancyGrid),
        (file, map): (&Path, &PictureMap),
    ) -> Result<Self, AppError> {
        let found = match_maps(first, &map.grid)
            .map_err(|failure| AppError::Input(failure_text(failure, first_file, file, map.map_from_grid)))?;
        let map_from_grid = map.map_from_grid;
        let MapMatch { best, rival } = found;
        let other_from_map = best.first_from_second * map_from_grid.inverse();
        Ok(Self { other_from_map, fit: Some(best), rival })
    }

    /// The given pose of a map in the frame of another one, measured.
    pub(super) fn given(first: &OccupancyGrid, map: &PictureMap, other_from_map: Pose2) -> Self {
        let fit = fit_at(first, &map.grid, other_from_map * map.map_from_grid).ok();
        Self { other_from_map, fit, rival: None }
    }

    /// The numbers of the alignment, one row each.
    pub(super) fn rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![row("lies at", pose_text(self.other_from_map))];
        if let Some(fit) = &self.fit {
            rows.push(row("walls that agree, of those compared", fit_text(fit)));
        }
        if let Some(rival) = &self.rival {
            rows.push(row("the same at the second-best pose", fit_text(rival)));
        }
        rows
    }
}

/// Share and length of the walls that agree.
fn fit_text(fit: &MapFit) -> String {
    let all = fit.agreeing_m + fit.contradicting_m;
    format!("{:.1} %, {:.1} of {all:.1} m", 100.0 * fit.agreeing_share(), fit.agreeing_m)
}

/// A pose as an option takes it.
fn pose_text(pose: Pose2) -> String {
    format!("{:.3},{:.3},{:.2}", pose.x, pose.y, pose.theta.to_degrees())
}

fn failure_text(failure: MatchFailure, first: &Path, second: &Path, map_from_grid: Pose2) -> String {
    let (first, second) = (first.display(), second.display());
    let at = |fit: &MapFit| {
        let pose = fit.first_from_second * map_from_grid.inverse();
        format!("at {} agree {}", pose_text(pose), fit_text(fit))
    };
    match failure {
        MatchFailure::NoWall(which) => {
            let file = if which == 0 { first } else { second };
            format!("{file}: the map has no wall, expected occupied cells beside free ones")
        }
        MatchFailure::NothingFits(best) => format!(
            "{second}: no pose of this map fits {first}: of the compared walls {}, expected {:.0} % and {MIN_AGREEING_M} m or more; do both maps show one \
             place? Give its pose X,Y,DEG in the other map (m, m, deg)",
            at(&best),
            100.0 * MIN_AGREEING_SHARE
        ),
        MatchFailure::Ambiguous(MapMatch { best, rival }) => format!(
            "{second}: several poses of this map fit {first}: of the compared walls {}; {}; give its pose X,Y,DEG in the other map (m, m, \
             deg)",
            at(&best),
            rival.as_ref().map_or_else(String::new, at)
        ),
    }
}
