//! A trajectory: poses and twists over time, and their interpolation.

use crate::{Invalid, Pose2, Twist2};

/// Reference pose and twist of the robot at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryPoint {
    /// Seconds since the trajectory's start.
    pub time: f64,
    /// `map_from_base`.
    pub pose: Pose2,
    /// The reference twist.
    pub twist: Twist2,
}

/// A path with time: samples by rising time, the first at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    points: Vec<TrajectoryPoint>,
}

impl Trajectory {
    /// A trajectory through `points`.
    ///
    /// # Errors
    /// When the trajectory has no point, the first time is not 0, times do not increase strictly, or a number is not finite.
    pub fn new(points: Vec<TrajectoryPoint>) -> Result<Self, Invalid> {
        let Some(first) = points.first() else {
            return Err(Invalid::new("trajectory points", 0, "", "1 or more"));
        };
        if first.time != 0.0 {
            return Err(Invalid::new("time of trajectory point 0", first.time, "s", "0"));
        }
        for (i, pair) in points.windows(2).enumerate() {
            if pair[1].time.partial_cmp(&pair[0].time) != Some(std::cmp::Ordering::Greater) {
                let expected = format!("more than {} s", pair[0].time);
                return Err(Invalid::new(
                    format!("time of trajectory point {}", i + 1),
                    pair[1].time,
                    "s",
                    expected,
                ));
            }
        }
        match points.iter().position(|p| !(p.time.is_finite() && p.pose.is_finite() && p.twist.is_finite())) {
            Some(i) => Err(Invalid::new(format!("trajectory point {i}"), "not finite", "", "finite numbers")),
            None => Ok(Self { points }),
        }
    }

    /// The samples, by rising time.
    pub fn points(&self) -> &[TrajectoryPoint] {
        &self.points
    }

    /// The last time, s.
    pub fn duration(&self) -> f64 {
        self.points[self.points.len() - 1].time
    }

    /// The last pose.
    pub fn end(&self) -> Pose2 {
        self.points[self.points.len() - 1].pose
    }

    /// The reference at `time` seconds, linear between samples, held before the first and after the last.
    pub fn at(&self, time: f64) -> TrajectoryPoint {
        let after = self.points.partition_point(|p| p.time <= time);
        if after == 0 {
            return self.points[0];
        }
        let a = self.points[after - 1];
        let Some(b) = self.points.get(after) else { return a };
        let fraction = (time - a.time) / (b.time - a.time);
        let mix = |u: f64, w: f64| u + (w - u) * fraction;
        TrajectoryPoint {
            time,
            pose: a.pose.interpolate(&b.pose, fraction),
            twist: Twist2::new(mix(a.twist.v, b.twist.v), mix(a.twist.omega, b.twist.omega)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(time: f64, x: f64) -> TrajectoryPoint {
        TrajectoryPoint { time, pose: Pose2::new(x, 0.0, 0.0), twist: Twist2::new(1.0, 0.0) }
    }

    #[test]
    fn interpolates_and_holds_the_ends() {
        let trajectory = Trajectory::new(vec![point(0.0, 0.0), point(2.0, 2.0)]).unwrap();
        assert_eq!(trajectory.at(0.5).pose.x, 0.5);
        assert_eq!(trajectory.at(-1.0).pose.x, 0.0);
        assert_eq!(trajectory.at(9.0).pose.x, 2.0);
    }

    #[test]
    fn time_must_rise() {
        let error = Trajectory::new(vec![point(0.0, 0.0), point(0.0, 1.0)]).unwrap_err();
        assert_eq!(error.field, "time of trajectory point 1");
        assert!(Trajectory::new(vec![point(0.0, 0.0), point(f64::NAN, 1.0)]).is_err());
    }
}
