//! Certificates, and limits of a search.
/// Proof of the absence of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Certificate {
    /// No motion of any kind leads from start to goal: a proof over all poses within reach.
    Never,
    /// No motion leads through the centres of cells of the requested side, with exact headings: complete at that resolution.
    AtResolution,
    /// No manoeuvre was found with the effort allowed: no certificate.
    None,
}

/// The setting of [`crate::DockingConfig`] that ended a search without a manoeuvre and without a proof of its impossibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SearchLimit {
    /// `search_nodes`: the number of expanded nodes.
    SearchNodes,
    /// `max_work`: the cost of the search for many motions.
    MaxWork,
    /// `plan_work`: the cost of the whole plan.
    PlanWork,
    /// `points_work`: the cost of the whole plan among many points.
    PointsWork,
}

impl SearchLimit {
    /// The setting's name.
    pub fn setting(self) -> &'static str {
        match self {
            Self::SearchNodes => "search_nodes",
            Self::MaxWork => "max_work",
            Self::PlanWork => "plan_work",
            Self::PointsWork => "points_work",
        }
    }
}
