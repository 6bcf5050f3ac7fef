//! A robot that does not know its place, and where its scans put it.

use super::{MOTION_SEEN, Robot};
use crate::{map_watch::Fit, navigator::position_sigma, sight::Sight, whereabouts::Place};
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
                _ => self.localizer.set_pose_unknown(),
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

    /// Whether a scan may be of the place where the robot believes to be. Where images tell, they are believed; where none has for a
    /// while, a robot whose scans contradict the map must have been carried away.
    pub(super) fn is_of_this_place(&mut self, scan: &Scan) -> bool {
        let (now, watch) = (scan.stamp(), &mut self.latest.map_watch);
        if self.sight == Sight::Laser {
            return true;
        }
        if self.latest.located.is_some_and(|located| now - located <= MOTION_SEEN) {
            watch.forget();
            return true;
        }
        let Ok(pose) = self.localizer.pose_at(now) else { return true };
        let fit = watch.judge(self.mapper.grid(), pose, scan);
        if fit == Fit::Elsewhere {
            self.lose_place();
            self.lookout.iter_mut().for_each(|lookout| lookout.kidnapped());
        }
        fit == Fit::Fits
    }

    /// It was carried away.
    pub(super) fn lose_place(&mut self) {
        self.localizer.set_pose_unknown();
        self.latest.map_watch.forget();
        self.forget_traffic();
    }
}
