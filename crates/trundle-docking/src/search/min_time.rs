//! Minimum time over all sequences of turns in place and straight moves.

use crate::certificate::{Certificate, SearchLimit};
use crate::connectivity_proof::proof::{Connectivity, ProofGrid, test_connectivity};
use crate::connectivity_proof::time_estimate::TimeEstimate;
use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::lower_bound::branch_and_bound::improve;
use crate::scene::blocker::Blocker;
use crate::search::beam::{beam, guided_beam};
use crate::search::leg_search::LegSearch;
use crate::search::polish::polish;
use crate::search::rays::rays;
use crate::search::shorten::shorten;
use crate::search::trace::trace;

/// Legs and their time, s.
pub type Timed = (f64, Legs);

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub enum LegOutcome {
    /// Legs, and their time, s.
    Found(Timed),
    /// No motion of any kind exists, or none at the requested resolution; with the blocking obstacle.
    Disconnected(Certificate, Option<Blocker>),
    /// No manoeuvre was found before this limit, although the cells connect start and goal.
    Nothing(SearchLimit),
}

/// Effort of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Number of nodes of the search for many legs.
    pub nodes: usize,
    /// Number of boxes of the branch and bound.
    pub boxes: usize,
    /// Relative gap between time and bound.
    pub gap: f64,
    /// Side of the certificate's finest cells, m.
    pub cell: f64,
    /// Cost limit of the search for many legs, in units of [`ContactSpace::work`].
    pub work: u64,
}

/// Sides of the certificate's cells, in units of the finest: coarse cells often suffice. Source: ours.
const CELL_SIDES: [f64; 4] = [8.0, 4.0, 2.0, 1.0];
/// Half side of the region, in finest cells, above which cells twice as large lead the search. Source: ours.
const WIDE_REGION_CELLS: f64 = 220.0;
/// Number of headings tried at start and goal. Source: ours.
const END_HEADINGS: usize = 120;
/// Smallest difference of these headings, rad: 0.3 deg. Source: ours.
const MIN_HEADING_STEP_RAD: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// Cost limit of the search for one or two legs, and of improving known legs, in units of [`ContactSpace::work`]. Source: ours.
const SHORT_SEARCH_WORK: u64 = 2_000_000;

/// Whether the whole plan has a small cost limit.
fn has_small_budget(space: &ContactSpace<'_>) -> bool {
    space.max() < 5 * SHORT_SEARCH_WORK
}

/// Cost limit of a short search; reduced if the limit of the whole plan is less than a few times this limit.
fn short_search_work(space: &ContactSpace<'_>) -> u64 {
    SHORT_SEARCH_WORK.min(space.max() / 8)
}

/// The best sampled one or two legs, polished.
pub async fn one_or_two(query: DockingQuery, space: &mut ContactSpace<'_>) -> Option<Timed> {
    let limit = space.until(short_search_work(space));
    if space.work() >= limit {
        return None;
    }
    let mut search = LegSearch::new(query, space, (END_HEADINGS, MIN_HEADING_STEP_RAD), limit).await;
    let mut fan = Vec::new();
    rays(&query, search.space, &query.start, END_HEADINGS, MIN_HEADING_STEP_RAD, &mut fan).await;
    search.complete(&query.start, &fan, &[], 0.0).await;
    polish_best(&mut search).await;
    search.best
}

/// Improves legs, and computes a lower bound of the time (s).
pub async fn improve_legs(
    query: DockingQuery,
    space: &mut ContactSpace<'_>,
    best: Timed,
    effort: Effort,
) -> (Timed, f64) {
    let limit = space.until(short_search_work(space));
    let bounded = improve(&query, space, Some(best.clone()), effort.gap, (effort.boxes, limit)).await;
    let bound = |(time, _): &Timed| bounded.bound.min(*time);
    if space.until(1) <= space.work() {
        let best = bounded.best.unwrap_or(best);
        return (best.clone(), bound(&best));
    }
    let mut search = LegSearch::new(query, space, (END_HEADINGS, MIN_HEADING_STEP_RAD), 0).await;
    search.limit = search.space.until(short_search_work(search.space));
    search.best = bounded.best;
    polish_best(&mut search).await;
    if bounded.bound < search.time_to_beat() * (1.0 - MIN_WORTHWHILE_GAP.max(effort.gap)) && effort.nodes > 0
    {
        beam(&mut search, BEAM_WIDTH, effort.nodes).await;
        polish_best(&mut search).await;
    }
    let best = search.best.unwrap_or(best);
    let bound = bound(&best);
    (best, bound)
}

/// Lower bound of the time of any legs, s, at most `known`: boxes are split until the bound is within `gap` of `known`, at most `boxes`.
pub async fn bound(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    known: f64,
    gap: f64,
    boxes: usize,
) -> f64 {
    improve(query, space, Some((known, Legs::default())), gap, (boxes, space.until(u64::MAX))).await.bound
}

