//! A robot that does not know its place, and where its scans put it.

use super::Robot;
use crate::{navigator::position_sigma, whereabouts::Place};
use trundle_core::Scan;
use trundle_localization::{Correction, Localizer};

impl Robot {
    /// A scan of a laser that the robot sees by.
    pub(super) fn sweep(&mut self, scan: &Scan) {
        let odometer = self.odometry_at(scan.stamp());
        if let (Some(lookout), Some(odometer)) = (&mut self.lookout, odometer) {
            let place = lookout.seek(odometer.pose, scan, true, &mut self.times);
            self.note_place(place);
        }
        self.see(scan.clone());
    }

    /// A robot that does not know its place is where its scans fit the map alone; where that is still to be found, it is looked for.
    pub(super) fn note_place(&mut self, place: Option<Place>) {
        let is_lost = |localizer: &Localizer| position_sigma(&localizer.estimate()) >= self.lost_sigma;
        if let Some(Place { stamp, map_from_base, covariance }) = place
            && is_lost(&self.localizer)
        {
            match self.localizer.correct_scan(stamp, map_from_base, &covariance) {
                Correction::Applied { .. } => {
                    self.latest.unplaced = None;
                    self.lookout.iter_mut().for_each(|lookout| lookout.placed_by_scans());
                }
                // It is elsewhere than it was believed to be, however unsurely: the next scan tells where.
                _ => self.localizer.lose_place(),
            }
        }
        let is_lost = is_lost(&self.localizer);
        let Some(lookout) = &mut self.lookout else { return };
        match (is_lost, lookout.whereabouts.is_sought()) {
            (true, false) if self.mapper.is_redrawing() => {}
            (true, false) => lookout.whereabouts.seek(self.mapper.grid().clone()),
            (false, true) => lookout.whereabouts.end(),
            _ => {}
        }
    }
}
