//! Laws of the likelihood of a scan: it falls with the displacement, and lies between its bounds.

use super::room;
use crate::filter_models::FilterModels;
use crate::units::in_cells;
use std::f64::consts::TAU;
use trundle_core::Pose2;
use trundle_grid::tiles::{TileMap, TileWindow};

/// Places of the room with a free view: x (m), y (m), heading (rad).
const PLACES: [(f64, f64, f64); 4] =
    [(0.1, 0.3, 0.4), (-1.6, -0.8, -2.0), (2.0, -0.2, 3.0), (0.3, -1.4, 1.3)];

/// The pose in cells of the window.
fn local(models: &FilterModels, window: &TileWindow<'_>, pose: Pose2) -> Pose2 {
    let cells = in_cells(&models.config, pose);
    Pose2 { x: cells.x - f64::from(window.corner.0), y: cells.y - f64::from(window.corner.1), ..cells }
}

fn window(map: &TileMap) -> TileWindow<'_> {
    TileWindow::new(map, (-80, -60), (80, 60))
}

#[test]
fn the_likelihood_falls_with_the_displacement_in_every_direction() {
    let models = room::models();
    let map = room::map(&models);
    let window = window(&map);
    for (x, y, theta) in PLACES {
        let points = room::points(&models, Pose2::new(x, y, theta));
        let at = |pose: Pose2| models.likelihood.log_likelihood(&window, &points, pose);
        let truth = local(&models, &window, Pose2::new(x, y, theta));
        for k in 0..16 {
            let (s, c) = (TAU * f64::from(k) / 16.0).sin_cos();
            let shifted = [0.0, 1.0, 2.0, 4.0]
                .map(|by| at(Pose2 { x: truth.x + by * c, y: truth.y + by * s, ..truth }));
            assert!(shifted.windows(2).all(|pair| pair[1] < pair[0]), "cells towards {k}: {shifted:?}");
        }
        for sign in [-1.0, 1.0] {
            let turned =
                [0.0, 0.02, 0.05, 0.12].map(|by| at(Pose2 { theta: truth.theta + sign * by, ..truth }));
            assert!(turned.windows(2).all(|pair| pair[1] < pair[0]), "rad: {turned:?}");
        }
    }
}

/// Each point has a likelihood between that of an outlier and 1; in unknown space it has the root of the outliers' likelihood.
#[test]
fn a_point_is_at_least_as_likely_as_an_outlier() {
    let models = room::models();
    let map = room::map(&models);
    let points = room::points(&models, Pose2::new(0.1, 0.3, 0.4));
    let count: usize = points.groups.iter().map(|group| group.count).sum();
    let outlier = models.config.outliers.ln();
    for k in 0..60 {
        let part = |n: u32| f64::from((k * 7919 + n * 104_729) % 2001) / 1000.0 - 1.0;
        let pose = Pose2::new(60.0 + 30.0 * part(1), 50.0 + 30.0 * part(2), 3.0 * part(3));
        let value = models.likelihood.log_likelihood(&window(&map), &points, pose);
        assert!(value <= 1e-3 && value >= count as f64 * outlier - 1e-2, "{value} of {count} points");
    }
    let empty = TileMap::default();
    let unknown = models.likelihood.log_likelihood(&window(&empty), &points, Pose2::new(80.0, 60.0, 0.0));
    let expected = 0.5 * outlier * count as f64;
    assert!((unknown - expected).abs() < 1e-3 * expected.abs(), "{unknown} against {expected}");
    let equations = models.likelihood.equations(&window(&empty), &points, Pose2::new(80.0, 60.0, 0.0));
    assert_eq!((equations.weight, equations.contradicted), (0.0, 0.0), "unknown space contradicts no point");
}

/// A Gauss-Newton step from a small displacement leads to a likelier pose.
#[test]
fn a_step_of_the_normal_equations_raises_the_likelihood() {
    let models = room::models();
    let map = room::map(&models);
    let window = window(&map);
    for (x, y, theta) in PLACES {
        let points = room::points(&models, Pose2::new(x, y, theta));
        let truth = local(&models, &window, Pose2::new(x, y, theta));
        for k in 0..12 {
            let (s, c) = (TAU * f64::from(k) / 12.0).sin_cos();
            let start = Pose2 { x: truth.x + 0.8 * c, y: truth.y + 0.8 * s, theta: truth.theta + 0.015 * c };
            let normal = models.likelihood.equations(&window, &points, start).normal;
            let step = normal.information.try_inverse().unwrap() * normal.rhs;
            let end = Pose2 { x: start.x + step.x, y: start.y + step.y, theta: start.theta + step.z };
            let at = |pose: Pose2| models.likelihood.log_likelihood(&window, &points, pose);
            assert!(
                at(end) > at(start) && end.distance(&truth) < 0.5,
                "{start:?} to {end:?}, truth {truth:?}"
            );
        }
    }
}