/// Width of the beam that searches better legs. Source: ours.
const BEAM_WIDTH: usize = 24;
/// Width of the guided beam. Source: ours.
const GUIDED_BEAM_WIDTH: usize = 12;
/// Width of the guided beam with a small cost limit. Source: ours.
const NARROW_GUIDED_BEAM_WIDTH: usize = 5;
/// Time beyond the start that the time estimate covers, s. Source: ours.
const ESTIMATE_BEYOND_START_S: f64 = 3.0;
/// Time beyond the start that the time estimate covers with a small cost limit, s. Source: ours.
const SHORT_ESTIMATE_BEYOND_START_S: f64 = 0.5;
/// Relative gap above which more legs are searched. Source: ours.
const MIN_WORTHWHILE_GAP: f64 = 0.05;

/// Searches legs if one or two do not suffice, or proves their impossibility.
pub async fn many(query: DockingQuery, space: &mut ContactSpace<'_>, effort: Effort) -> LegOutcome {
    let limit = space.until(effort.work);
    if space.work() >= limit {
        return LegOutcome::Nothing(SearchLimit::MaxWork);
    }
    let mut second = space.clone();
    let mut search = LegSearch::new(query, space, (END_HEADINGS, MIN_HEADING_STEP_RAD), limit).await;
    // A proof of no connection costs as much as a time estimate: coarse cells first, for both.
    let leading = if query.half() > WIDE_REGION_CELLS * effort.cell { CELL_SIDES[1] } else { CELL_SIDES[2] };
    for side in CELL_SIDES {
        let size = side * effort.cell;
        if let Some(never) = apart(&query, &second, size, true, limit).await {
            return never;
        }
        if side == CELL_SIDES[3]
            && let Some(outcome) = apart(&query, &second, size, false, limit).await
        {
            return outcome;
        }
        if side <= leading {
            led_by_cells(&mut search, &mut second, size, effort.nodes).await;
        }
        if search.best.is_some() {
            shorten_best(&mut search).await;
            break;
        }
        if search.is_spent() {
            break;
        }
    }
    let ended_by = if search.is_spent() { SearchLimit::MaxWork } else { SearchLimit::SearchNodes };
    search.best.map_or(LegOutcome::Nothing(ended_by), LegOutcome::Found)
}

/// Whether coarse cells prove that no motion of any kind leads to the goal.
pub async fn never(query: &DockingQuery, space: &ContactSpace<'_>, effort: Effort) -> Option<LegOutcome> {
    let limit = space.until(effort.work);
    for side in &CELL_SIDES[..2] {
        let never = apart(query, space, side * effort.cell, true, limit).await;
        if never.is_some() {
            return never;
        }
    }
    None
}

/// Connectivity test with cells of `side` (m), with the hull shrunk for a proof or unchanged.
async fn apart(
    query: &DockingQuery,
    space: &ContactSpace<'_>,
    side: f64,
    shrunk: bool,
    limit: u64,
) -> Option<LegOutcome> {
    let grid = ProofGrid { center: query.center(), half: query.half(), side, shrunk, limit };
    match test_connectivity(space, &query.start, &query.goal, grid).await {
        Connectivity::Disconnected { by } => {
            let certificate = if shrunk { Certificate::Never } else { Certificate::AtResolution };
            Some(LegOutcome::Disconnected(certificate, by))
        }
        Connectivity::Connected => None,
    }
}

/// A beam search with the time estimate over cells of `side` (m); if it does not reach the goal, legs along the cells' path.
async fn led_by_cells<'a>(
    search: &mut LegSearch<'_, 'a>,
    second: &mut ContactSpace<'a>,
    side: f64,
    nodes: usize,
) {
    let query = search.query;
    let (center, half, speed) = (query.center(), query.half(), query.limits.speed);
    let beyond =
        if has_small_budget(search.space) { SHORT_ESTIMATE_BEYOND_START_S } else { ESTIMATE_BEYOND_START_S };
    let until = (&query.start, beyond, search.limit);
    let mut guide = TimeEstimate::new(second, &query.goal, center, half, side, speed, until).await;
    if nodes == 0 || guide.seconds(&query.start).is_infinite() {
        return;
    }
    let width = if has_small_budget(search.space) { NARROW_GUIDED_BEAM_WIDTH } else { GUIDED_BEAM_WIDTH };
    guided_beam(search, &mut guide, width, nodes).await;
    if search.best.is_none() {
        let mut poses = guide.path(&query.start);
        poses.push(query.goal);
        search.best = trace(&query, search.space, &poses, search.limit).await;
    }
}

async fn shorten_best(search: &mut LegSearch<'_, '_>) {
    if let Some(best) = search.best.take() {
        search.best = Some(shorten(&search.query, search.space, best, search.limit).await);
    }
    polish_best(search).await;
}

async fn polish_best(search: &mut LegSearch<'_, '_>) {
    let limit = search.limit.max(search.space.until(short_search_work(search.space)));
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.query, search.space, legs, *time, limit).await);
    }
}
