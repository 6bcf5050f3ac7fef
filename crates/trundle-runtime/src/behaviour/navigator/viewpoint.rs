//! Where to look from: at what bars a way, not against it, where the camera is blind, and not out of its sight; or at what a way
//! leads onto and was never seen.

use super::{
    Navigator, camera_fov::CameraFov, known_floor::is_in_sight, visibility_constraint::VisibilityConstraint,
};
use crate::behaviour::drive_state::DriveState;
use crate::world_state::WorldState;
use std::f64::consts::TAU;
use trundle_control::{FollowPhase, FollowReport};
use trundle_core::{Cell, OccupancyGrid, Pose2, Stamp, Trajectory, Twist2, Vector2, difference_of_angles};
use trundle_planning::Plan;

/// The way to a place from where the robot sees what it wants to see.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) enum Viewpoint {
    /// None was looked for since the last plan.
    #[default]
    Unknown,
    /// Places that a way is still to be asked for, the best last.
    Choosing(ViewTarget, Vec<Pose2>),
    /// On the way there.
    Going(ViewTarget, Trajectory),
    /// There, looking until then.
    Looking(Stamp),
    /// There, or there is none.
    Settled,
}

/// What is to be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ViewTarget {
    /// What blocks the path.
    Blockage,
    /// Floor that has not been observed.
    UnknownFloor,
}

/// From so far what bars the way is seen whole and well, m.
const GOOD: std::ops::RangeInclusive<f64> = 0.8..=2.5;
/// So far from it a place is looked for, m.
const AWAY: [f64; 2] = [1.2, 0.9];
/// Bearings of the places that are looked at.
const BEARINGS: usize = 16;
/// Of these the nearest are asked for a way there, one a step.
const MOST_PLANS: usize = 4;
/// A place in what bars the way is hidden by that itself, m; one before it is not.
const OWN_SIZE: f64 = 0.35;
/// So long it looks, s: several scans are drawn.
const LOOK: f64 = 1.0;

impl Navigator {
    /// Whether it is about to go to a place from where it sees what bars the way; not when it stands at such a place.
    pub(super) fn seeks_viewpoint(&mut self, s: &WorldState<'_>) -> bool {
        let Some(at) = self.blocked_at else { return false };
        if !matches!(
            self.viewpoint,
            Viewpoint::Choosing(ViewTarget::Blockage, _) | Viewpoint::Going(..) | Viewpoint::Settled
        ) {
            let here = s.estimate.pose;
            let own_size = if s.grid.at(at) == Cell::Free { 0.0 } else { OWN_SIZE };
            let stands_well = GOOD.contains(&(at - here.position()).norm())
                && is_in_sight(s.grid, here.position(), at, own_size);
            let places = if stands_well { Vec::new() } else { places(s.grid, here, at, own_size, self.view) };
            self.viewpoint = Viewpoint::Choosing(ViewTarget::Blockage, best_last(places));
        }
        self.sets_out(s)
    }

    /// The way leads onto floor at `at` that no image has shown: first it is looked at, from where it can be seen. Whether that is
    /// so; not when there is no such place, or it was looked at in vain.
    pub(super) fn seeks_sight_of(&mut self, at: Vector2, s: &WorldState<'_>) -> bool {
        match &self.viewpoint {
            Viewpoint::Going(..) => return true,
            Viewpoint::Looking(until) if s.now < *until => return true,
            Viewpoint::Choosing(ViewTarget::UnknownFloor, _) => {}
            _ => {
                let worth = self.unseen.is_worth_a_look(at);
                let places = if worth {
                    sights(s.floor(), s.estimate.pose, at, self.view, &self.unseen)
                } else {
                    Vec::new()
                };
                self.blocked_at = Some(at);
                self.viewpoint = Viewpoint::Choosing(ViewTarget::UnknownFloor, best_last(places));
            }
        }
        self.sets_out(s)
    }

    /// Asks for the way to one of the places to choose from; whether there is one, or another to be asked for.
    fn sets_out(&mut self, s: &WorldState<'_>) -> bool {
        let Viewpoint::Choosing(aim, places) = &mut self.viewpoint else {
            return self.is_at_viewpoint_or_going();
        };
        let aim = *aim;
        let Some(place) = places.pop() else {
            self.viewpoint = Viewpoint::Settled;
            return false;
        };
        if let Plan::Found(plan) = self.planner.plan(s.floor(), s.estimate.pose, Twist2::ZERO, place)
            && self.first_unseen(plan.trajectory.points(), s.floor()).is_none()
        {
            if let (ViewTarget::UnknownFloor, Some(at)) = (aim, self.blocked_at) {
                self.unseen.note_look(at, place.position(), s.now);
            }
            self.follower.follow(plan.trajectory.clone(), place);
            self.viewpoint = Viewpoint::Going(aim, plan.trajectory);
        }
        true
    }

