use crate::failure::Failure;
use trundle::sim::Scene;

/// The scene that an argument names.
pub fn load(name: &str, seed: u64) -> Result<Scene, Failure> {
    Ok(Scene::by_name(name, seed)?)
}

/// The built-in scenes, a row each.
pub fn list() -> Vec<Vec<String>> {
    Scene::NAMES.iter().map(|name| vec![(*name).to_owned()]).collect()
}
