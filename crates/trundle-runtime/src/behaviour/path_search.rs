//! The search for a path: observations and attempts since the last plan.

mod seek_viewpoint;
pub(crate) mod viewpoint;

use super::spin::Spin;
use trundle_core::{Stamp, Vector2};
use viewpoint::Viewpoint;

/// Data of the search for a path, shared by planning, waiting and recovering. A plan ends the search.
#[derive(Debug, Clone, Default)]
pub(crate) struct PathSearch {
    /// Stamp of the first stop of this search.
    pub(crate) held_since: Option<Stamp>,
    /// Stamp of the first plan without a path.
    pub(crate) no_path_since: Option<Stamp>,
    /// Place where the path to the goal is blocked.
    pub(crate) blocked_at: Option<Vector2>,
    /// Length of the best path over unseen floor \[m\], while this floor is observed first; `None` without such a path.
    pub(crate) rest_over_unseen_floor: Option<f64>,
    pub(crate) viewpoint: Viewpoint,
    /// The turns on the spot that observed the surroundings.
    pub(crate) spin: Spin,
}

impl PathSearch {
    /// A search that begins with a stop.
    pub(crate) fn held(now: Stamp) -> Self {
        Self { held_since: Some(now), ..Self::default() }
    }
}
