//! The page of a run's wall-clock figures: the only page that differs between a run and its replay.

use super::{RunNumbers, stage_rows};
use crate::{FinishedRun, real_time::RealTimeReport};
use trundle_viz::{Card, Chart, Color, Figure, Report, Table};

/// File of the run's report, to which the page links.
pub const REPORT_FILE: &str = "report.html";

/// Wall-clock times of every stage of a run, queues and drops: the only page that differs between a run and its replay.
pub fn html(run: &FinishedRun, numbers: &RunNumbers, timing: Option<&RealTimeReport>) -> String {
    let header = ["stage", "median, ms", "p99", "p99.9", "max", "runs"];
    let stages =
        stage_rows(run.robot.times()).into_iter().fold(Table::new("Stages", header), Table::row).wide();
    let report = Report::new("Durations of the stages")
        .subtitle(
            "Times of the clock on the wall. In simulated time nothing waits and nothing is dropped; in real time of the \
             images that come while one is looked at only the newest is kept.",
        )
        .link("Report of the run", REPORT_FILE)
        .card(Card::new("by the clock", &format!("{:.1}", run.seconds)).unit("s"))
        .card(Card::new("of the robot's time", &format!("{:.1}", numbers.duration)).unit("s"))
        .card(Card::new("images dropped", &numbers.images_dropped.len().to_string()))
        .table(stages);
    let Some(timing) = timing else { return report.to_html() };
    let kept = timing.rows().into_iter().fold(Table::new("Real time", ["what", "figure"]), Table::row);
    let chart = Chart::new("Checkpoint", "time, s", "MB").line(
        "resident, robot and simulator",
        Color::BLUE,
        timing.memory.samples.clone(),
    );
    let dropped = numbers.images_dropped.iter().map(|at| format!("{at:.3}")).collect::<Vec<_>>().join(", ");
    let drops = Table::new("Images dropped", ["taken at, s"]).row([dropped]).wide();
    report.table(kept.wide()).figure(Figure::chart(&chart)).table(drops).to_html()
}
