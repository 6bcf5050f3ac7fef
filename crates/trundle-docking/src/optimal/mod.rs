//! Least time over all sequences of turns on the spot and straight moves.

mod beam;
mod connect;
mod legs;
mod polish;
mod rays;
mod search;
mod shorten;
mod task;
mod trace;

pub use legs::Legs;
pub use task::Task;

use crate::bound::improve;
use crate::flood::{Ground, Guide, Proof, disprove};
use crate::plan::Limit;
use crate::scene::Blocker;
use crate::space::Space;
use beam::{beam, guided_beam};
use polish::polish;
use rays::rays;
use search::Search;
use shorten::shorten;
use trace::trace;

/// Legs and their time, s.
pub type Timed = (f64, Legs);

/// What a search came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// These legs, and their time, s.
    Found(Timed),
    /// There is no motion of any kind, or none at the resolution asked for; this forbids it.
    Apart(Certificate, Option<Blocker>),
    /// Nothing was found with the effort allowed, which this ended, though start and goal hang together as far as the cells tell.
    Nothing(Limit),
}

/// What was shown when there is no manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Certificate {
    /// No motion of any kind leads from start to goal: a proof over all poses within reach.
    Never,
    /// None does through the middles of cells of the asked side, with headings exact: complete at that resolution.
    AtResolution,
    /// None was found with the effort allowed: no certificate.
    None,
}

/// How much to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Nodes of the search for many legs.
    pub nodes: usize,
    /// Boxes of the search for a bound.
    pub boxes: usize,
    /// Part of the time that the bound may be below it.
    pub gap: f64,
    /// Side of the certificate's finest cells, m.
    pub cell: f64,
    /// What the search for many legs may cost, in units of [`Space::work`].
    pub work: u64,
}

/// Sides of the cells of the certificate, in units of the finest: coarse ones often do.
const CELLS: [f64; 4] = [8.0, 4.0, 2.0, 1.0];
/// Half a square of more cells than this is searched by cells twice as large.
const WIDE: f64 = 220.0;
/// Headings tried at start and goal, and how close they may be, rad.
const FAN: (usize, f64) = (120, 0.3 * std::f64::consts::PI / 180.0);
/// What one or two legs may cost, and what it may cost to better legs that are known.
const LITTLE: u64 = 2_000_000;

/// Whether a whole plan may cost but little.
fn is_scanty(space: &Space<'_>) -> bool {
    space.most() < 5 * LITTLE
}

/// What one or two legs may cost, less where a whole plan may cost no more than a few times that.
fn little(space: &Space<'_>) -> u64 {
    LITTLE.min(space.most() / 8)
}

/// The best of the sampled one or two legs, polished.
pub async fn one_or_two(task: Task, space: &mut Space<'_>) -> Option<Timed> {
    let limit = space.until(little(space));
    if space.work() >= limit {
        return None;
    }
    let mut search = Search::new(task, space, FAN, limit).await;
    let mut fan = Vec::new();
    rays(&task, search.space, &task.start, FAN.0, FAN.1, &mut fan).await;
    search.complete(&task.start, &fan, &[], 0.0).await;
    polish_best(&mut search).await;
    search.best
}

/// Betters legs, and finds a time that none beat (s).
pub async fn better(task: Task, space: &mut Space<'_>, best: Timed, effort: Effort) -> (Timed, f64) {
    let limit = space.until(little(space));
    let bounded = improve(&task, space, Some(best.clone()), effort.gap, (effort.boxes, limit)).await;
    let bound = |(time, _): &Timed| bounded.bound.min(*time);
    if space.until(1) <= space.work() {
        let best = bounded.best.unwrap_or(best);
        return (best.clone(), bound(&best));
    }
    let mut search = Search::new(task, space, FAN, 0).await;
    search.limit = search.space.until(little(search.space));
    search.best = bounded.best;
    polish_best(&mut search).await;
    if bounded.bound < search.time_to_beat() * (1.0 - LOOSE.max(effort.gap)) && effort.nodes > 0 {
        beam(&mut search, BEAM, effort.nodes).await;
        polish_best(&mut search).await;
    }
    let best = search.best.unwrap_or(best);
    let bound = bound(&best);
    (best, bound)
}

