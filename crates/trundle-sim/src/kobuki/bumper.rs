use crate::world::Obstacles;
use trundle_core::{Footprint, Pose2};

/// A touch ends when the gap is wider than this, m.
const RELEASE: f64 = 2e-3;

/// Keeps the body out of walls, and notes when it touches one.
#[derive(Debug)]
pub(super) struct Bumper {
    footprint: Footprint,
    /// The body can move this far, m, before anything can be touched: saves measuring at every step.
    free_way: f64,
    is_pressed: bool,
    contacts: u32,
}

impl Bumper {
    /// Of a round body of this radius, m.
    pub(super) fn new(radius: f64) -> Self {
        Self { footprint: Footprint::Disc { radius }, free_way: 0.0, is_pressed: false, contacts: 0 }
    }

    /// Where the body ends that wants to go from `from` to `to`, and the bumper's state when it changed.
    ///
    /// A move into a wall does not happen (the wheels slip); the turn in it does when there is room for it.
    pub(super) fn resolve(&mut self, from: Pose2, to: Pose2, obstacles: &Obstacles) -> (Pose2, Option<bool>) {
        let turn = trundle_core::difference_of_angles(to.theta, from.theta).abs();
        let moved = from.distance(&to) + turn * self.footprint.circumscribed_radius();
        if !self.is_pressed && self.free_way > moved + RELEASE {
            self.free_way -= moved;
            return (to, None);
        }
        self.free_way = obstacles.clearance(&self.footprint, to);
        if self.free_way > 0.0 {
            let released = self.is_pressed && self.free_way > RELEASE;
            self.is_pressed &= !released;
            return (to, released.then_some(false));
        }
        self.free_way = 0.0;
        let turned = Pose2::new(from.x, from.y, to.theta);
        let stays = if obstacles.clearance(&self.footprint, turned) > 0.0 { turned } else { from };
        let is_new = !self.is_pressed;
        self.is_pressed = true;
        self.contacts += u32::from(is_new);
        (stays, is_new.then_some(true))
    }

    /// How often a touch began.
    pub(super) fn contacts(&self) -> u32 {
        self.contacts
    }
}