    /// While it is on its way to look, or looks.
    fn is_at_viewpoint_or_going(&self) -> bool {
        matches!(self.viewpoint, Viewpoint::Going(..) | Viewpoint::Looking(_))
    }

    /// Whether a plan is to be asked for while it goes to look: what bars a way may go away, what was not seen may be seen.
    pub(super) fn looks_for_news(&self, s: &WorldState<'_>) -> bool {
        match &self.viewpoint {
            Viewpoint::Going(ViewTarget::UnknownFloor, _) => {
                self.blocked_at.is_none_or(|at| s.floor().at(at) != Cell::Unknown)
            }
            Viewpoint::Looking(until) => s.now >= *until,
            _ => true,
        }
    }

    /// At the end of the way to a place, or off it: it looks.
    pub(super) fn note_viewpoint(&mut self, follow: &FollowReport, now: Stamp) {
        let is_going = matches!(self.viewpoint, Viewpoint::Going(..));
        let is_over = matches!(follow.phase, FollowPhase::Settled | FollowPhase::Idle);
        if is_going && (is_over || follow.off_track) {
            self.look_from_here(now);
        }
    }

    /// Ends the way to a place where what it was to show by now is not seen, or something stands on it: the robot looks from where it is.
    pub(super) fn watch_path_to_viewpoint(&mut self, s: &WorldState<'_>) {
        let (Viewpoint::Going(_, way), Some(reference)) = (&self.viewpoint, self.follower.reference()) else {
            return;
        };
        if !self.is_still_good(way, reference.time, s) {
            self.look_from_here(s.now);
        }
    }

    /// The way to a place is over.
    fn look_from_here(&mut self, now: Stamp) {
        self.follower.halt();
        self.viewpoint = match self.viewpoint {
            Viewpoint::Going(ViewTarget::UnknownFloor, _) => {
                self.unseen.note_arrival(now);
                Viewpoint::Looking(now.after(LOOK))
            }
            _ => Viewpoint::Settled,
        };
    }

    /// Whether it stands still while it recovers: choosing where to look from, or looking.
    pub(super) fn looks_still(&self) -> bool {
        let recovers = matches!(self.state, DriveState::Recovering { .. });
        recovers && matches!(self.viewpoint, Viewpoint::Looking(_) | Viewpoint::Choosing(..))
    }
}

/// The nearest of these, the first to be asked for last.
fn best_last(mut places: Vec<Pose2>) -> Vec<Pose2> {
    places.truncate(MOST_PLANS);
    places.reverse();
    places
}

/// Places on the map's free floor that see `at`, but for the last `own_size` m, the nearest to `here` first.
fn places(
    grid: &OccupancyGrid,
    here: Pose2,
    at: Vector2,
    own_size: f64,
    view: Option<CameraFov>,
) -> Vec<Pose2> {
    let around = (0..BEARINGS).map(|i| TAU * i as f64 / BEARINGS as f64);
    let around =
        around.flat_map(|bearing| AWAY.map(|away| at - away * Vector2::new(bearing.cos(), bearing.sin())));
    let stands =
        around.filter(|stand| grid.at(*stand) == Cell::Free && is_in_sight(grid, *stand, at, own_size));
    let mut places: Vec<Pose2> = stands.map(|stand| facing(stand, at, view)).collect();
    places.sort_by(|a, b| a.distance(&here).total_cmp(&b.distance(&here)));
    places
}

/// Places that show the camera the floor at `at`, other than those from where it was looked at before: here, when turning is enough,
/// then the nearest.
fn sights(
    grid: &OccupancyGrid,
    here: Pose2,
    at: Vector2,
    view: Option<CameraFov>,
    unseen: &VisibilityConstraint,
) -> Vec<Pose2> {
    let Some(view) = view else { return Vec::new() };
    let turned = facing(here.position(), at, Some(view));
    let all = std::iter::once(turned).chain(places(grid, here, at, 0.0, Some(view)));
    let is_new = |place: &Pose2| unseen.is_elsewhere(at, place.position());
    all.filter(is_new).filter(|place| view.shows(grid, *place, at)).collect()
}

/// The pose at `stand` with `at` in the middle of the view.
fn facing(stand: Vector2, at: Vector2, view: Option<CameraFov>) -> Pose2 {
    let way = at - stand;
    let aside = view.map_or(0.0, |view| view.base_from_sector.theta);
    Pose2::new(stand.x, stand.y, difference_of_angles(way.y.atan2(way.x), aside))
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
        let places = places(&grid, here, at, 0.0, None);
        assert!(!places.is_empty());
        for place in &places {
            let way = at - place.position();
            assert!(way.norm() > 0.8 && place.y < 2.9, "{place:?}");
            assert!((way.y.atan2(way.x) - place.theta).sin().abs() < 1e-9);
        }
        assert!(places[0].distance(&here) <= places[places.len() - 1].distance(&here));
    }
}
