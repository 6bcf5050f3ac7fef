//! Mean of poses.

use trundle_core::{Pose2, wrap_angle};

/// The mean of poses close to each other.
#[derive(Debug, Clone, Copy, Default)]
pub struct PoseAverage {
    first: Pose2,
    sum: (f64, f64, f64),
    count: u32,
}

impl PoseAverage {
    /// Adds a pose.
    pub fn add(&mut self, pose: &Pose2) {
        if self.count == 0 {
            self.first = *pose;
        }
        self.sum.0 += pose.x - self.first.x;
        self.sum.1 += pose.y - self.first.y;
        self.sum.2 += wrap_angle(pose.theta - self.first.theta);
        self.count += 1;
    }

    /// The mean; the identity without poses.
    pub fn mean(&self) -> Pose2 {
        let n = f64::from(self.count.max(1));
        Pose2::new(
            self.first.x + self.sum.0 / n,
            self.first.y + self.sum.1 / n,
            self.first.theta + self.sum.2 / n,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_averaged_across_the_wrap() {
        let mut average = PoseAverage::default();
        average.add(&Pose2::new(1.0, 0.0, 3.1));
        average.add(&Pose2::new(2.0, 0.0, -3.1));
        let mean = average.mean();
        assert!((mean.x - 1.5).abs() < 1e-12 && (mean.theta.abs() - std::f64::consts::PI).abs() < 1e-12);
    }
}