/// A time that no legs beat, s, at most `known`: boxes are split until it is within `gap` of that, at most `boxes` of them.
pub async fn bound(task: &Task, space: &mut Space<'_>, known: f64, gap: f64, boxes: usize) -> f64 {
    improve(task, space, Some((known, Legs::default())), gap, (boxes, space.until(u64::MAX))).await.bound
}

/// Width of the beam that looks for better legs.
const BEAM: usize = 24;
/// Width of the beam where the guide knows the way, and where a plan may cost but little.
const GUIDED_BEAM: (usize, usize) = (12, 5);
/// How much farther than the start a guide reaches, s, and the same where a plan may cost but little.
const BEYOND: (f64, f64) = (3.0, 0.5);
/// A gap at which it is worth while to look for more legs.
const LOOSE: f64 = 0.05;

/// Looks for legs where one or two do not do, or shows that there are none. With less effort than is needed for either:
/// nothing.
pub async fn many(task: Task, space: &mut Space<'_>, effort: Effort) -> Outcome {
    let limit = space.until(effort.work);
    if space.work() >= limit {
        return Outcome::Nothing(Limit::MostWork);
    }
    let mut second = space.clone();
    let mut search = Search::new(task, space, FAN, limit).await;
    // A flood that shows that there is no way is as cheap as one that shows where it leads: coarse cells first, for both.
    let leading = if task.half() > WIDE * effort.cell { CELLS[1] } else { CELLS[2] };
    for side in CELLS {
        let size = side * effort.cell;
        if let Some(never) = apart(&task, &second, size, true, limit).await {
            return never;
        }
        if side == CELLS[3]
            && let Some(outcome) = apart(&task, &second, size, false, limit).await
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
    let ended_by = if search.is_spent() { Limit::MostWork } else { Limit::SearchNodes };
    search.best.map_or(Outcome::Nothing(ended_by), Outcome::Found)
}

/// Whether coarse cells show that no motion of any kind leads to the goal.
pub async fn never(task: &Task, space: &Space<'_>, effort: Effort) -> Option<Outcome> {
    let limit = space.until(effort.work);
    for side in &CELLS[..2] {
        let never = apart(task, space, side * effort.cell, true, limit).await;
        if never.is_some() {
            return never;
        }
    }
    None
}

/// What cells of `side` (m) say against any motion, with the hull shrunk for a proof or as it is.
async fn apart(task: &Task, space: &Space<'_>, side: f64, shrunk: bool, limit: u64) -> Option<Outcome> {
    let ground = Ground { center: task.center(), half: task.half(), side, shrunk, limit };
    match disprove(space, &task.start, &task.goal, ground).await {
        Proof::Apart { by } => {
            let certificate = if shrunk { Certificate::Never } else { Certificate::AtResolution };
            Some(Outcome::Apart(certificate, by))
        }
        Proof::Together => None,
    }
}

/// A beam led by how cells of `side` (m) hang together; where that does not get through, legs along the cells' own path.
async fn led_by_cells<'a>(search: &mut Search<'_, 'a>, second: &mut Space<'a>, side: f64, nodes: usize) {
    let task = search.task;
    let (center, half, speed) = (task.center(), task.half(), task.limits.speed);
    let beyond = if is_scanty(search.space) { BEYOND.1 } else { BEYOND.0 };
    let until = (&task.start, beyond, search.limit);
    let mut guide = Guide::new(second, &task.goal, center, half, side, speed, until).await;
    if nodes == 0 || guide.seconds(&task.start).is_infinite() {
        return;
    }
    let width = if is_scanty(search.space) { GUIDED_BEAM.1 } else { GUIDED_BEAM.0 };
    guided_beam(search, &mut guide, width, nodes).await;
    if search.best.is_none() {
        let mut poses = guide.path(&task.start);
        poses.push(task.goal);
        search.best = trace(&task, search.space, &poses, search.limit).await;
    }
}

async fn shorten_best(search: &mut Search<'_, '_>) {
    if let Some(best) = search.best.take() {
        search.best = Some(shorten(&search.task, search.space, best, search.limit).await);
    }
    polish_best(search).await;
}

async fn polish_best(search: &mut Search<'_, '_>) {
    let limit = search.limit.max(search.space.until(little(search.space)));
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.task, search.space, legs, *time, limit).await);
    }
}
