use super::{files::Files, start};
use crate::{console, failure::Failure, settings};
use std::path::{Path, PathBuf};
use trundle::core::Pose2;
use trundle::sim::import::{GltfOptions, RaisedMap, UpAxis};
use trundle::sim::scenes::file::{BaseLoader, SceneFile};
use trundle::sim::{Lights, Scene, World};

/// Files that the command line names are relative to where the program runs.
const HERE: Files = Files { folder: PathBuf::new() };

/// How a scene is made of its name.
#[derive(Debug, Clone, Copy)]
pub struct SceneOptions {
    /// Of everything that is drawn by chance.
    pub seed: u64,
    /// The axis of a mesh that points up.
    pub up: UpAxis,
    /// Where the robot starts, world frame, if not where the scene says.
    pub start: Option<Pose2>,
}

/// The scene of a name: built in, or from a file.
///
/// # Errors
/// When there is none of that name, or a file is not what it should be; names the file and the item.
pub fn load(name: &str, args: SceneOptions) -> Result<Scene, Failure> {
    let file = Path::new(name);
    let kind = file.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let mut scene = match kind.as_deref() {
        Some("toml") => described(file, args.seed)?,
        Some("glb" | "gltf") => {
            let options = GltfOptions { up: args.up, ..GltfOptions::default() };
            let mesh = HERE.gltf(file, &options).map_err(|error| Failure::Input(error.to_string()))?;
            let world = World::with_meshes(Vec::new(), vec![mesh], args.seed)?;
            warn_of_a_fallen_house(file, &world);
            bare(args, file, world)?
        }
        Some("yaml" | "yml") => {
            let walls = HERE.map(file, RaisedMap::default().wall_height);
            let walls = walls.map_err(|error| Failure::Input(error.to_string()))?;
            bare(args, file, World::new(walls, args.seed)?)?
        }
        _ => Scene::by_name(name, args.seed)?,
    };
    if let Some(start) = args.start {
        scene.start = start;
    }
    Ok(scene)
}

/// The built-in scenes, a row each: name and size.
pub fn list() -> Result<Vec<Vec<String>>, Failure> {
    let row = |name: &&str| {
        let (low, high) = Scene::by_name(name, 1)?.world.bounds();
        let size = high - low;
        Ok(vec![(*name).to_owned(), format!("{:.1} x {:.1} m", size.x, size.y)])
    };
    Scene::NAMES.iter().map(row).collect()
}

/// A scene file's scene.
fn described(file: &Path, seed: u64) -> Result<Scene, Failure> {
    let description: SceneFile = settings::read(file)?;
    let files = Files { folder: file.parent().unwrap_or(Path::new("")).to_owned() };
    description.build(&files, seed).map_err(|error| Failure::Input(format!("{}: {error}", file.display())))
}

/// A place for people is wider than it is high; what is not has probably been turned on its side.
fn warn_of_a_fallen_house(file: &Path, world: &World) {
    let (low, high) = world.bounds();
    let size = high - low;
    if size.z > size.x.min(size.y) {
        let (name, x, y, z) = (file.display(), size.x, size.y, size.z);
        console::warn(&format!(
            "{name} is {x:.1} x {y:.1} m and {z:.1} m high; if it lies on its side, say --up"
        ));
    }
}

/// The scene of a file that says nothing of the robot: where the arguments say no start, it starts where there is room.
fn bare(args: SceneOptions, file: &Path, world: World) -> Result<Scene, Failure> {
    let start = match args.start {
        Some(start) => start,
        None => start::roomy_place(&world)?.ok_or_else(|| {
            let problem =
                "no place with room for the robot was found, say where it starts with --start X,Y,DEG";
            Failure::Input(format!("{}: {problem}", file.display()))
        })?,
    };
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let lights = Lights::default();
    Ok(Scene { name, world, lights, people: Vec::new(), start, goal: start })
}
