//! The numbers of a tracked sequence: table and summary.

use super::request::SequenceRequest;
use super::run::SequenceRun;
use crate::evaluation::TrajectoryEvaluation;
use crate::report::wall_clock;
use crate::sequence_input::SequenceInput;
use crate::surface::SurfaceFiles;
use trundle_io::Summary;
use trundle_runtime::CameraMount;
use trundle_slam::ReadoutEstimate;

/// The table of a tracked sequence, without the part of the wall clock.
#[must_use]
pub fn sequence_rows(
    input: &SequenceInput,
    run: &SequenceRun,
    comparison: Option<&TrajectoryEvaluation>,
) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let c = run.counts;
    let mut rows = vec![
        row("frames read", c.total().to_string()),
        row("frames unreadable, without depth", format!("{}, {}", run.unreadable.len(), input.unpaired())),
        row(
            "ok / weak / dead reckoned / lost",
            format!("{} / {} / {} / {}", c.ok, c.weak, c.dead_reckoned, c.lost),
        ),
        row("frames with a pose, missing", placed(run)),
        row("poses by images / by odometry alone", posed_by(run)),
        row("motions by odometry", run.odometry_priors().to_string()),
        row("keyframes", run.slam.keyframes().count().to_string()),
        row("landmarks", run.slam.landmarks().count().to_string()),
        row("loops closed", run.slam.loops().len().to_string()),
    ];
    if let Some(TrajectoryEvaluation { absolute, relative, .. }) = comparison {
        let s = &absolute.statistics;
        rows.push(row(
            "ATE rmse (median, max)",
            format!(
                "{:.2} cm ({:.2}, {:.2}); {:.1} % of the frames missing",
                s.rmse * 1e2,
                s.median * 1e2,
                s.max * 1e2,
                run.trajectory.missing_share() * 1e2
            ),
        ));
        rows.push(row("RPE rmse, frame to frame", format!("{:.2} cm", relative.translation.rmse * 1e2)));
        rows.push(row("RPE rmse, rotation", format!("{:.3} deg", relative.rotation.rmse.to_degrees())));
    }
    if let Some(mount) = &input.floor_mount {
        rows.push(row("first camera, by the floor", mount_text(mount)));
    }
    if let Some(ReadoutEstimate { readout_s, sigma_s, .. }) = input.readout_by_images {
        let text = format!("{:.1} ms, standard deviation {:.1} ms", readout_s * 1e3, sigma_s * 1e3);
        rows.push(row("readout time, by the images", text));
    }
    rows
}

/// Height, tilt and roll.
fn mount_text(mount: &CameraMount) -> String {
    format!("{:.3} m, tilt {:.2} deg, roll {:.2} deg", mount.z, mount.pitch_deg, mount.roll_deg)
}

/// Frames with a pose, and the share without one.
fn placed(run: &SequenceRun) -> String {
    let trajectory = &run.trajectory;
    let (posed, frames) = (trajectory.poses.len(), trajectory.frames);
    format!("{posed} of {frames}, {:.1} %", trajectory.missing_share() * 1e2)
}

/// Frames with a pose by what gives it.
fn posed_by(run: &SequenceRun) -> String {
    format!("{} / {}", run.trajectory.by_images(), run.trajectory.by_odometry)
}

/// `summary.json`.
pub fn summary(
    request: &SequenceRequest,
    input: &SequenceInput,
    (run, surface): (&SequenceRun, &SurfaceFiles),
    comparison: Option<&TrajectoryEvaluation>,
) -> Summary {
    let mut summary = Summary::new("slam");
    let c = run.counts;
    let failure = run.failure().or_else(|| surface.failure.clone());
    let issues: Vec<String> = run.slam.calibration_issues().iter().map(ToString::to_string).collect();
    let is_interrupted = run.is_interrupted || surface.is_interrupted;
    summary
        .set("success", failure.is_none() && !is_interrupted)
        .set("failure", failure)
        .set("input", input.path.display().to_string())
        .set("cut", input.cut_report())
        .set("camera", &input.camera.name)
        .set("camera_assumed", input.camera.is_assumed)
        .set("depth_scale", input.depth_scale())
        .set("depth_scale_assumed", input.camera.is_assumed || !input.camera.is_depth_scale_known)
        .set("camera_by_floor", input.floor_mount)
        .set("camera_readout_by_images_s", input.readout_by_images.map(|found| found.readout_s))
        .set("seed", request.seed)
        .set("frames", c.total())
        .set("frames_unreadable", &run.unreadable)
        .set("frames_without_depth", input.unpaired())
        .set("frames_ok", c.ok)
        .set("frames_weak", c.weak)
        .set("frames_dead_reckoned", c.dead_reckoned)
        .set("frames_lost", c.lost)
        .set("frames_posed", run.trajectory.poses.len())
        .set("frames_posed_by_images", run.trajectory.by_images())
        .set("frames_posed_by_odometry", run.trajectory.by_odometry)
        .set("frames_without_pose", run.trajectory.missing())
        .set("missing_share", run.trajectory.missing_share())
        .set("trajectory", if run.trajectory.is_fused { "fused" } else { "visual" })
        .set("keyframes", run.slam.keyframes().count())
        .set("landmarks", run.slam.landmarks().count())
        .set("loops_closed", run.slam.loops().len())
        .set("calibration_issues", issues)
        .set("ate_rmse_m", comparison.map(|c| c.absolute.statistics.rmse))
        .set("ate_max_m", comparison.map(|c| c.absolute.statistics.max))
        .set("ate_pairs", comparison.map(|c| c.absolute.pairs.len()))
        .set("rpe_translation_rmse_m", comparison.map(|c| c.relative.translation.rmse))
        .set("rpe_rotation_rmse_rad", comparison.map(|c| c.relative.rotation.rmse))
        .set("wall_clock", wall_clock(run.seconds, &run.times, None))
        .set_interrupted(is_interrupted);
    summary
}
