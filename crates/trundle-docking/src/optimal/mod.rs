//! Least time over all sequences of turns on the spot and straight moves.

mod beam;
mod legs;
mod polish;
mod rays;
mod search;
mod task;

pub use legs::Legs;
pub use task::Task;

use crate::space::Space;
use beam::beam;
use polish::polish;
use rays::rays;
use search::Search;

/// Legs and their time, s.
pub type Timed = (f64, Legs);

/// The best legs found with at most about `nodes` expanded nodes.
pub fn find(task: Task, space: &mut Space<'_>, nodes: usize) -> Option<Timed> {
    let mut search = Search::new(task, space, 120, 1_f64.to_radians());
    let mut fan = Vec::new();
    rays(&task, search.space, &task.start, 120, 1_f64.to_radians(), &mut fan);
    search.complete(&task.start, &fan, &[], 0.0);
    polish_best(&mut search);
    let mut width = 48;
    let mut spent = 0;
    while spent < nodes {
        let end = beam(&mut search, width, 0.02, 0.06);
        polish_best(&mut search);
        spent += end.expanded;
        if end.whole || search.best.is_some() {
            break;
        }
        width *= 6;
    }
    search.best
}

fn polish_best(search: &mut Search<'_, '_>) {
    if let Some((time, legs)) = &search.best {
        search.best = Some(polish(&search.task, search.space, legs, *time));
    }
}
