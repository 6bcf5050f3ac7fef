use super::legs::Legs;
use super::rays::rays;
use super::search::Search;
use super::task::Task;
use crate::space::Space;
use trundle_core::Pose2;

/// Headings tried at either end.
const HEADINGS: usize = 24;
/// Headings are not closer than this, rad.
const FINEST: f64 = 2e-3;

/// The fastest of the sampled ways from one pose to another by a turn alone or by one or two legs, and its time, s; `None`
/// when none of them is free.
pub async fn connect(task: &Task, space: &mut Space<'_>, from: &Pose2, to: &Pose2) -> Option<(f64, Legs)> {
    let part = Task { start: *from, goal: *to, ..*task };
    if from.distance(to) < 1e-9 {
        let (time, _) = Legs::default().motions(&part, space)?;
        return Some((time, Legs::default()));
    }
    let mut fan = Vec::new();
    rays(&part, space, from, HEADINGS, FINEST, &mut fan).await;
    let mut search = Search::new(part, space, (HEADINGS, FINEST), u64::MAX).await;
    search.complete(from, &fan, &[], 0.0).await;
    search.best.filter(|(_, legs)| legs.corners(from).all(|p| task.in_region(p)))
}
