//! The bumper: contact of the body with the world, and the touch event.

use super::contact_scene::ContactScene;
use trundle_core::{Footprint, Pose2};

/// A touch ends when the gap is wider than this, m. Source: ours.
const RELEASE_GAP_M: f64 = 2e-3;

/// Keeps the body out of fixed obstacles and people, and records contacts.
#[derive(Debug)]
pub(super) struct Bumper {
    footprint: Footprint,
    /// Metres from the origin to the farthest point of the body.
    reach: f64,
    /// Distance that the body can move without a contact with a fixed obstacle, m: saves the test in each step.
    free_way: f64,
    is_pressed: bool,
    contacts: u32,
}

impl Bumper {
    pub(super) fn new(footprint: Footprint) -> Self {
        let reach = footprint.circumscribed_radius();
        Self { footprint, reach, free_way: 0.0, is_pressed: false, contacts: 0 }
    }

    /// End of a motion of the body from `from` to `to` at the first contact, and the bumper's state when it changed.
    ///
    /// A move into an obstacle is blocked (the wheels slip); its turn is carried out if space allows.
    pub(super) fn resolve(
        &mut self,
        from: Pose2,
        to: Pose2,
        around: &ContactScene<'_>,
    ) -> (Pose2, Option<bool>) {
        let turn = trundle_core::difference_of_angles(to.theta, from.theta).abs();
        self.free_way -= from.distance(&to) + turn * self.reach;
        let gap = self.gap(to, around);
        if gap > 0.0 {
            let is_released = self.is_pressed && gap > RELEASE_GAP_M;
            self.is_pressed &= !is_released;
            return (to, is_released.then_some(false));
        }
        self.free_way = 0.0;
        let turned = Pose2::new(from.x, from.y, to.theta);
        let stays = if self.gap(turned, around) > 0.0 { turned } else { from };
        self.free_way = 0.0;
        let is_new = !self.is_pressed;
        self.is_pressed = true;
        self.contacts += u32::from(is_new);
        (stays, is_new.then_some(true))
    }

    /// Discards the stored distance: the body was moved to another place.
    pub(super) fn lift(&mut self) {
        self.free_way = 0.0;
    }

    /// Number of separate contacts.
    pub(super) fn contacts(&self) -> u32 {
        self.contacts
    }

    pub(super) fn footprint(&self) -> &Footprint {
        &self.footprint
    }

    /// Distance to the nearest obstacle at `pose`, m, exact while it is small; static obstacles are measured only if they may be near.
    fn gap(&mut self, pose: Pose2, around: &ContactScene<'_>) -> f64 {
        if self.free_way <= RELEASE_GAP_M {
            self.free_way = around.fixed.clearance(&self.footprint, pose);
        }
        self.free_way.min(around.moving.clearance(&self.footprint, pose))
    }
}
