//! Matches of a scan in a map of the room: known offsets at many angles, and searches without a guess.

use super::room;
use crate::scan_match::cloud_match::CloudMatcher;
use crate::scan_match::motion_prior::MotionPrior;
use crate::scan_match::pose_optimizer::{PoseOptimizer, difference};
use crate::units::in_cells;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};
use trundle_core::{Pose2, wrap_angle};
use trundle_grid::tiles::TileWindow;

/// A prior so wide that it has no effect in the area: 10 cells and 0.3 rad.
fn wide() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(100.0, 100.0, 0.09))
}

/// Places of the room with a free view, m.
const PLACES: [(f64, f64); 4] = [(0.1, 0.3), (-1.6, -0.8), (2.0, -0.2), (0.3, -1.4)];

#[test]
fn a_known_offset_is_recovered_at_every_heading() {
    let models = room::models();
    let map = room::map(&models);
    for (i, k) in (0..PLACES.len()).flat_map(|i| (0..24).map(move |k| (i, k))) {
        let truth = Pose2::new(PLACES[i].0, PLACES[i].1, TAU * f64::from(k) / 24.0 - 3.0);
        let cloud = room::points(&models, truth);
        let matcher = CloudMatcher { config: &models.config, likelihood: &models.likelihood, cloud: &cloud };
        let truth = in_cells(&models.config, truth);
        let start = truth * Pose2::new(1.2, -0.9, 0.03);
        let found = matcher.climb(&map, start, &wide());
        let off = difference(found.pose, truth);
        assert!(off.xy().norm() < 0.4 && off.z.abs() < 0.01, "{truth:?}: {off}");
        assert!(found.explained > 0.8 && found.degenerate == 0, "{truth:?}: {found:?}");
    }
}

#[test]
fn a_scan_finds_its_place_in_the_whole_room_without_a_guess() {
    let models = room::models();
    let map = room::map(&models);
    let everywhere = Matrix3::from_diagonal(&Vector3::new(1e10, 1e10, 1e4));
    for (i, theta) in [(0, 1.0), (1, -2.5), (2, 3.0)] {
        let truth = Pose2::new(PLACES[i].0, PLACES[i].1, theta);
        let cloud = room::points(&models, truth);
        let matcher = CloudMatcher { config: &models.config, likelihood: &models.likelihood, cloud: &cloud };
        let found = matcher.find(&map, Pose2::IDENTITY, &everywhere, ((64.0, 44.0), PI), 2);
        let off = difference(found[0].pose, in_cells(&models.config, truth));
        assert!(off.xy().norm() < 0.5 && off.z.abs() < 0.02, "{off}");
        assert!(found.len() == 1 || found[1].log_likelihood < found[0].log_likelihood - 8.0);
    }
}

/// The optimum is at least as likely as any neighbouring pose.
#[test]
fn no_pose_near_the_optimum_is_likelier() {
    let models = room::models();
    let map = room::map(&models);
    let truth = Pose2::new(0.1, 0.3, 0.4);
    let points = room::points(&models, truth);
    let optimizer = PoseOptimizer { config: &models.config, likelihood: &models.likelihood, points: &points };
    let window = TileWindow::new(&map, (-80, -60), (80, 60));
    let local = |pose: Pose2| {
        let (x, y) = (f64::from(window.corner.0), f64::from(window.corner.1));
        Pose2 { x: pose.x - x, y: pose.y - y, ..pose }
    };
    let guess = local(in_cells(&models.config, truth));
    let prior = MotionPrior::with(guess, wide());
    let optimum = optimizer.optimize(&window, &prior, guess * Pose2::new(0.8, 0.5, 0.02));
    for k in 0..200 {
        let part = |n: u32| f64::from((k * 7919 + n * 104_729) % 2001) / 1000.0 - 1.0;
        let near = Pose2 {
            x: optimum.pose.x + 3.0 * part(1),
            y: optimum.pose.y + 3.0 * part(2),
            theta: wrap_angle(optimum.pose.theta + 0.1 * part(3)),
        };
        let value = optimizer.log_posterior(&window, &prior, near);
        assert!(value < optimum.log_posterior + 0.5, "{near:?}: {value}, {}", optimum.log_posterior);
    }
}

/// An empty map explains no hit: the pose follows the prior.
#[test]
fn in_an_empty_map_the_prior_decides() {
    let models = room::models();
    let cloud = room::points(&models, Pose2::IDENTITY);
    let matcher = CloudMatcher { config: &models.config, likelihood: &models.likelihood, cloud: &cloud };
    let map = trundle_grid::tiles::TileMap::default();
    let start = Pose2::new(5.0, -3.0, 0.2);
    let found = matcher.climb(&map, start, &wide());
    assert!(found.pose.distance(&start) < 1e-9 && found.explained == 0.0 && found.degenerate == 3);
    assert_eq!(found.information, Matrix3::zeros());
    assert!(matcher.find(&map, start, &wide(), ((20.0, 20.0), 0.5), 2).is_empty());
    assert_eq!(matcher.fit(&map, start), (0.0, 0.0));
}

/// A scan agrees with its own map and contradicts another place.
#[test]
fn a_fit_counts_explained_and_contradicted_points() {
    let models = room::models();
    let map = room::map(&models);
    let truth = Pose2::new(0.1, 0.3, 0.4);
    let cloud = room::points(&models, truth);
    let matcher = CloudMatcher { config: &models.config, likelihood: &models.likelihood, cloud: &cloud };
    let (explained, contradicted) = matcher.fit(&map, in_cells(&models.config, truth));
    assert!(explained > 0.85 && contradicted < 0.03, "{explained} {contradicted}");
    let (explained, contradicted) = matcher.fit(&map, in_cells(&models.config, Pose2::new(0.6, 0.0, 1.9)));
    assert!(explained < 0.4 && contradicted > 0.2, "{explained} {contradicted}");
}
