//! The glTF scene graph: every mesh instance with its transform.

use super::schema::at;
use crate::import::ImportFault;
use gltf::json::{Index, Node, Root, mesh};
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use trundle_core::Invalid;

/// A mesh of the file and its pose.
pub(super) struct Instance {
    pub(super) mesh: Index<mesh::Mesh>,
    /// `file_from_mesh`.
    pub(super) transform: Matrix4<f64>,
}

/// Every mesh of the scene, in the order of the file: its default scene, else its first, else all nodes without parent.
pub(super) fn instances(root: &Root) -> Result<Vec<Instance>, ImportFault> {
    let scene =
        root.scene.map(|scene| at(&root.scenes, scene, "scenes")).transpose()?.or(root.scenes.first());
    let roots = scene.map_or_else(|| orphans(root), |scene| scene.nodes.clone());
    let mut stack: Vec<(Index<Node>, Matrix4<f64>)> =
        roots.into_iter().rev().map(|node| (node, Matrix4::identity())).collect();
    let mut seen = vec![false; root.nodes.len()];
    let mut found = Vec::new();
    while let Some((index, parent)) = stack.pop() {
        let node = at(&root.nodes, index, "nodes")?;
        if std::mem::replace(&mut seen[index.value()], true) {
            return Err(Invalid::new(format!("node {index}"), "reached twice", "", "a tree of nodes").into());
        }
        let transform = parent * local(node);
        found.extend(node.mesh.map(|mesh| Instance { mesh, transform }));
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|&child| (child, transform)));
    }
    Ok(found)
}

fn orphans(root: &Root) -> Vec<Index<Node>> {
    let mut has_parent = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(has_parent) = has_parent.get_mut(child.value()) {
            *has_parent = true;
        }
    }
    (0..root.nodes.len()).filter(|&i| !has_parent[i]).map(|i| Index::new(i as u32)).collect()
}

/// `parent_from_node`.
fn local(node: &Node) -> Matrix4<f64> {
    if let Some(matrix) = node.matrix {
        return Matrix4::from_column_slice(&matrix.map(f64::from));
    }
    let vector = |v: [f32; 3]| Vector3::from(v.map(f64::from));
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_homogeneous();
    Matrix4::new_translation(&vector(node.translation.unwrap_or_default()))
        * turn
        * Matrix4::new_nonuniform_scaling(&vector(node.scale.unwrap_or([1.0; 3])))
}
