use trundle_core::{Pose2, Stamp, difference_of_angles};

/// Notes when the robot last got on.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ProgressWatch {
    last: Option<(Stamp, Pose2)>,
}

/// It has got on when it is so far from where it last had, m.
const STEP: f64 = 0.15;
/// Or when a turn to the goal's heading has come so far, rad. A turn that looks for a way does not count.
const TURN: f64 = 0.2;

impl ProgressWatch {
    /// Begins anew.
    pub(crate) fn restart(&mut self) {
        self.last = None;
    }

    /// How long the robot has not got on, s; `turns_count` where turning leads to the goal.
    pub(crate) fn standing_for(&mut self, now: Stamp, pose: Pose2, turns_count: bool) -> f64 {
        let got_on = self.last.is_none_or(|(_, at)| {
            at.distance(&pose) > STEP
                || turns_count && difference_of_angles(at.theta, pose.theta).abs() > TURN
        });
        if got_on {
            self.last = Some((now, pose));
        }
        self.last.map_or(0.0, |(since, _)| now - since)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_on_the_spot_is_no_progress_unless_it_is_the_way() {
        let mut watch = ProgressWatch::default();
        let at = |i: i32| (Stamp::default().after(f64::from(i)), Pose2::new(0.0, 0.0, f64::from(i)));
        let stood: Vec<f64> = (0..5).map(|i| watch.standing_for(at(i).0, at(i).1, false)).collect();
        assert_eq!(stood, [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(watch.standing_for(at(5).0, at(5).1, true), 0.0);
        assert_eq!(watch.standing_for(at(6).0, Pose2::new(0.2, 0.0, 5.0), false), 0.0);
    }
}
