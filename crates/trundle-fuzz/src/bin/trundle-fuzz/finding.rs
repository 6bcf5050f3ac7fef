//! Inputs that broke a reader, saved under a name.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use trundle_fuzz::FuzzTarget;

/// Saves an input; prints its effect and the command to repeat it.
pub fn report(target: &FuzzTarget, input: &[u8], what: &str) -> Result<(), String> {
    let path = save(target.name, input).map_err(|error| format!("a finding cannot be saved: {error}"))?;
    println!("{}: {what} ({} bytes)", target.name, input.len());
    println!("  cargo xtask fuzz --target {} --input {}", target.name, path.display());
    Ok(())
}

fn save(name: &str, input: &[u8]) -> std::io::Result<PathBuf> {
    let mut hasher = DefaultHasher::new();
    input.hash(&mut hasher);
    let folder = Path::new("target/fuzz-findings").join(name);
    std::fs::create_dir_all(&folder)?;
    let path = folder.join(format!("{:016x}", hasher.finish()));
    std::fs::write(&path, input)?;
    Ok(path)
}
