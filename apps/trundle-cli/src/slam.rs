//! `trundle slam`: tracks a recorded RGB-D sequence and draws its map.

mod args;

pub use args::{CameraArgs, SlamArgs};
use args::{FirstCameraArgs, SurfaceArgs};

use crate::console;
use crate::logging;
use crate::outcome::Outcome;
use crate::output_args::inputs;
use trundle::app::AppError;
use trundle::app::sequence::{FirstCamera, SequenceRequest, track_sequence, write_sequence};
use trundle::app::surface::{SurfaceRequest, surface_files};
use trundle::live::RunFacts;

/// `trundle slam DIR`.
pub fn run(args: &SlamArgs) -> Result<Outcome, AppError> {
    let (request, surface) = (args.request()?, args.surface.request()?);
    let input = request.open()?;
    let folder = logging::output_folder(&args.result.out)?;
    surface.require_places(&folder, inputs())?;
    let display = console::StepDisplay::new(args.common.quiet);
    let (page, link) = args.live.start(|| Ok(RunFacts::of_sequence(&args.input)), false)?.unzip();
    let run = track_sequence(&request, &input, &folder, &display, link)?;
    drop(page);
    let made = surface_files(&surface, &input, &run.trajectory.poses, &display);
    let output = write_sequence(&request, &input, &run, &made, (folder, inputs()))?;
    if !args.common.quiet {
        console::print_table(&output.rows);
        console::print_table(&made.rows);
        run.clock_tables().iter().for_each(|table| console::print_table(table));
        console::print_see(&output.folder.join("report.html"));
    }
    output.incomplete.map_or(Ok(Outcome::unless(output.failure)), Err)
}

impl SlamArgs {
    fn request(&self) -> Result<SequenceRequest, AppError> {
        let FirstCameraArgs { height, tilt: tilt_deg, roll: roll_deg } = self.first_camera;
        Ok(SequenceRequest {
            path: self.input.clone(),
            topics: self.topics.options(),
            camera: self.camera.camera.clone(),
            depth_scale: self.camera.depth_scale,
            recover: self.recover,
            frames: self.frames.map(|frames| frames as usize),
            first_camera: FirstCamera { height, tilt_deg, roll_deg },
            map: self.map.clone(),
            localize_only: self.localise,
            vocabulary: self.vocabulary.clone(),
            seed: self.seed,
            map_image: self.result.map_image,
            visual_only: self.result.visual_only,
            record: self.result.record,
            robot: self.robot.robot_if_given()?.map(Box::new),
        })
    }
}

impl SurfaceArgs {
    fn request(&self) -> Result<SurfaceRequest, AppError> {
        let Self { mesh, cloud, octomap, heights, voxel } = self;
        let [mesh, cloud, octomap, heights] = [mesh, cloud, octomap, heights].map(Option::as_deref);
        SurfaceRequest::new(mesh, cloud, octomap, heights, *voxel)
    }
}
