//! The nodes of a vocabulary in the form of text files.

use super::tree::{MAX_BRANCHING, MAX_DEPTH, Tree};
use super::{NodeId, Vocabulary};
use crate::Descriptor;
use trundle_core::{Invalid, require_in};

/// A node of a text file: its parent, whether it is a leaf, its descriptor and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ListedNode {
    /// Number of the parent in the list, from 1; 0 is the root.
    pub parent: NodeId,
    pub is_leaf: bool,
    pub descriptor: Descriptor,
    pub weight: f32,
}

/// A tree from its nodes without the root, in any order with parents before children.
///
/// # Errors
/// When the shape is out of range or the list is empty. When a parent follows its child, or is a leaf. When a node has too many
/// children or is too deep, or an inner node has none. When a weight is negative or not finite. The error gives the node.
pub(super) fn from_list(branching: usize, depth: usize, list: &[ListedNode]) -> Result<Vocabulary, Invalid> {
    check_shape(branching, depth)?;
    if list.is_empty() {
        return Err(Invalid::new("nodes of the vocabulary", 0, "", "1 or more"));
    }
    let children = Children::of(list, branching)?;
    Vocabulary::from_tree(branching, depth, in_breadth(list, &children))
}

/// Passes a shape that a vocabulary may have.
pub(super) fn check_shape(branching: usize, depth: usize) -> Result<(), Invalid> {
    require_in("branching of the vocabulary", branching as f64, "", 2.0, MAX_BRANCHING as f64)?;
    require_in("depth of the vocabulary", depth as f64, "", 1.0, MAX_DEPTH as f64)?;
    Ok(())
}

/// The children of the root (0) and of each listed node (i + 1), one list after the other.
struct Children {
    /// Start of each node's children; one more at the end.
    first: Vec<usize>,
    nodes: Vec<NodeId>,
}

impl Children {
    fn of(list: &[ListedNode], branching: usize) -> Result<Self, Invalid> {
        let counts = counted(list, branching)?;
        let mut first = vec![0; counts.len() + 1];
        for (i, count) in counts.iter().enumerate() {
            first[i + 1] = first[i] + count;
        }
        let mut next = first.clone();
        let mut nodes = vec![0; list.len()];
        for (i, node) in (1..).zip(list) {
            let at = &mut next[node.parent as usize];
            nodes[*at] = i;
            *at += 1;
        }
        Ok(Self { first, nodes })
    }

    fn below(&self, node: NodeId) -> &[NodeId] {
        &self.nodes[self.first[node as usize]..self.first[node as usize + 1]]
    }
}

/// Number of children of each node, after validation.
fn counted(list: &[ListedNode], branching: usize) -> Result<Vec<usize>, Invalid> {
    let mut counts = vec![0; list.len() + 1];
    for (i, node) in list.iter().enumerate() {
        let name = |what: &str| format!("{what} of vocabulary node {}", i + 1);
        let parent = node.parent as usize;
        if parent > i || (parent > 0 && list[parent - 1].is_leaf) {
            return Err(Invalid::new(name("parent"), parent, "", "an inner node before it"));
        }
        check_weight(node.weight, i + 1)?;
        counts[parent] += 1;
        if counts[parent] > branching {
            return Err(Invalid::new(
                name("place"),
                counts[parent],
                "",
                format!("{branching} children or fewer"),
            ));
        }
    }
    match list.iter().zip(1..).find(|(node, i)| !node.is_leaf && counts[*i] == 0) {
        Some((_, i)) => {
            Err(Invalid::new(format!("children of vocabulary node {i}"), 0, "", "1 or more, or a leaf"))
        }
        None => Ok(counts),
    }
}

/// Passes a weight that a word may have.
pub(super) fn check_weight(weight: f32, node: usize) -> Result<(), Invalid> {
    if weight.is_finite() && weight >= 0.0 {
        return Ok(());
    }
    let name = format!("weight of vocabulary node {node}");
    Err(Invalid::new(name, weight, "", "a finite number, 0 or more"))
}

/// The nodes level by level.
fn in_breadth(list: &[ListedNode], children: &Children) -> Tree {
    let mut tree = Tree::with_capacity(list.len());
    let mut listed: Vec<NodeId> = Vec::with_capacity(list.len() + 1);
    listed.push(0);
    for at in 0..=list.len() {
        let below = children.below(listed[at]);
        tree.counts.push(below.len() as u8);
        for &child in below {
            let node = &list[child as usize - 1];
            tree.descriptors.push(node.descriptor);
            tree.weights.push(if node.is_leaf { node.weight } else { 0.0 });
            listed.push(child);
        }
    }
    tree
}

/// Root with two inner nodes of two leaves each.
#[cfg(test)]
pub(super) fn small() -> Vec<ListedNode> {
    let listed = |parent, is_leaf, bits| ListedNode {
        parent,
        is_leaf,
        descriptor: Descriptor([bits, 0, 0, 0]),
        weight: 1.0,
    };
    vec![
        listed(0, false, 0x0F),
        listed(0, false, 0xF0),
        listed(1, true, 0x03),
        listed(2, true, 0x30),
        listed(1, true, 0x0C),
        listed(2, true, 0xC0),
    ]
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn broken_trees_are_refused_by_node() {
        let refused = |change: &dyn Fn(&mut Vec<ListedNode>)| {
            let mut list = small();
            change(&mut list);
            from_list(2, 2, &list).unwrap_err().field
        };
        assert_eq!(refused(&|list| list[2].parent = 5), "parent of vocabulary node 3");
        assert_eq!(refused(&|list| list[4].parent = 3), "parent of vocabulary node 5");
        assert_eq!(refused(&|list| list[0].is_leaf = true), "parent of vocabulary node 3");
        assert_eq!(refused(&|list| list[5].weight = f32::NAN), "weight of vocabulary node 6");
        assert_eq!(refused(&|list| list[5].parent = 1), "place of vocabulary node 6");
        assert_eq!(refused(&|list| list[3].is_leaf = false), "children of vocabulary node 4");
        assert_eq!(refused(&|list| list.clear()), "nodes of the vocabulary");
        assert_eq!(from_list(2, 1, &small()).unwrap_err().field, "levels of the vocabulary");
        assert_eq!(from_list(99, 2, &small()).unwrap_err().field, "branching of the vocabulary");
    }
}
