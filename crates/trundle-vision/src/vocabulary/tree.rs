//! The tree of a vocabulary, and the words of an image.

use super::bag::BagOfWords;
use super::hamming::nearest;
use super::node_id::NodeId;
use crate::Descriptor;
use trundle_core::Invalid;

/// A tree of binary words: each node holds the bitwise median of the descriptors below it.
///
/// Nodes are sorted by level, so the children of a node are contiguous in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Vocabulary {
    branching: usize,
    depth: usize,
    /// Descriptor of node i + 1: the root has none.
    descriptors: Vec<Descriptor>,
    /// The children of node i are `first_child[i]..first_child[i + 1]`.
    first_child: Vec<NodeId>,
    /// Parent of each node; the root's parent is the root.
    parent: Vec<NodeId>,
    /// For a leaf its inverse document frequency, ln(images / images with the word); 0 for an inner node.
    weight: Vec<f32>,
    /// End of each level, the root's first.
    level_end: Vec<NodeId>,
}

/// The nodes of a tree level by level.
#[derive(Debug, Clone, Default)]
pub(super) struct Tree {
    /// Descriptors of all nodes except the root.
    pub descriptors: Vec<Descriptor>,
    /// Weights of all nodes except the root.
    pub weights: Vec<f32>,
    /// Children of each node and of the root, which is the first.
    pub counts: Vec<u8>,
}

impl Tree {
    /// Capacity for a number of nodes besides the root.
    pub fn with_capacity(nodes: usize) -> Self {
        Self {
            descriptors: Vec::with_capacity(nodes),
            weights: Vec::with_capacity(nodes),
            counts: Vec::with_capacity(nodes + 1),
        }
    }
}

/// Maximum number of children of a node: 64. A file with more is refused. Source: ours.
pub(super) const MAX_BRANCHING: usize = 64;
/// Maximum number of levels below the root: 10. A file with more is refused. Source: ours.
pub(super) const MAX_DEPTH: usize = 10;

impl Vocabulary {
    /// The vocabulary of a tree of this shape.
    ///
    /// # Errors
    /// When the counts are not those of a tree with this number of nodes, or the tree is deeper than `depth`.
    pub(super) fn from_tree(branching: usize, depth: usize, tree: Tree) -> Result<Self, Invalid> {
        let nodes = tree.descriptors.len() + 1;
        let first_child = first_children(&tree.counts, nodes)?;
        let mut parent = vec![0; nodes];
        for (i, children) in first_child.windows(2).enumerate() {
            parent[children[0] as usize..children[1] as usize].fill(i as NodeId);
        }
        let mut level_end = vec![1];
        while let Some(&end) = level_end.last().filter(|end| (**end as usize) < nodes) {
            level_end.push(first_child[end as usize]);
        }
        let levels = level_end.len() - 1;
        if levels > depth {
            return Err(Invalid::new("levels of the vocabulary", levels, "", format!("{depth} or fewer")));
        }
        let mut weight = vec![0.0];
        weight.extend(tree.weights);
        Ok(Self { branching, depth, descriptors: tree.descriptors, first_child, parent, weight, level_end })
    }

    /// Maximum number of children of a node.
    pub fn branching(&self) -> usize {
        self.branching
    }

    /// Levels below the root.
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Leaves.
    pub fn word_count(&self) -> usize {
        self.nodes().filter(|node| self.is_word(*node)).count()
    }

    /// The word of a descriptor: the path from the root to the child with the nearest median, the first among equally near ones.
    pub fn word(&self, descriptor: &Descriptor) -> NodeId {
        let mut at = 0;
        loop {
            let (first, end) = (self.first_child[at as usize], self.first_child[at as usize + 1]);
            let medians = &self.descriptors[first as usize - 1..end as usize - 1];
            match nearest(medians, descriptor) {
                Some((child, _)) => at = first + child as NodeId,
                None => return at,
            }
        }
    }

    /// The node of a word's path at `level` below the root, or the word itself for a shorter path. Features of two images below one node
    /// are candidates for a match.
    pub fn node_of(&self, word: NodeId, level: usize) -> NodeId {
        let Some(&end) = self.level_end.get(level) else { return word };
        let mut at = word;
        while at >= end {
            at = self.parent[at as usize];
        }
        at
    }

