//! Weights, resampling and trajectories of the particle set.

use crate::particle_config::ParticleConfig;
use crate::rbpf::particle_set::ParticleSet;
use crate::rbpf::resampling::{effective, low_variance};
use proptest::prelude::*;
use trundle_core::{Pose2, Stamp};
use trundle_grid::tiles::TileMap;

/// Particles 10 cells apart with these log-weights.
fn particles(log_weights: &[f64]) -> ParticleSet {
    let mut set = ParticleSet::new(log_weights.len());
    for (i, (particle, log_weight)) in set.particles.iter_mut().zip(log_weights).enumerate() {
        particle.pose = Pose2::new(10.0 * i as f64, 0.0, 0.0);
        particle.log_weight = *log_weight;
    }
    set
}

fn any_log_weights() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-6.0..3.0_f64, 1..40)
}

proptest! {
    /// Over all random numbers the mean of the resampled particles is the weighted mean.
    #[test]
    fn resampling_keeps_the_weighted_mean(
        weights in prop::collection::vec(0.01..1.0_f64, 1..40),
        values in prop::collection::vec(-5.0..5.0_f64, 40),
    ) {
        const DRAW_COUNT: usize = 400;
        let total: f64 = weights.iter().sum();
        let expected: f64 = weights.iter().zip(&values).map(|(w, x)| w / total * x).sum();
        let mean = |k: usize| {
            let parents = low_variance(&weights, (k as f64 + 0.5) / DRAW_COUNT as f64);
            parents.iter().map(|&p| values[usize::from(p)]).sum::<f64>() / weights.len() as f64
        };
        let found = (0..DRAW_COUNT).map(mean).sum::<f64>() / DRAW_COUNT as f64;
        prop_assert!((found - expected).abs() < 10.0 / DRAW_COUNT as f64 + 1e-9, "{found}, expected {expected}");
    }

    #[test]
    fn the_effective_number_is_between_one_and_all_and_a_common_factor_does_not_matter(
        log_weights in any_log_weights(), shift in -300.0..300.0_f64,
    ) {
        let shifted: Vec<f64> = log_weights.iter().map(|l| l + shift).collect();
        let (mut a, mut b) = (particles(&log_weights), particles(&shifted));
        let (one, other) = (a.normalize(), b.normalize());
        prop_assert!((1.0 - 1e-9..=log_weights.len() as f64 + 1e-9).contains(&one));
        prop_assert!((one - other).abs() < 1e-6);
        prop_assert_eq!(a.best().pose, b.best().pose);
        prop_assert_eq!(a.best().log_weight, 0.0);
        prop_assert!((one - effective(&log_weights.iter().map(|l| l.exp()).collect::<Vec<_>>())).abs() < 1e-6);
    }

    #[test]
    fn the_best_particle_survives_and_all_weigh_alike(log_weights in any_log_weights(), uniform in 0.0..1.0_f64) {
        let mut set = particles(&log_weights);
        set.normalize();
        let best = set.best().pose;
        let before: Vec<Pose2> = set.particles.iter().map(|p| p.pose).collect();
        set.resample(uniform);
        prop_assert!(set.particles.iter().any(|p| p.pose == best));
        for (particle, parent) in set.particles.iter().zip(&set.parents) {
            prop_assert_eq!(particle.pose, before[usize::from(*parent)]);
            prop_assert_eq!(particle.log_weight, 0.0);
        }
    }

    #[test]
    fn the_trajectory_ends_at_the_best_particle_after_every_resampling(
        steps in prop::collection::vec((any_log_weights_of(5), 0.0..1.0_f64), 1..30),
    ) {
        let config = ParticleConfig::default();
        let mut set = particles(&[0.0; 5]);
        for (k, (log_weights, uniform)) in steps.iter().enumerate() {
            for (particle, log_weight) in set.particles.iter_mut().zip(log_weights) {
                particle.pose.y += 1.0 + log_weight.abs();
                particle.log_weight = *log_weight;
            }
            set.normalize();
            set.record(&config, Stamp::from_nanos(k as i64));
            set.resample(*uniform);
            let trajectory = set.trajectory();
            prop_assert_eq!(trajectory.len(), k + 1);
            let last = trajectory[k].1;
            let pose = set.best().pose;
            prop_assert!((last.x - pose.x * 0.05).abs() < 1e-9 && (last.y - pose.y * 0.05).abs() < 1e-9);
            prop_assert!(trajectory.windows(2).all(|pair| pair[1].1.y > pair[0].1.y));
        }
    }
}

fn any_log_weights_of(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-6.0..3.0_f64, count)
}

#[test]
fn collapsed_particles_share_pose_map_and_past() {
    let config = ParticleConfig::default();
    let mut set = particles(&[0.0, -1.0, -2.0]);
    set.record(&config, Stamp::default());
    let mut map = TileMap::default();
    map.tile_mut((2, 3)).log_odds[5] = 9;
    let past = vec![
        (Stamp::default(), Pose2::new(1.0, 0.0, 0.0)),
        (Stamp::from_nanos(1), Pose2::new(2.0, 0.0, 0.1)),
    ];
    set.collapse(past.clone(), Pose2::new(40.0, 0.0, 0.1), &map);
    assert_eq!(set.trajectory(), past);
    assert!(set.particles.iter().all(|p| p.pose == Pose2::new(40.0, 0.0, 0.1) && p.log_weight == 0.0));
    assert!(set.particles.iter().all(|p| p.map.tile((2, 3)).log_odds[5] == 9));
    set.record(&config, Stamp::from_nanos(2));
    assert_eq!(set.trajectory().len(), 3);
}
