//! The surface of a tracked sequence: a mesh, a cloud of points, an octree and a height map.

mod output;
mod request;
#[cfg(test)]
mod tests;

use request::heights_description;
pub use request::{MeshFormat, SurfaceRequest};

use crate::sequence_input::SequenceInput;
use crate::{AppError, StepProgress, stop};
use std::path::{Path, PathBuf};
use std::time::Instant;
use trundle_core::{Hypotenuse, PinholeCamera, Pose3, RgbdImage, Stamp};
use trundle_io::{HeightGrid, SurfaceData, glb_bytes, height_files, octomap_bytes, ply_bytes};
use trundle_surface::{HeightMap, OccupiedVoxels, SurfaceMap, SurfaceMesh, VoxelState, surface_mesh};

/// Distance of the camera from the last image that was used, above which an image is used \[m\]. Source: ours.
const MIN_DISTANCE_M: f64 = 0.1;
/// Turn of the camera since the last image that was used, above which an image is used \[rad\]. Source: ours, 5 deg.
const MIN_TURN_RAD: f64 = 0.087;
/// Time since the last image that was used, above which an image is used \[s\]: what moves before a camera at rest disappears. Source: ours.
const MAX_PAUSE_S: f64 = 1.0;
/// Smallest connected part of the mesh \[m^2\]: smaller ones are noise. Source: ours, 50 vertices at voxels of 2 cm.
const MIN_PART_AREA_M2: f64 = 0.02;
/// Height up to which surfaces count in the height map \[m\]: tables do, ceilings do not. Source: ours.
const HEIGHT_MAP_CEILING_M: f64 = 1.8;

/// The files of a surface, and the numbers of its making.
#[derive(Debug, Clone, Default)]
pub struct SurfaceFiles {
    /// Path and content.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// Table for a front end: name and value.
    pub rows: Vec<Vec<String>>,
    /// Reason why there is no surface; `None` if there is one.
    pub failure: Option<String>,
    /// Whether the user ended the work before the last image.
    pub is_interrupted: bool,
}

/// Lays the images of `input` along `poses` (map from camera, by rising stamps) and makes the files of `request`. An interrupted run makes
/// them from the images up to there. Images that cannot be read, or a picture that cannot be encoded, are the failure of the surface and not
/// of the results before it.
pub fn surface_files(
    request: &SurfaceRequest,
    input: &SequenceInput,
    poses: &[(Stamp, Pose3)],
    progress: &dyn StepProgress,
) -> SurfaceFiles {
    if request.is_empty() {
        return SurfaceFiles::default();
    }
    made_files(request, input, poses, progress)
        .unwrap_or_else(|error| SurfaceFiles::failed(format!("no surface: {error}")))
}

fn made_files(
    request: &SurfaceRequest,
    input: &SequenceInput,
    poses: &[(Stamp, Pose3)],
    progress: &dyn StepProgress,
) -> Result<SurfaceFiles, AppError> {
    let mut surface = Surface::new(request)?;
    let is_interrupted = surface.integrate_all(input, poses, progress)?;
    surface.warn_if_full();
    Ok(SurfaceFiles { is_interrupted, ..surface.files(request, &input.path)? })
}

/// The pose at a stamp.
fn pose_at(poses: &[(Stamp, Pose3)], stamp: Stamp) -> Option<Pose3> {
    poses.binary_search_by_key(&stamp, |(at, _)| *at).ok().map(|index| poses[index].1)
}

/// The surface of the images so far.
struct Surface {
    map: SurfaceMap,
    voxels: Option<OccupiedVoxels>,
    last: Option<(Stamp, Pose3)>,
    images: usize,
    seconds: f64,
}

impl Surface {
    fn new(request: &SurfaceRequest) -> Result<Self, AppError> {
        let octree = request.octomap.as_ref().map(|_| OccupiedVoxels::new(request.octomap_resolution()));
        Ok(Self {
            map: SurfaceMap::new(request.config())?,
            voxels: octree.transpose()?,
            last: None,
            images: 0,
            seconds: 0.0,
        })
    }

    /// Integrates the images that have a pose and show something new. Returns whether the user ended it before the last one.
    fn integrate_all(
        &mut self,
        input: &SequenceInput,
        poses: &[(Stamp, Pose3)],
        progress: &dyn StepProgress,
    ) -> Result<bool, AppError> {
        let camera = input.camera.model.camera;
        let is_stopped = stop::stopped().is_some();
        // Images after the last pose need not be read.
        let Some((last, _)) = poses.last() else { return Ok(false) };
        progress.begin(Some(poses.len()));
        let mut is_interrupted = false;
        for (i, frame) in input.frames()?.enumerate() {
            let frame = frame?;
            // A signal that ended the tracking does not end the surface of the tracked images; a second one ends the program.
            let done = || format!("surface of {i} of {} images", poses.len());
            is_interrupted = frame.stamp() <= *last && !is_stopped && stop::is_requested(done);
            if is_interrupted || frame.stamp() > *last {
                break;
            }
            if let Some(pose) = pose_at(poses, frame.stamp())
                && self.is_due(frame.stamp(), pose)
                && let Ok(image) = frame.decode()
            {
                self.integrate(&image, &camera, pose)?;
            }
            progress.advance();
        }
        progress.end();
        Ok(is_interrupted)
    }