    /// The words of an image, and the word of each of its features.
    pub fn describe(&self, descriptors: &[Descriptor]) -> (BagOfWords, Vec<NodeId>) {
        let words: Vec<NodeId> = descriptors.iter().map(|descriptor| self.word(descriptor)).collect();
        (BagOfWords::new(&words, |word| self.weight(word)), words)
    }

    /// All nodes but the root, parents before children.
    pub(super) fn nodes(&self) -> impl ExactSizeIterator<Item = NodeId> + '_ {
        1..self.parent.len() as NodeId
    }

    pub(super) fn is_word(&self, node: NodeId) -> bool {
        self.children(node) == 0
    }

    pub(super) fn children(&self, node: NodeId) -> u32 {
        self.first_child[node as usize + 1] - self.first_child[node as usize]
    }

    pub(super) fn parent(&self, node: NodeId) -> NodeId {
        self.parent[node as usize]
    }

    /// Descriptor of any node except the root.
    pub(super) fn descriptor(&self, node: NodeId) -> &Descriptor {
        &self.descriptors[node as usize - 1]
    }

    pub(super) fn weight(&self, node: NodeId) -> f32 {
        self.weight[node as usize]
    }

    pub(super) fn set_weight(&mut self, word: NodeId, weight: f32) {
        self.weight[word as usize] = weight;
    }
}

/// Start of each node's children, and the end of the last node's.
fn first_children(counts: &[u8], nodes: usize) -> Result<Vec<NodeId>, Invalid> {
    let wrong = |found: usize| {
        Err(Invalid::new("children of all vocabulary nodes", found, "", format!("{} in all", nodes - 1)))
    };
    let mut first_child: Vec<NodeId> = Vec::with_capacity(counts.len() + 1);
    let mut next = 1;
    for (i, count) in counts.iter().enumerate() {
        // A node that is not a child of an earlier node.
        if i >= next {
            return wrong(next - 1);
        }
        first_child.push(next as NodeId);
        next += usize::from(*count);
    }
    if next != nodes || counts.len() != nodes {
        return wrong(next - 1);
    }
    first_child.push(next as NodeId);
    Ok(first_child)
}

#[cfg(test)]
mod tests {
    use super::super::listed::{from_list, small};
    use super::*;

    #[test]
    fn a_descriptor_goes_down_to_the_nearest_leaf() {
        let tree = from_list(2, 2, &small()).unwrap();
        assert_eq!((tree.word_count(), tree.nodes().len()), (4, 6));
        let word = tree.word(&Descriptor([0x3C, 0, 0, 0]));
        assert_eq!(tree.descriptor(word).0[0], 0x0C, "below the first of equally near ones");
        let word = tree.word(&Descriptor([0xC0, 0, 0, 0]));
        let node = tree.node_of(word, 1);
        assert_eq!(tree.descriptor(node).0[0], 0xF0);
        assert_eq!((tree.node_of(word, 0), tree.node_of(word, 2), tree.node_of(word, 9)), (0, word, word));
    }

    #[test]
    fn counts_that_are_not_a_tree_are_refused() {
        let tree = |counts: &[u8]| Tree {
            descriptors: vec![Descriptor::default(); 4],
            weights: vec![0.0; 4],
            counts: counts.to_vec(),
        };
        assert!(Vocabulary::from_tree(2, 3, tree(&[2, 2, 0, 0, 0])).is_ok());
        for counts in
            [&[2, 2, 0, 0][..], &[2, 2, 0, 0, 1], &[0, 2, 2, 0, 0], &[2, 1, 0, 0, 1], &[2, 0, 0, 2, 0]]
        {
            let error = Vocabulary::from_tree(2, 3, tree(counts)).unwrap_err();
            assert_eq!(error.field, "children of all vocabulary nodes", "{counts:?}");
        }
        assert_eq!(
            Vocabulary::from_tree(2, 1, tree(&[2, 2, 0, 0, 0])).unwrap_err().field,
            "levels of the vocabulary"
        );
    }
}
