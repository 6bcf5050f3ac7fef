use crate::slam_recorder::Links;
use crate::{Outcome, args::SlamArgs, console, slam::SlamRun};
use trundle::app::AppError;
use trundle::app::report::{camera_view, stage_rows, wall_clock};
use trundle::core::{OccupancyGrid, Pose3, Stamp, Vector3};
use trundle::eval::{
    AbsoluteConfig, AbsoluteError, RelativeConfig, RelativeError, absolute_trajectory_error,
    relative_pose_error,
};
use trundle::io::{OutputFolder, Summary, TumSequence, trajectory_text, write_map};
use trundle::runtime::RobotConfig;
use trundle::viz::{
    Card, Chart, Color, Figure, RunReport, Table, Verdict, VisualMapScene, trajectory_picture,
    visual_map_picture,
};

/// How the trajectory compares with ground truth.
struct Judged {
    absolute: AbsoluteError,
    relative: RelativeError,
    /// Aligned positions and the true ones beside them, m.
    aligned: Vec<Vector3>,
    truth: Vec<Vector3>,
}

/// Writes the folder of a tracked sequence and prints its table.
pub fn write(
    args: &SlamArgs,
    sequence: &TumSequence,
    run: &SlamRun,
    folder: OutputFolder,
) -> Result<Outcome, AppError> {
    let trajectory = run.slam.trajectory();
    let judged = sequence.ground_truth().and_then(|truth| judge(args, truth, &trajectory));
    let grid = run.map.draw(&trajectory, RobotConfig::default().mapping)?;
    write_map(&folder, "map", &grid)?;
    folder.write("trajectory.txt", trajectory_text(&trajectory).as_bytes())?;
    folder.write("visual.map", &run.slam.save())?;
    if let Some(truth) = sequence.ground_truth() {
        folder.write("groundtruth.txt", trajectory_text(truth).as_bytes())?;
    }
    let rows = rows(sequence, run, judged.as_ref());
    folder.write(
        "report.html",
        report(args, run, grid, &trajectory, judged.as_ref(), &rows).to_html().as_bytes(),
    )?;
    folder.write("summary.json", summary(args, sequence, run, judged.as_ref()).to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        console::print_table(&rows);
        console::print_table(&[vec!["wall clock".to_owned(), format!("{:.1} s", run.seconds)]]);
        console::print_table(&stage_rows(&run.times));
        console::print(&format!("See {}", place.join("report.html").display()));
    }
    Ok(if run.is_located() { Outcome::Reached } else { Outcome::Missed })
}

/// ATE and RPE; where they cannot be taken (nothing overlaps in time), a warning says why.
fn judge(args: &SlamArgs, truth: &[(Stamp, Pose3)], trajectory: &[(Stamp, Pose3)]) -> Option<Judged> {
    let config = AbsoluteConfig::default();
    let absolute = absolute_trajectory_error(truth, trajectory, &config);
    let relative = relative_pose_error(truth, trajectory, &RelativeConfig::default());
    match (absolute, relative) {
        (Ok(absolute), Ok(relative)) => {
            let pairs = absolute.pairs.iter();
            let aligned =
                pairs.clone().map(|&(_, e)| absolute.alignment.apply(&trajectory[e].1).translation).collect();
            let truth = pairs.map(|&(t, _)| truth[t].1.translation).collect();
            Some(Judged { absolute, relative, aligned, truth })
        }
        (Err(error), _) | (_, Err(error)) => {
            let file = args.dir.join("groundtruth.txt");
            console::warn(&format!("{}: not compared: {error}", file.display()));
            None
        }
    }
}

fn rows(sequence: &TumSequence, run: &SlamRun, judged: Option<&Judged>) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let c = run.counts;
    let mut rows = vec![
        row("frames read", (c.ok + c.weak + c.dead_reckoned + c.lost).to_string()),
        row("frames unreadable, without depth", format!("{}, {}", run.unreadable.len(), sequence.unpaired())),
        row(
            "ok / weak / dead reckoned / lost",
            format!("{} / {} / {} / {}", c.ok, c.weak, c.dead_reckoned, c.lost),
        ),
        row("motions told by odometry.txt", run.told.to_string()),
        row("keyframes", run.slam.keyframes().count().to_string()),
        row("landmarks", run.slam.landmarks().count().to_string()),
        row("loops closed", run.slam.loops().len().to_string()),
    ];
    if let Some(Judged { absolute, relative, .. }) = judged {
        let s = &absolute.statistics;
        rows.push(row(
            "ATE rmse (median, max)",
            format!("{:.2} cm ({:.2}, {:.2})", s.rmse * 1e2, s.median * 1e2, s.max * 1e2),
        ));
        rows.push(row("RPE rmse, frame to frame", format!("{:.2} cm", relative.translation.rmse * 1e2)));
        rows.push(row("RPE rmse, rotation", format!("{:.3} deg", relative.rotation.rmse.to_degrees())));
    }
    rows
}

