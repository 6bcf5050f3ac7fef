//! RANSAC: the motion that most pairs agree with.

use super::ransac_config::RansacConfig;
use super::refine::gauss_newton;
use super::residual::{Mover, Observation};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{PinholeCamera, Pose3};

/// Maximum number of rounds of refinement by the inliers: 5. Source: ours.
const MAX_REFINEMENTS: usize = 5;
/// Most Gauss-Newton steps of a round: 10. Source: ours.
const MAX_STEPS: usize = 10;
/// Step that ends a round: 1e-7, m and rad. Source: ours.
const CONVERGED_STEP: f64 = 1e-7;

/// RANSAC \[Fischler81\] over observations with outliers: samples of three propose motions, and the motion with the minimum truncated cost
/// \[Torr00\] is refined on its inliers.
pub(crate) struct Consensus<'a> {
    pub observations: &'a [Observation],
    pub camera: &'a PinholeCamera,
    pub config: &'a RansacConfig,
}

impl Consensus<'_> {
    /// The motion `b_from_a`, and the indices of its inliers, increasing. `propose` converts three different observations, given by their
    /// indices, to motions. `None` if fewer than [`RansacConfig::min_inliers`] agree.
    pub fn find<P>(&self, seed: u64, propose: impl Fn([usize; 3]) -> P) -> Option<(Pose3, Vec<usize>)>
    where
        P: IntoIterator<Item = Pose3>,
    {
        let fewest = self.config.min_inliers.max(3);
        (self.observations.len() >= fewest).then_some(())?;
        let found = self.polish(self.best_of_samples(seed, propose)?)?;
        (found.1.len() >= fewest).then_some(found)
    }

    /// The proposed motion with the minimum cost; among equal ones the first. The search ends when a better one is unlikely.
    fn best_of_samples<P>(&self, seed: u64, propose: impl Fn([usize; 3]) -> P) -> Option<Pose3>
    where
        P: IntoIterator<Item = Pose3>,
    {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut best: Option<(f64, Pose3)> = None;
        let (mut iteration, mut enough) = (0, self.config.max_iterations);
        while iteration < enough {
            iteration += 1;
            for motion in propose(three_of(self.observations.len(), &mut rng)) {
                let (cost, inliers) = self.judge(motion);
                if best.is_none_or(|(min, _)| cost < min) {
                    best = Some((cost, motion));
                    enough = self.enough(inliers);
                }
            }
        }
        best.map(|(_, motion)| motion)
    }

    /// Cost (squared residuals, at most the bound each) and number of inliers.
    fn judge(&self, b_from_a: Pose3) -> (f64, usize) {
        let mover = Mover::from(b_from_a);
        self.observations.iter().fold((0.0, 0), |(cost, inliers), o| {
            let chi2 = o.chi2(self.camera, mover.transform(o.point));
            (cost + chi2.min(o.bound), inliers + usize::from(chi2 <= o.bound))
        })
    }

    /// Number of samples after which a sample of three inliers is sufficiently likely, if `inliers` are all inliers \[Fischler81\].
    fn enough(&self, inliers: usize) -> usize {
        let max = self.config.max_iterations;
        let all_right = (inliers as f64 / self.observations.len() as f64).powi(3);
        let samples = (1.0 - self.config.confidence).ln() / (1.0 - all_right).ln();
        // Without inliers the quotient is infinite, of either sign; with only inliers it is 0.
        if all_right > 0.0 { (samples.ceil() as usize).min(max) } else { max }
    }

    fn inliers(&self, b_from_a: Pose3) -> Vec<usize> {
        let mover = Mover::from(b_from_a);
        let agrees = |o: &Observation| o.chi2(self.camera, mover.transform(o.point)) <= o.bound;
        (0..self.observations.len()).filter(|&i| agrees(&self.observations[i])).collect()
    }

    /// Fits the motion to its inliers until the set of inliers is constant. `None` if the inliers do not determine the motion.
    fn polish(&self, b_from_a: Pose3) -> Option<(Pose3, Vec<usize>)> {
        let mut motion = b_from_a;
        let mut inliers = self.inliers(motion);
        for _ in 0..MAX_REFINEMENTS {
            let agreeing: Vec<Observation> = inliers.iter().map(|&i| self.observations[i]).collect();
            motion = gauss_newton(motion, &agreeing, self.camera, MAX_STEPS, CONVERGED_STEP)?;
            let now = self.inliers(motion);
            let settled = now == inliers;
            inliers = now;
            if settled {
                break;
            }
        }
        Some((motion, inliers))
    }
}

/// Three different places below `count`, which is 3 or more.
fn three_of(count: usize, rng: &mut ChaCha8Rng) -> [usize; 3] {
    let count = count as u32;
    let first = rng.random_range(0..count);
    // Steps from the first that leave the others different without drawing again.
    let second = rng.random_range(1..count);
    let third = rng.random_range(1..count - 1);
    let third = third + u32::from(third >= second);
    [0, second, third].map(|step| ((first + step) % count) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn three_different_ones_are_drawn(seed: u64, count in 3..9usize) {
            let [a, b, c] = three_of(count, &mut ChaCha8Rng::seed_from_u64(seed));
            prop_assert!(a != b && b != c && c != a);
            prop_assert!(a.max(b).max(c) < count);
        }
    }
}
