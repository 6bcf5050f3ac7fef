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
    /// These legs, their time and a time that none beat, s.
    Found(Timed, f64),
    /// There is no motion of any kind, or none at the resolution asked for; this forbids it.
    Apart(Certificate, Option<Blocker>),
    /// Nothing was found with the effort allowed, though start and goal hang together as far as the cells tell.
    Nothing,
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
}

/// Sides of the cells of the certificate, in units of the finest: coarse ones often do.
const CELLS: [f64; 3] = [4.0, 2.0, 1.0];

/// The best legs found, or why there are none.
pub fn find(task: Task, space: &mut Space<'_>, effort: Effort) -> Outcome {
    let mut second = space.clone();
    let mut search = Search::new(task, space, 120, 0.3_f64.to_radians());
    let mut fan = Vec::new();
    rays(&task, search.space, &task.start, 120, 0.3_f64.to_radians(), &mut fan);
    search.complete(&task.start, &fan, &[], 0.0);
    polish_best(&mut search);
    if search.best.is_none()
        && let Some(outcome) = hard(&mut search, &mut second, effort)
    {
        return outcome;
    }
    let Some(best) = search.best.take() else { return Outcome::Nothing };
    let bounded = improve(&task, search.space, Some(best), effort.gap, effort.boxes);
    search.best = bounded.best;
    polish_best(&mut search);
    if bounded.bound < search.time_to_beat() * (1.0 - LOOSE.max(effort.gap)) && effort.nodes > 0 {
        beam(&mut search, BEAM, effort.nodes);
        polish_best(&mut search);
    }
    let time = search.time_to_beat();
    search.best.map_or(Outcome::Nothing, |best| Outcome::Found(best, bounded.bound.min(time)))
}

/// A time that no legs beat, s, at most `known`: boxes are split until it is within `gap` of that, at most `boxes` of them.
pub fn bound(task: &Task, space: &mut Space<'_>, known: f64, gap: f64, boxes: usize) -> f64 {
    improve(task, space, Some((known, Legs::default())), gap, boxes).bound
}

/// Width of the beam that looks for better legs.
const BEAM: usize = 24;
/// Width of the beam where the guide knows the way.
const GUIDED_BEAM: usize = 12;
/// A gap at which it is worth while to look for more legs.
const LOOSE: f64 = 0.05;

/// Looks for legs where one or two do not do; `Some` when it is proven that there are none.
fn hard<'a>(search: &mut Search<'_, 'a>, second: &mut Space<'a>, effort: Effort) -> Option<Outcome> {
    // Beams are for what one or two legs do not do: cells first, they are cheap and often enough.
    let task = search.task;
    if let Some(never) = CELLS.iter().find_map(|side| apart(&task, search.space, side * effort.cell, true)) {
        return Some(never);
    }
    let coarse = second.clone();
    for side in [2.0, 1.0] {
        led_by_cells(search, second, side * effort.cell, effort.nodes);
        if search.best.is_some() {
            break;
        }
        if side > 1.0
            && let Some(outcome) = apart(&task, &coarse, effort.cell, false)
        {
            return Some(outcome);
        }
    }
    if let Some(best) = search.best.take() {
        search.best = Some(shorten(&task, search.space, best));
    }
    polish_best(search);
    None
}

/// What cells of `side` (m) say against any motion, with the hull shrunk for a proof or as it is.
fn apart(task: &Task, space: &Space<'_>, side: f64, shrunk: bool) -> Option<Outcome> {
    let ground = Ground { center: task.center(), half: task.half(), side, shrunk };
    match disprove(space, &task.start, &task.goal, ground) {
        Proof::Apart { by } => {
            let certificate = if shrunk { Certificate::Never } else { Certificate::AtResolution };
            Some(Outcome::Apart(certificate, by))
        }
        Proof::Together => None,
    }
}

/// A beam led by how cells of `side` (m) hang together; where that does not get through, legs along the cells' own path.
fn led_by_cells<'a>(search: &mut Search<'_, 'a>, second: &mut Space<'a>, side: f64, nodes: usize) {
    let task = search.task;
    let mut guide = Guide::new(second, &task.goal, task.center(), task.half(), side, task.limits.speed);
    if nodes == 0 || guide.seconds(&task.start).is_infinite() {
        return;
    }
    guided_beam(search, &mut guide, GUIDED_BEAM, nodes);
    if search.best.is_none() {
        let mut poses = guide.path(&task.start);
        poses.push(task.goal);
        search.best = trace(&task, search.space, &poses);
    }
}

fn polish_best(search: &mut Search<'_, '_>) {
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.task, search.space, legs, *time));
    }
}
