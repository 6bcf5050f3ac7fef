//! Exhaustive search of a small window of poses.

use super::ScanMatchConfig;
use trundle_core::{Pose2, Vector2};
use trundle_grid::LikelihoodField;

/// Penalty on the score of a pose at the edge of the window, relative to the guess \[1\]. It decides between poses of equal likelihood.
/// Source: ours.
const MAX_PRIOR_PENALTY: f64 = 0.02;

/// The pose of the window around `guess` with the highest score of its hits in the field: all poses in coarse steps, then their neighbours
/// in half steps (Olson, Real-time correlative scan matching, ICRA 2009).
pub(crate) fn search(
    config: &ScanMatchConfig,
    field: &LikelihoodField<'_>,
    points: &[Vector2],
    guess: Pose2,
) -> Pose2 {
    let steps = |window: f64, step: f64| (window / step).round() as i32;
    let step_turn = config.step_deg.to_radians();
    let coarse = Lattice {
        step: config.step,
        step_turn,
        reach: steps(config.window, config.step),
        reach_turn: steps(config.window_deg, config.step_deg),
    };
    let fine = Lattice { step: config.step / 2.0, step_turn: step_turn / 2.0, reach: 1, reach_turn: 1 };
    let best = coarse.best(config, field, points, guess, guess);
    fine.best(config, field, points, best, guess)
}

/// Poses around a centre, in equal steps of the map's x and y and of the heading.
struct Lattice {
    step: f64,
    step_turn: f64,
    reach: i32,
    reach_turn: i32,
}

impl Lattice {
    fn best(
        &self,
        config: &ScanMatchConfig,
        field: &LikelihoodField<'_>,
        points: &[Vector2],
        middle: Pose2,
        guess: Pose2,
    ) -> Pose2 {
        let mut best = (f64::NEG_INFINITY, middle);
        let mut turned = Vec::with_capacity(points.len());
        for k in outward(self.reach_turn) {
            let theta = middle.theta + f64::from(k) * self.step_turn;
            let heading = Pose2::new(0.0, 0.0, theta);
            turned.clear();
            turned.extend(points.iter().map(|&p| heading.rotate(p)));
            for i in outward(self.reach) {
                for j in outward(self.reach) {
                    let shift = Vector2::new(f64::from(i), f64::from(j)) * self.step;
                    let pose = Pose2::new(middle.x + shift.x, middle.y + shift.y, theta);
                    let fit: f32 = turned.iter().map(|&p| field.at(p + pose.position())).sum();
                    let score = f64::from(fit) / points.len() as f64 - prior_penalty(config, pose, guess);
                    if score > best.0 {
                        best = (score, pose);
                    }
                }
            }
        }
        best.1
    }
}

/// 0, 1, -1, 2, -2 and so on: of equal scores the pose nearest to the centre wins.
fn outward(reach: i32) -> impl Iterator<Item = i32> {
    std::iter::once(0).chain((1..=reach).flat_map(|i| [i, -i]))
}

fn prior_penalty(config: &ScanMatchConfig, pose: Pose2, guess: Pose2) -> f64 {
    let away = (guess.inverse() * pose).log();
    let part = |off: f64, window: f64| (off / window.max(1e-6)).powi(2);
    MAX_PRIOR_PENALTY * (part(away.xy().norm(), config.window) + part(away.z, config.window_deg.to_radians()))
}
