//! Scenes by name: built in, or from a file.

use super::free_start::free_start;
use super::scene_files::SceneFiles;
use std::path::{Path, PathBuf};
use trundle_app::{AppError, read_toml};
use trundle_core::Pose2;
use trundle_io::{Expected, FileKind};
use trundle_sim::import::{GltfOptions, RaisedMap, UpAxis};
use trundle_sim::scenes::file::{BaseLoader, SceneFile};
use trundle_sim::{Lights, Scene, SimConfig, Simulator, World};

/// Files on the command line are relative to the working folder.
const HERE: SceneFiles = SceneFiles { folder: PathBuf::new() };

/// Options for a scene given by name.
#[derive(Debug, Clone, Copy)]
pub struct SceneOptions {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Axis, scale and floor of a mesh.
    pub mesh: MeshOptions,
    /// Start of the robot, world frame, in place of the scene's.
    pub start: Option<Pose2>,
    /// A charging station, world frame: the middle of its front, x axis out of the front.
    pub station: Option<Pose2>,
}

/// Options for a scene made from a mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct MeshOptions {
    /// The axis of the file that points up.
    pub up: UpAxis,
    /// Metres per unit of the file; `None` is 1.
    pub scale: Option<f64>,
    /// Height of the floor, m; `None` to detect it.
    pub floor: Option<f64>,
}

impl MeshOptions {
    /// Refuses scale and floor for a scene that is no mesh.
    fn refuse_idle(self, name: &str) -> Result<(), AppError> {
        let scale = self.scale.map(|scale| format!("--scale {scale}"));
        let Some(option) = scale.or(self.floor.map(|floor| format!("--floor {floor}"))) else {
            return Ok(());
        };
        Err(AppError::Input(format!(
            "{name}: {option} has no effect on this scene, expected a .glb or .gltf with it"
        )))
    }

    fn import(self) -> GltfOptions {
        let Self { up, scale, floor } = self;
        let mut options = GltfOptions::default();
        options.up = up;
        options.scale = scale.unwrap_or(1.0);
        options.floor = floor;
        options
    }
}

/// The scene of a name: built in, or from a file.
///
/// # Errors
/// When no scene has this name, or a file is invalid; the error names the file and the item.
pub fn load_scene(name: &str, args: SceneOptions) -> Result<Scene, AppError> {
    let file = Path::new(name);
    let kind = file_kind(name)?;
    if !matches!(kind, Some(FileKind::Glb | FileKind::Gltf)) {
        args.mesh.refuse_idle(name)?;
    }
    let mut scene = match kind {
        Some(FileKind::Toml) => described(file, args.seed)?,
        Some(FileKind::Glb | FileKind::Gltf) => {
            let mesh =
                HERE.gltf(file, &args.mesh.import()).map_err(|error| AppError::Input(error.to_string()))?;
            let world = World::with_meshes(Vec::new(), vec![mesh], args.seed)?;
            warn_of_tall_scene(file, &world);
            bare(args, file, world)?
        }
        Some(FileKind::MapYaml) => {
            let walls = HERE.map(file, RaisedMap::default().wall_height);
            let walls = walls.map_err(|error| AppError::Input(error.to_string()))?;
            bare(args, file, World::new(walls, args.seed)?)?
        }
        _ => Scene::by_name(name, args.seed)?,
    };
    if let Some(start) = args.start {
        scene.start = start;
    }
    Ok(match args.station {
        Some(station) => scene.with_station(station)?,
        None => scene,
    })
}

/// A robot in the scene of a name; the options' seed is also the seed of the noise.
///
/// # Errors
/// Those of [`load_scene`], and when the robot does not fit at the start.
pub fn load_simulator(name: &str, options: SceneOptions, robot: SimConfig) -> Result<Simulator, AppError> {
    let scene = load_scene(name, options)?;
    Simulator::new(scene, robot, options.seed).map_err(|error| AppError::Input(format!("{name}: {error}")))
}

/// The kind of the file, if a scene's name is a file; else `None`.
fn file_kind(name: &str) -> Result<Option<FileKind>, AppError> {
    let is_file = !Scene::NAMES.contains(&name) && (name.contains(['.', '/']) || Path::new(name).exists());
    Ok(if is_file { Some(Expected::Scene.check(Path::new(name))?) } else { None })
}

/// The built-in scenes, one row each: name and size.
///
/// # Errors
/// When a built-in scene cannot be created.
pub fn list_scenes() -> Result<Vec<Vec<String>>, AppError> {
    let row = |name: &&str| {
        let (low, high) = Scene::by_name(name, 1)?.world.bounds();
        let size = high - low;
        Ok(vec![(*name).to_owned(), format!("{:.1} x {:.1} m", size.x, size.y)])
    };
    Scene::NAMES.iter().map(row).collect()
}

/// A scene file's scene.
fn described(file: &Path, seed: u64) -> Result<Scene, AppError> {
    let description: SceneFile = read_toml(file)?;
    let files = SceneFiles { folder: file.parent().unwrap_or(Path::new("")).to_owned() };
    description.build(&files, seed).map_err(|error| AppError::Input(format!("{}: {error}", file.display())))
}

/// Warns of a scene that is higher than wide, probably imported with the wrong up axis.
fn warn_of_tall_scene(file: &Path, world: &World) {
    let (low, high) = world.bounds();
    let size = high - low;
    if size.z > size.x.min(size.y) {
        let (name, x, y, z) = (file.display(), size.x, size.y, size.z);
        tracing::warn!("{name} is {x:.1} x {y:.1} m and {z:.1} m high; if it lies on its side, say --up");
    }
}

/// The scene of a file without a start pose. The robot starts at the pose of the arguments, else at a free pose.
fn bare(args: SceneOptions, file: &Path, world: World) -> Result<Scene, AppError> {
    let start = match args.start {
        Some(start) => start,
        None => free_start(&world)?.ok_or_else(|| {
            let problem =
                "no place with room for the robot was found, say where it starts with --start X,Y,DEG";
            AppError::Input(format!("{}: {problem}", file.display()))
        })?,
    };
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let lights = Lights::default();
    Ok(Scene { name, world, lights, people: Vec::new(), start, goal: start, station: None })
}
