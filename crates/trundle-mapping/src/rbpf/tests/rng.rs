//! Random numbers of the particles.

use crate::rbpf::rng::ParticleRng;
use nalgebra::{Matrix3, Vector3};

/// Number of draws of a moment: its error is then about 1 %.
const DRAW_COUNT: usize = 8_000;

fn moments(draw: impl FnMut(usize) -> Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let all: Vec<Vector3<f64>> = (0..DRAW_COUNT).map(draw).collect();
    let mean = all.iter().sum::<Vector3<f64>>() / DRAW_COUNT as f64;
    let covariance = all.iter().map(|v| (v - mean) * (v - mean).transpose()).sum::<Matrix3<f64>>();
    (mean, covariance / DRAW_COUNT as f64)
}

#[test]
fn normal_numbers_have_mean_zero_and_the_identity_as_covariance() {
    let mut rng = ParticleRng::new(3, 1, 2);
    let (mean, covariance) = moments(|_| rng.normal3());
    assert!(mean.amax() < 0.05 && (covariance - Matrix3::identity()).amax() < 0.06, "{mean} {covariance}");
}

#[test]
fn points_of_the_ball_fill_it_evenly() {
    let mut rng = ParticleRng::new(3, 1, 2);
    let (mean, covariance) = moments(|_| {
        let point = rng.in_ball();
        assert!(point.norm() <= 1.0 + 1e-12);
        point
    });
    // The covariance of the unit ball is a fifth of the identity.
    assert!(
        mean.amax() < 0.03 && (covariance - Matrix3::identity() / 5.0).amax() < 0.02,
        "{mean} {covariance}"
    );
}

#[test]
fn the_numbers_of_a_particle_depend_on_seed_update_and_particle_alone() {
    let first = |seed, update, particle| {
        let mut rng = ParticleRng::new(seed, update, particle);
        [rng.uniform(), rng.uniform(), rng.uniform()]
    };
    let mut all: Vec<[f64; 3]> = Vec::new();
    for seed in 0..3 {
        for update in 0..3 {
            for particle in 0..3 {
                assert_eq!(first(seed, update, particle), first(seed, update, particle));
                all.push(first(seed, update, particle));
            }
        }
    }
    assert!(all.iter().flatten().all(|v| (0.0..1.0).contains(v)));
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "streams of different particles differ");
}

/// The numbers of 1000 particles do not depend on the order of drawing.
#[test]
fn the_order_of_the_particles_does_not_matter() {
    let draw = |particle: usize| ParticleRng::new(7, 9, particle).normal3();
    let upwards: Vec<_> = (0..1000).map(draw).collect();
    let mut downwards: Vec<_> = (0..1000).rev().map(draw).collect();
    downwards.reverse();
    assert_eq!(upwards, downwards);
}
