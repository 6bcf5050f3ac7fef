use super::{SimArgs, start};
use crate::failure::Failure;
use std::path::Path;
use trundle::sim::import::{self, GltfOptions};
use trundle::sim::{Lights, Scene, World};

/// The scene that the arguments name: built in, or from a file.
///
/// # Errors
/// When there is none of that name, or a file is not what it should be; names the file and the item.
pub fn load(args: &SimArgs, name: &str) -> Result<Scene, Failure> {
    let file = Path::new(name);
    let kind = file.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let mut scene = match kind.as_deref() {
        Some("glb" | "gltf") => bare(args, file, gltf(args, file)?)?,
        _ => Scene::by_name(name, args.seed)?,
    };
    if let Some(start) = args.start {
        scene.start = start.0;
    }
    Ok(scene)
}

/// The built-in scenes, a row each.
pub fn list() -> Vec<Vec<String>> {
    Scene::NAMES.iter().map(|name| vec![(*name).to_owned()]).collect()
}

fn gltf(args: &SimArgs, file: &Path) -> Result<World, Failure> {
    let options = GltfOptions { up: args.up.axis(), ..GltfOptions::default() };
    let mesh = import::gltf(file, &options).map_err(|error| Failure::Input(error.to_string()))?;
    Ok(World::with_meshes(Vec::new(), vec![mesh], args.seed)?)
}

/// The scene of a file that says nothing of the robot: where the arguments say no start, it starts where there is room.
fn bare(args: &SimArgs, file: &Path, world: World) -> Result<Scene, Failure> {
    let start = match args.start {
        Some(start) => start.0,
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
