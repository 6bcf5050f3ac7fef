//! Where to wait for a way that is barred: not against what bars it, where the camera is blind, and not out of its sight.

use super::{Navigator, Surroundings};
use std::f64::consts::TAU;
use trundle_control::{FollowPhase, FollowReport};
use trundle_core::{Cell, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::Plan;

/// The way to a place from where the robot sees what bars its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Vantage {
    /// None was looked for since the last plan.
    #[default]
    Unknown,
    /// On the way there.
    Going,
    /// There, or there is none.
    Settled,
}

/// From so far what bars the way is seen whole and well, m.
const GOOD: std::ops::RangeInclusive<f64> = 0.8..=2.5;
/// So far from it a place is looked for, m.
const AWAY: [f64; 2] = [1.2, 0.9];
/// Bearings of the places that are looked at.
const BEARINGS: usize = 16;
/// Of these the nearest are asked for a way there.
const MOST_PLANS: usize = 4;
/// A place in what bars the way is hidden by that itself, m; one before it is not.
const OWN_SIZE: f64 = 0.35;

impl Navigator {
    /// Whether it set out to a place from where it sees what bars the way; not when it stands at such a place.
    pub(super) fn sets_out_to_vantage(&mut self, s: &Surroundings<'_>) -> bool {
        let (Some(at), Vantage::Unknown) = (self.blocked_at, self.vantage) else { return false };
        self.vantage = Vantage::Settled;
        let here = s.estimate.pose;
        if GOOD.contains(&(at - here.position()).norm()) && is_in_sight(s.grid, here.position(), at) {
            return false;
        }
        for place in places(s.grid, here, at).into_iter().take(MOST_PLANS) {
            if let Plan::Found(plan) = self.planner.plan(s.floor(), here, Twist2::ZERO, place) {
                self.follower.follow(plan.trajectory, place);
                self.vantage = Vantage::Going;
                return true;
            }
        }
        false
    }

    /// Whether the robot has come to its place, or cannot.
    pub(super) fn has_come_to_vantage(&self, follow: &FollowReport) -> bool {
        let is_over = matches!(follow.phase, FollowPhase::Settled | FollowPhase::Idle);
        self.vantage == Vantage::Going && (is_over || follow.off_track)
    }
}

/// Places on the map's free floor that see `at`, the nearest to `here` first.
fn places(grid: &OccupancyGrid, here: Pose2, at: Vector2) -> Vec<Pose2> {
    let bearings = (0..BEARINGS).map(|i| TAU * i as f64 / BEARINGS as f64);
    let place = |(bearing, away): (f64, f64)| {
        let back = Vector2::new(bearing.cos(), bearing.sin());
        let stand = at - back * away;
        (grid.at(stand) == Cell::Free && is_in_sight(grid, stand, at))
            .then(|| Pose2::new(stand.x, stand.y, bearing))
    };
    let all = bearings.flat_map(|bearing| AWAY.map(|away| (bearing, away)));
    let mut places: Vec<Pose2> = all.filter_map(place).collect();
    places.sort_by(|a, b| a.distance(&here).total_cmp(&b.distance(&here)));
    places
}

/// Whether nothing on the map stands between, but for what bars the way at `at` itself.
fn is_in_sight(grid: &OccupancyGrid, from: Vector2, at: Vector2) -> bool {
    let (way, step) = (at - from, grid.geometry().resolution / 2.0);
    let own = if grid.at(at) == Cell::Free { 0.0 } else { OWN_SIZE };
    let clear = (way.norm() - own).max(0.0);
    let count = (clear / step) as usize;
    let mut points = (0..count).map(|i| from + way * (i as f64 * step / way.norm()));
    !points.any(|point| grid.at(point) == Cell::Occupied)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_see_what_bars_the_way_and_are_off_it() {
        // A wall with a door that somebody stands in.
        let rows = [".".repeat(40), "#".repeat(18) + "####" + &"#".repeat(18), ".".repeat(40)];
        let text =
            [vec![rows[0].clone(); 10], vec![rows[1].clone()], vec![rows[2].clone(); 30]].concat().join("\n");
        let grid = OccupancyGrid::from_ascii(0.1, &text).unwrap();
        let (here, at) = (Pose2::new(2.0, 2.6, 1.5), Vector2::new(2.0, 2.7));
        let places = places(&grid, here, at);
        assert!(!places.is_empty());
        for place in &places {
            let way = at - place.position();
            assert!(way.norm() > 0.8 && place.y < 2.9, "{place:?}");
            assert!((way.y.atan2(way.x) - place.theta).sin().abs() < 1e-9);
        }
        assert!(places[0].distance(&here) <= places[places.len() - 1].distance(&here));
    }
}
