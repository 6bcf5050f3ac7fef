//! Charts of the made-up drive.

use trundle_core::Pose2;
use trundle_viz::{BarChart, Chart, Color, Figure};

const STEP: f64 = 0.13;

pub fn all(estimate: &[Pose2], truth: &[Pose2]) -> Vec<Figure> {
    let goal = estimate[estimate.len() - 1];
    let over_time = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        (0..estimate.len()).map(|i| (i as f64 * STEP, value(i))).collect()
    };
    let distance = Chart::new("Distance to the goal", "time, s", "distance, m")
        .line("believed", Color::BLUE, over_time(&|i| estimate[i].distance(&goal)))
        .dashed("true", Color::ORANGE, over_time(&|i| truth[i].distance(&goal)));
    let error = Chart::new("Position error against truth", "time, s", "error, cm")
        .line("error", Color::BLUE, over_time(&|i| 100.0 * estimate[i].distance(&truth[i])))
        .limit("limit 5 cm", 5.0);
    let speed = Chart::new("Speed and turn rate", "time, s", "m/s, rad/s")
        .line("speed", Color::BLUE, over_time(&|i| 0.5 * (i as f64 * 0.02).sin().abs()))
        .line("turn rate", Color::VERMILLION, over_time(&|i| 0.3 * (i as f64 * 0.11).sin()));
    let stages = BarChart::new("Time of each stage", "ms", "median", "99th percentile")
        .row("features", 11.2, 17.9)
        .row("tracking", 6.1, 12.4)
        .row("scan", 1.4, 2.0)
        .row("localization", 0.08, 0.2)
        .row("mapping", 3.3, 9.8)
        .row("planning", 24.0, 41.7)
        .row("control", 0.02, 0.05);
    vec![
        Figure::chart(&distance),
        Figure::chart(&error).caption("How far the estimate is from where the robot was."),
        Figure::chart(&speed),
        Figure::bars(&stages),
    ]
}
