//! The page of a tracked sequence.

use super::recorder::KeyframeLinks;
use super::run::SequenceRun;
use crate::evaluation::TrajectoryEvaluation;
use crate::report::camera_view;
use crate::sequence_input::SequenceInput;
use trundle_core::{OccupancyGrid, Pose3, Stamp, Vector3};
use trundle_viz::{
    Card, Chart, Color, Figure, RunMap, RunReport, Table, Verdict, VisualMapScene, trajectory_picture,
    visual_map_picture,
};

/// The page: trajectory, error, maps, last image, numbers.
pub fn page(
    input: &SequenceInput,
    run: &SequenceRun,
    grid: OccupancyGrid,
    trajectory: &[(Stamp, Pose3)],
    comparison: Option<&TrajectoryEvaluation>,
    rows: &[Vec<String>],
) -> RunReport {
    let c = run.counts;
    let posed = c.ok + c.weak;
    let frames = posed + c.dead_reckoned + c.lost;
    let placed = run.trajectory.poses.len();
    let verdict = format!("{posed} of {frames} frames located by the images, {placed} with a pose.");
    let mut charts =
        vec![Figure::png("Trajectory of the camera", &path_picture(trajectory, comparison)).wide()];
    charts.extend(comparison.map(error_chart));
    RunReport {
        title: "trundle slam".to_owned(),
        subtitle: format!(
            "{}, camera {}{}.",
            input.path.display(),
            input.camera.name,
            if input.camera.is_assumed { " (assumed)" } else { "" }
        ),
        verdict: Some(match run.failure() {
            None => Verdict::Note(verdict),
            Some(failure) => Verdict::Failed(format!("{verdict} {failure}")),
        }),
        cards: cards(run, comparison),
        map: RunMap {
            grid: Some(grid),
            landmarks: run
                .slam
                .landmarks()
                .map(|point| run.trajectory.level_from_visual.transform(point))
                .collect(),
            estimated_path: trajectory.iter().map(|(_, pose)| pose.to_pose2()).collect(),
            ..RunMap::default()
        },
        camera: run.last_image.as_ref().map(|image| camera_view(image, &run.slam.last_features())),
        depth: run.last_image.as_ref().map(|image| image.depth().clone()),
        figures: vec![visual_map(run)],
        charts,
        tables: vec![rows.iter().cloned().fold(Table::new("The sequence", ["what", "value"]), Table::row)],
        ..RunReport::default()
    }
}

/// Landmarks, keyframes and the links between keyframes.
fn visual_map(run: &SequenceRun) -> Figure {
    let KeyframeLinks { covisible, loops } = KeyframeLinks::of(&run.slam);
    let landmarks: Vec<Vector3> = run.slam.landmarks().collect();
    let keyframes: Vec<Vector3> = run.slam.keyframes().map(|(_, _, pose)| pose.translation).collect();
    let path: Vec<Vector3> = run.slam.trajectory().iter().map(|(_, pose)| pose.translation).collect();
    let (png, legend) = visual_map_picture(&VisualMapScene {
        landmarks: &landmarks,
        path: &path,
        keyframes: &keyframes,
        covisible: &covisible,
        loops: &loops,
    });
    let caption = "Landmarks, the keyframes that observe them, and links between keyframes: a thin line joins keyframes that \
                   share landmarks, a thick one those that closed a loop.";
    Figure::png("The visual map", &png).legend(legend).caption(caption).wide()
}

fn cards(run: &SequenceRun, comparison: Option<&TrajectoryEvaluation>) -> Vec<Card> {
    let mut cards = Vec::new();
    if let Some(comparison) = comparison {
        let rmse = comparison.absolute.statistics.rmse * 1e2;
        cards.push(Card::new("ATE rmse", &format!("{rmse:.2}")).unit("cm"));
    }
    cards.push(Card::new("keyframes", &run.slam.keyframes().count().to_string()));
    cards.push(Card::new("landmarks", &run.slam.landmarks().count().to_string()));
    cards
}

fn path_picture(trajectory: &[(Stamp, Pose3)], comparison: Option<&TrajectoryEvaluation>) -> Vec<u8> {
    let own: Vec<Vector3> = trajectory.iter().map(|(_, pose)| pose.translation).collect();
    match comparison {
        Some(comparison) => trajectory_picture(&comparison.compared(), Some(&comparison.truth)),
        None => trajectory_picture(&own, None),
    }
}

fn error_chart(comparison: &TrajectoryEvaluation) -> Figure {
    Figure::chart(&Chart::new("Distance from ground truth", "time, s", "error, cm").line(
        "error",
        Color::BLUE,
        comparison.absolute_errors_cm(),
    ))
}
