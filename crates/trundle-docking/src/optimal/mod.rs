//! Least time over all sequences of turns on the spot and straight moves.

mod beam;
mod legs;
mod polish;
mod rays;
mod search;
mod task;

pub use legs::Legs;
pub use task::Task;

use crate::bound::improve;
use crate::flood::{Guide, Proof, disprove};
use crate::scene::Blocker;
use crate::space::Space;
use beam::{beam, guided_beam};
use polish::polish;
use rays::rays;
use search::Search;

/// Legs and their time, s.
pub type Timed = (f64, Legs);

/// What a search came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// These legs, their time and a time that none beat, s.
    Found(Timed, f64),
    /// There is no motion of any kind; this forbids it.
    Apart(Option<Blocker>),
    /// Nothing was found with the effort allowed, though start and goal hang together as far as the cells tell.
    Nothing,
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
        && let Some(by) = hard(&mut search, &mut second, effort)
    {
        return Outcome::Apart(by);
    }
    let Some(best) = search.best.take() else { return Outcome::Nothing };
    let bounded = improve(&task, search.space, Some(best), effort.gap, effort.boxes);
    search.best = bounded.best;
    polish_best(&mut search);
    if bounded.bound < search.time_to_beat() * (1.0 - LOOSE.max(effort.gap)) && effort.nodes > 0 {
        beam(&mut search, 24, 0.02, 0.06);
        polish_best(&mut search);
    }
    let time = search.time_to_beat();
    search.best.map_or(Outcome::Nothing, |best| Outcome::Found(best, bounded.bound.min(time)))
}

/// A time that no legs beat, s, at most `known`: boxes are split until it is within `gap` of that, at most `boxes` of them.
pub fn bound(task: &Task, space: &mut Space<'_>, known: f64, gap: f64, boxes: usize) -> f64 {
    improve(task, space, Some((known, Legs::default())), gap, boxes).bound
}

/// A gap at which it is worth while to look for more legs.
const LOOSE: f64 = 0.05;

/// Looks for legs where one or two do not do; `Some` when it is proven that there are none.
fn hard<'a>(search: &mut Search<'_, 'a>, second: &mut Space<'a>, effort: Effort) -> Option<Option<Blocker>> {
    // Beams are for what one or two legs do not do: cells first, they are cheap and often enough.
    let (task, center, half) = (search.task, search.task.center(), search.task.half());
    let apart = |search: &Search<'_, '_>, side: f64| match disprove(
        search.space,
        &task.start,
        &task.goal,
        center,
        half,
        side * effort.cell,
    ) {
        Proof::Apart { by } => Some(by),
        Proof::Together => None,
    };
    if let Some(by) = CELLS.iter().find_map(|side| apart(search, *side)) {
        return Some(by);
    }
    let mut guide = Guide::new(second, &task.goal, center, half, 2.0 * effort.cell, task.limits.speed);
    let (mut width, mut spent) = (12, 0);
    while search.best.is_none() && spent < effort.nodes {
        let end = guided_beam(search, &mut guide, width);
        spent += end.expanded;
        if end.whole {
            break;
        }
        width *= 4;
    }
    polish_best(search);
    None
}

fn polish_best(search: &mut Search<'_, '_>) {
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.task, search.space, legs, *time));
    }
}
