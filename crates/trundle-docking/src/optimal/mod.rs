//! Least time over all sequences of turns on the spot and straight moves.

mod beam;
mod legs;
mod polish;
mod rays;
mod search;
mod task;

pub use legs::Legs;
pub use task::Task;

use crate::flood::{Guide, Proof, disprove};
use crate::scene::Blocker;
use crate::space::Space;
use beam::beam;
use polish::polish;
use rays::rays;
use search::Search;

/// Legs and their time, s.
pub type Timed = (f64, Legs);

/// What a search came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// These legs.
    Found(Timed),
    /// There is no motion of any kind; this forbids it.
    Apart(Option<Blocker>),
    /// Nothing was found with the effort allowed, though start and goal hang together as far as the cells tell.
    Nothing,
}

/// Sides of the cells of the certificate, in units of the finest: coarse ones often do.
const CELLS: [f64; 3] = [4.0, 2.0, 1.0];

/// The best legs found with about `nodes` expanded nodes at most; cells of `cell` (m) certify that there are none.
pub fn find(task: Task, space: &mut Space<'_>, nodes: usize, cell: f64) -> Outcome {
    let mut second = space.clone();
    let mut search = Search::new(task, space, 120, 1_f64.to_radians());
    let mut fan = Vec::new();
    rays(&task, search.space, &task.start, 120, 1_f64.to_radians(), &mut fan);
    search.complete(&task.start, &fan, &[], 0.0);
    polish_best(&mut search);
    let (center, half) = (task.center(), task.half());
    if search.best.is_none() {
        if let Proof::Apart { by } =
            disprove(search.space, &task.start, &task.goal, center, half, CELLS[0] * cell)
        {
            return Outcome::Apart(by);
        }
    }
    let mut width = 48;
    let mut spent = beam(&mut search, width, 0.02, 0.06).expanded;
    if search.best.is_none() {
        for side in &CELLS[1..] {
            if let Proof::Apart { by } =
                disprove(search.space, &task.start, &task.goal, center, half, side * cell)
            {
                return Outcome::Apart(by);
            }
        }
        width = 24;
        search.guide = Some(Guide::new(&mut second, &task.goal, center, half, 2.0 * cell, task.limits.speed));
    }
    while search.best.is_none() && spent < nodes {
        let end = beam(&mut search, width, 0.02, 0.06);
        spent += end.expanded;
        if end.whole {
            break;
        }
        width *= 4;
    }
    polish_best(&mut search);
    search.best.map_or(Outcome::Nothing, Outcome::Found)
}

fn polish_best(search: &mut Search<'_, '_>) {
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.task, search.space, legs, *time));
    }
}
