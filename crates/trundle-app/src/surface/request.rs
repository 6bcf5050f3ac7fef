//! Request for the files of a surface.

use crate::AppError;
use std::path::{Path, PathBuf};
use trundle_surface::SurfaceConfig;

/// Side of an octree's voxel over that of the surface \[1\]: planners in three dimensions need less detail than a display. Source: ours.
const OCTREE_RATIO: f64 = 2.5;
/// Smallest side of an octree's voxel and of a cell of the height map \[m\]. Source: ours.
const MIN_CELL_M: f64 = 0.05;

/// Largest side of an octree's voxel \[m\]. Source: the range of the octree.
const MAX_CELL_M: f64 = 1.0;

/// Format of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary glTF.
    Glb,
    /// Binary PLY.
    Ply,
}

/// The requested files of a surface.
#[derive(Debug, Clone, Default)]
pub struct SurfaceRequest {
    /// Triangles with colours.
    pub mesh: Option<(PathBuf, MeshFormat)>,
    /// Points with colours and normals, PLY.
    pub cloud: Option<PathBuf>,
    /// Free and occupied voxels, OctoMap's binary form.
    pub octomap: Option<PathBuf>,
    /// Heights over the floor, a 16-bit PNG and a YAML file.
    pub heights: Option<PathBuf>,
    /// Side of a voxel, m; `None` for the default.
    pub voxel: Option<f64>,
}

impl SurfaceRequest {
    /// A request for these files.
    ///
    /// # Errors
    /// When a name has another ending than its format, or the voxel's side is outside its range.
    pub fn new(
        mesh: Option<&Path>,
        cloud: Option<&Path>,
        octomap: Option<&Path>,
        heights: Option<&Path>,
        voxel: Option<f64>,
    ) -> Result<Self, AppError> {
        let mesh = mesh.map(|path| Ok::<_, AppError>((path.to_owned(), mesh_format(path)?))).transpose()?;
        let named = |path: Option<&Path>, ending| path.map(|path| require_ending(path, ending)).transpose();
        let request = Self {
            mesh,
            cloud: named(cloud, "ply")?,
            octomap: named(octomap, "bt")?,
            heights: named(heights, "png")?,
            voxel,
        };
        if let (Some((mesh, _)), Some(cloud)) = (&request.mesh, &request.cloud)
            && mesh.components().eq(cloud.components())
        {
            return Err(AppError::Input(format!(
                "{}: --mesh and --cloud name one file, expected two",
                mesh.display()
            )));
        }
        request.config().validated()?;
        request.refuse_idle_voxel()?;
        Ok(request)
    }

    /// Whether no file is requested.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.mesh.is_none() && self.cloud.is_none() && self.octomap.is_none() && self.heights.is_none()
    }

    /// Refuses a voxel's side without a file that has voxels.
    fn refuse_idle_voxel(&self) -> Result<(), AppError> {
        let Some(voxel) = self.voxel.filter(|_| self.is_empty()) else { return Ok(()) };
        Err(AppError::Input(format!(
            "--voxel {voxel} m has no effect without a surface, expected --mesh, --cloud, --octomap or --heights with it"
        )))
    }

    /// Paths of the files that are asked for.
    pub(super) fn paths(&self) -> impl Iterator<Item = PathBuf> {
        let mesh = self.mesh.as_ref().map(|(path, _)| path.clone());
        let description = self.heights.as_deref().map(heights_description);
        [mesh, self.cloud.clone(), self.octomap.clone(), self.heights.clone(), description]
            .into_iter()
            .flatten()
    }

    pub(super) fn config(&self) -> SurfaceConfig {
        let mut config = SurfaceConfig::default();
        config.voxel = self.voxel.unwrap_or(config.voxel);
        config
    }

    /// Side of an octree's voxel, m.
    pub(super) fn octomap_resolution(&self) -> f64 {
        (self.config().voxel * OCTREE_RATIO).clamp(MIN_CELL_M, MAX_CELL_M)
    }

    /// Side of a cell of the height map, m.
    pub(super) fn height_resolution(&self) -> f64 {
        self.config().voxel.max(MIN_CELL_M)
    }
}

/// The description beside the picture of the heights: `FILE.png.yaml`, which is no map's file.
pub(super) fn heights_description(picture: &Path) -> PathBuf {
    let mut name = picture.as_os_str().to_owned();
    name.push(".yaml");
    name.into()
}

fn mesh_format(path: &Path) -> Result<MeshFormat, AppError> {
    match ending(path).as_deref() {
        Some("glb") => Ok(MeshFormat::Glb),
        Some("ply") => Ok(MeshFormat::Ply),
        _ => Err(AppError::Input(format!("{}: a mesh is written as .glb or .ply", path.display()))),
    }
}

fn require_ending(path: &Path, expected: &str) -> Result<PathBuf, AppError> {
    if ending(path).as_deref() == Some(expected) {
        return Ok(path.to_owned());
    }
    Err(AppError::Input(format!("{}: expected a name that ends in .{expected}", path.display())))
}

fn ending(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}