fn summary(args: &SlamArgs, sequence: &TumSequence, run: &SlamRun, judged: Option<&Judged>) -> Summary {
    let mut summary = Summary::new("slam");
    let c = run.counts;
    summary
        .set("success", run.is_located())
        .set("camera", args.camera())
        .set("seed", args.seed)
        .set("frames", c.ok + c.weak + c.dead_reckoned + c.lost)
        .set("frames_unreadable", &run.unreadable)
        .set("frames_without_depth", sequence.unpaired())
        .set("frames_ok", c.ok)
        .set("frames_weak", c.weak)
        .set("frames_dead_reckoned", c.dead_reckoned)
        .set("frames_lost", c.lost)
        .set("keyframes", run.slam.keyframes().count())
        .set("landmarks", run.slam.landmarks().count())
        .set("loops_closed", run.slam.loops().len())
        .set("warnings", run.slam.calibration_issues().iter().map(ToString::to_string).collect::<Vec<_>>())
        .set("ate_rmse_m", judged.map(|j| j.absolute.statistics.rmse))
        .set("ate_max_m", judged.map(|j| j.absolute.statistics.max))
        .set("ate_pairs", judged.map(|j| j.absolute.pairs.len()))
        .set("rpe_translation_rmse_m", judged.map(|j| j.relative.translation.rmse))
        .set("rpe_rotation_rmse_rad", judged.map(|j| j.relative.rotation.rmse))
        .set("wall_clock", wall_clock(run.seconds, &run.times, None));
    summary
}

fn report(
    args: &SlamArgs,
    run: &SlamRun,
    grid: OccupancyGrid,
    trajectory: &[(Stamp, Pose3)],
    judged: Option<&Judged>,
    rows: &[Vec<String>],
) -> RunReport {
    let c = run.counts;
    let posed = c.ok + c.weak;
    let verdict = format!("{posed} of {} frames located by sight.", posed + c.dead_reckoned + c.lost);
    let mut charts = vec![Figure::png("The camera's way", &way_picture(trajectory, judged)).wide()];
    charts.extend(judged.map(|judged| error_chart(trajectory, judged)));
    RunReport {
        title: "trundle slam".to_owned(),
        subtitle: format!("{}, camera {}.", args.dir.display(), args.camera()),
        verdict: Some(if run.is_located() { Verdict::Note(verdict) } else { Verdict::Failed(verdict) }),
        cards: cards(run, judged),
        grid: Some(grid),
        landmarks: run.slam.landmarks().collect(),
        estimated_path: trajectory.iter().map(|(_, pose)| pose.to_pose2()).collect(),
        camera: run.last_image.as_ref().map(|image| camera_view(image, run.slam.last_features())),
        depth: run.last_image.as_ref().map(|image| image.depth().clone()),
        figures: vec![visual_map(run, trajectory)],
        charts,
        tables: vec![rows.iter().cloned().fold(Table::new("The sequence", ["what", "value"]), Table::row)],
        ..RunReport::default()
    }
}

/// Landmarks, keyframes and what ties them.
fn visual_map(run: &SlamRun, trajectory: &[(Stamp, Pose3)]) -> Figure {
    let Links { covisible, loops } = Links::of(&run.slam);
    let landmarks: Vec<Vector3> = run.slam.landmarks().collect();
    let keyframes: Vec<Vector3> = run.slam.keyframes().map(|(_, _, pose)| pose.translation).collect();
    let way: Vec<Vector3> = trajectory.iter().map(|(_, pose)| pose.translation).collect();
    let (png, legend) = visual_map_picture(&VisualMapScene {
        landmarks: &landmarks,
        way: &way,
        keyframes: &keyframes,
        covisible: &covisible,
        loops: &loops,
    });
    let caption = "Points the camera recognises, the keyframes from which they were seen, and what ties these: a thin line \
                   where two see the same points, a thick one where a place was recognised after a long way.";
    Figure::png("The visual map", &png).legend(legend).caption(caption).wide()
}

fn cards(run: &SlamRun, judged: Option<&Judged>) -> Vec<Card> {
    let mut cards = Vec::new();
    if let Some(judged) = judged {
        let rmse = judged.absolute.statistics.rmse * 1e2;
        cards.push(Card::new("ATE rmse", &format!("{rmse:.2}")).unit("cm"));
    }
    cards.push(Card::new("keyframes", &run.slam.keyframes().count().to_string()));
    cards.push(Card::new("landmarks", &run.slam.landmarks().count().to_string()));
    cards
}

fn way_picture(trajectory: &[(Stamp, Pose3)], judged: Option<&Judged>) -> Vec<u8> {
    let own: Vec<Vector3> = trajectory.iter().map(|(_, pose)| pose.translation).collect();
    match judged {
        Some(judged) => trajectory_picture(&judged.aligned, Some(&judged.truth)),
        None => trajectory_picture(&own, None),
    }
}

fn error_chart(trajectory: &[(Stamp, Pose3)], judged: &Judged) -> Figure {
    let pairs = judged.absolute.pairs.iter().zip(&judged.absolute.errors);
    let start = trajectory.first().map(|(stamp, _)| *stamp).unwrap_or_default();
    let points = pairs.map(|(&(_, e), error)| (trajectory[e].0 - start, error * 1e2)).collect();
    Figure::chart(&Chart::new("Distance from ground truth", "time, s", "error, cm").line(
        "error",
        Color::BLUE,
        points,
    ))
}
