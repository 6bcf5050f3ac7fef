//! The page and the pictures of an evaluated trajectory.

use super::TrajectoryEvaluation;
use trundle_viz::{Card, Chart, Color, Figure, Report, Table, trajectory_picture};

/// The page: the trajectories, the errors over time, the numbers.
pub fn page(found: &TrajectoryEvaluation, subtitle: &str) -> Report {
    let mut rows = found.rows().into_iter();
    let table = Table::new("Errors", rows.next().unwrap_or_default());
    let rmse = format!("{:.2}", found.absolute.statistics.rmse * 1e2);
    let drift = format!("{:.2}", found.relative.translation.rmse * 1e2);
    Report::new("trundle eval trajectory")
        .subtitle(subtitle)
        .card(Card::new("ATE rmse", &rmse).unit("cm"))
        .card(Card::new("RPE rmse", &drift).unit("cm"))
        .card(Card::new("compared poses", &found.absolute.pairs.len().to_string()))
        .section("Trajectories", "")
        .figure(Figure::png("Estimate and reference, aligned", &picture(found)).wide())
        .section("Errors over time", "")
        .figure(Figure::chart(&absolute_chart(found)))
        .figure(Figure::chart(&relative_chart(found)))
        .section("Numbers", "")
        .table(rows.fold(table, Table::row).wide())
}

/// The pictures of the page, each with the name of its file.
pub fn pictures(found: &TrajectoryEvaluation) -> [(&'static str, Vec<u8>); 3] {
    [
        ("trajectory.png", picture(found)),
        ("ate.svg", absolute_chart(found).to_svg().into_bytes()),
        ("rpe.svg", relative_chart(found).to_svg().into_bytes()),
    ]
}

fn picture(found: &TrajectoryEvaluation) -> Vec<u8> {
    trajectory_picture(&found.compared(), Some(&found.truth))
}

fn absolute_chart(found: &TrajectoryEvaluation) -> Chart {
    let title = "Distance from the reference";
    Chart::new(title, "time, s", "error, cm").line("ATE", Color::BLUE, found.absolute_errors_cm())
}

fn relative_chart(found: &TrajectoryEvaluation) -> Chart {
    let pairs = found.relative.pairs.iter().zip(&found.relative.errors);
    let points = pairs.map(|(&(_, to), (length, _))| (found.seconds(to), length * 1e2)).collect();
    let title = format!("Error of the motion over {}", found.relative_config.delta);
    Chart::new(&title, "time, s", "error, cm").line("RPE", Color::ORANGE, points)
}