    /// Whether an image shows something new: the camera moved, or time passed.
    fn is_due(&self, stamp: Stamp, pose: Pose3) -> bool {
        self.last.is_none_or(|(at, last)| {
            let [x, y, z, turn @ ..]: [f64; 6] = (last.inverse() * pose).log().into();
            x.hypotenuse(y).hypotenuse(z) > MIN_DISTANCE_M
                || turn[0].hypotenuse(turn[1]).hypotenuse(turn[2]) > MIN_TURN_RAD
                || stamp - at > MAX_PAUSE_S
        })
    }

    fn integrate(&mut self, image: &RgbdImage, camera: &PinholeCamera, pose: Pose3) -> Result<(), AppError> {
        let clock = Instant::now();
        self.map.integrate(image, camera, &pose)?;
        self.seconds += clock.elapsed().as_secs_f64();
        if let Some(voxels) = &mut self.voxels {
            voxels.integrate(image, camera, &pose, self.map.config())?;
        }
        (self.last, self.images) = (Some((image.stamp(), pose)), self.images + 1);
        Ok(())
    }

    fn files(&mut self, request: &SurfaceRequest, input: &Path) -> Result<SurfaceFiles, AppError> {
        let smallest = MIN_PART_AREA_M2 / self.map.config().voxel.powi(2);
        let mesh = surface_mesh(&self.map).without_specks(smallest.ceil() as usize);
        if mesh.vertices.is_empty() {
            return Ok(SurfaceFiles::failed(self.failure(input)));
        }
        let mut files = Vec::new();
        if let Some((path, format)) = &request.mesh {
            let bytes = match format {
                MeshFormat::Glb => glb_bytes(&data_of(&mesh)),
                MeshFormat::Ply => ply_bytes(&data_of(&mesh)),
            };
            files.push((path.clone(), bytes));
        }
        if let Some(path) = &request.cloud {
            files.push((path.clone(), ply_bytes(&SurfaceData { triangles: &[], ..data_of(&mesh) })));
        }
        if let (Some(path), Some(voxels)) = (&request.octomap, &mut self.voxels) {
            voxels.mark_surface(&mesh)?;
            let states = voxels.iter().map(|(voxel, state)| (voxel, state == VoxelState::Occupied));
            files.push((path.clone(), octomap_bytes(voxels.resolution(), states)));
        }
        if let Some(path) = &request.heights {
            files.extend(heights_of(&mesh, path, request.height_resolution())?);
        }
        Ok(SurfaceFiles { files, rows: self.rows(&mesh), ..SurfaceFiles::default() })
    }

    /// Reason why there is no surface.
    fn failure(&self, input: &Path) -> String {
        let (config, images) = (self.map.config(), self.images);
        let (near, far) = (config.min_depth, config.max_depth);
        format!(
            "{}: no surface: {images} images with a pose were used, and none shows a surface twice between {near} and {far} m",
            input.display()
        )
    }

    /// A warning if the map has no room for more.
    fn warn_if_full(&self) {
        if self.map.is_full() || self.voxels.as_ref().is_some_and(OccupiedVoxels::is_full) {
            tracing::warn!(
                "the surface is full: what later images show is missing; give larger voxels than {} m (--voxel)",
                self.map.config().voxel
            );
        }
    }

    fn rows(&self, mesh: &SurfaceMesh) -> Vec<Vec<String>> {
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        vec![
            row("images in the surface", self.images.to_string()),
            row("surface, triangles", format!("{:.1} m^2, {}", mesh.area(), mesh.triangles.len())),
            row("memory of the voxels", format!("{:.0} MB", self.map.memory() as f64 / 1e6)),
            row(
                "surface, wall clock an image",
                format!("{:.1} ms", 1e3 * self.seconds / self.images.max(1) as f64),
            ),
        ]
    }
}

/// The picture of the heights and its description.
fn heights_of(mesh: &SurfaceMesh, path: &Path, resolution: f64) -> Result<Vec<(PathBuf, Vec<u8>)>, AppError> {
    let Some(map) = HeightMap::of(mesh, resolution, HEIGHT_MAP_CEILING_M)? else {
        tracing::warn!(
            "{}: no upward surface below {HEIGHT_MAP_CEILING_M} m was seen: not written",
            path.display()
        );
        return Ok(Vec::new());
    };
    let grid = HeightGrid {
        resolution: map.resolution,
        origin: map.origin,
        width: map.width,
        heights: &map.heights,
    };
    let written = height_files(path, &grid)?;
    Ok(vec![
        (path.to_owned(), written.picture),
        (heights_description(path), written.description.into_bytes()),
    ])
}

fn data_of(mesh: &SurfaceMesh) -> SurfaceData<'_> {
    SurfaceData {
        vertices: &mesh.vertices,
        normals: &mesh.normals,
        colors: &mesh.colors,
        triangles: &mesh.triangles,
    }
}
