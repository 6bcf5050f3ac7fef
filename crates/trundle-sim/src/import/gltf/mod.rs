//! glTF 2.0: JSON or GLB, with embedded or separate buffers and textures.

mod accessor;
mod buffers;
mod builder;
mod container;
mod floor;
mod mesh_materials;
mod nodes;
mod options;
mod primitive;
mod schema;
mod size;
mod srgb;
mod textures;
mod vertex_colors;

use super::{ImportError, ImportFault, ImportNote};
use crate::world::Mesh;
use buffers::{Buffers, Resolve};
use builder::Builder;
use container::Container;
pub use options::{GltfOptions, UpAxis};
use std::path::Path;

/// A scene as imported.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedScene {
    /// Surfaces of the file, world frame.
    pub mesh: Mesh,
    /// Notes for the user.
    pub notes: Vec<ImportNote>,
}

/// Reads a glTF 2.0 file, `.gltf` or `.glb`, as one mesh in the world frame, m, z up.
///
/// Supported geometry: the default scene with its nodes' transforms; triangle lists, strips and fans, indexed or not, sparse or quantised.
/// Supported materials: the base colour and its texture (PNG or JPEG, opaque and two-sided; alpha is ignored), KHR_texture_transform, and
/// vertex colours without a texture. Textures repeat. A missing or unsupported texture is grey and gives a note. Triangles without area are
/// left out. Ignored: skins, morph targets, animations, other maps of the material, cameras and lights.
///
/// The floor, the lowest large level, is moved to z = 0 if it is elsewhere.
///
/// The up axis is the standard's, +y, unless `options` sets another: a z-up file without this option is rotated by 90 deg.
///
/// # Errors
/// When a file or a buffer is missing, truncated or broken, a number is not finite, an index is out of range, the file requires an
/// extension such as Draco compression, or has no triangle. The error names the file and the item.
pub fn gltf(path: &Path, options: &GltfOptions) -> Result<ImportedScene, ImportError> {
    let file = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|e| ImportFault::Unreadable { reason: e.to_string() }.of(&file))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    gltf_from_bytes(&file, &bytes, options, &|name| std::fs::read(folder.join(name)))
}

/// As [`gltf()`], from the bytes of a file called `file` in messages; `resolve` reads the separate files.
///
/// # Errors
/// As [`gltf()`].
pub fn gltf_from_bytes(
    file: &str,
    bytes: &[u8],
    options: &GltfOptions,
    resolve: &(dyn Fn(&str) -> std::io::Result<Vec<u8>> + Sync),
) -> Result<ImportedScene, ImportError> {
    read(bytes, options, resolve).map_err(|fault| fault.of(file))
}

fn read(bytes: &[u8], options: &GltfOptions, resolve: Resolve<'_>) -> Result<ImportedScene, ImportFault> {
    let options = options.clone().validated()?;
    let container = Container::open(bytes)?;
    let root = schema::parse(container.json)?;
    let buffers = Buffers::load(&root, &container, resolve)?;
    let world_from_file = options.world_from_file();
    let mut builder = Builder::new(&buffers);
    for instance in nodes::instances(&root)? {
        builder.add(instance.mesh, &(world_from_file * instance.transform))?;
    }
    let (mut mesh, mut notes) = builder.build()?;
    if options.finds_floor()
        && let Some(height_m) = floor::floor_elsewhere(mesh.positions(), mesh.triangles())
    {
        mesh = mesh.lowered(height_m)?;
        notes.push(ImportNote::FloorMoved { height_m });
    }
    notes.extend(size::odd_size(mesh.size()));
    Ok(ImportedScene { mesh, notes })
}
