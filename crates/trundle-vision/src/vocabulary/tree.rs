use super::BagOfWords;
use crate::Descriptor;
use trundle_core::Invalid;

/// A node of a [`Vocabulary`]'s tree; a leaf is a word. The root is 0, and parents come before their children.
pub type NodeId = u32;

/// A tree of binary words: each node holds the bitwise median of the descriptors below it.
#[derive(Debug, Clone, PartialEq)]
pub struct Vocabulary {
    branching: usize,
    depth: usize,
    nodes: Vec<Node>,
}

/// Children of a node follow one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) descriptor: Descriptor,
    pub(super) parent: NodeId,
    pub(super) first_child: NodeId,
    /// 0: a leaf.
    pub(super) children: u32,
    /// Inverse document frequency of a leaf, ln(images / images with the word); 0 of an inner node.
    pub(super) weight: f32,
}

/// A node as files list them: its parent, whether it is a leaf, its descriptor and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ListedNode {
    pub(super) parent: NodeId,
    pub(super) is_leaf: bool,
    pub(super) descriptor: Descriptor,
    pub(super) weight: f32,
}

/// Most children of a node, and most levels below the root.
pub(super) const MOST_BRANCHING: usize = 64;
pub(super) const MOST_DEPTH: usize = 10;

impl Vocabulary {
    /// A tree from its nodes but the root, which may stand in any order with parents before children.
    ///
    /// # Errors
    /// When the shape is out of range, there is no node, a parent does not come before its child or is a leaf, a node
    /// has too many children or lies too deep, an inner node has none, or a weight is negative or not finite; the
    /// message names the node.
    pub(super) fn from_list(branching: usize, depth: usize, list: &[ListedNode]) -> Result<Self, Invalid> {
        trundle_core::require_in(
            "branching of the vocabulary",
            branching as f64,
            "",
            2.0,
            MOST_BRANCHING as f64,
        )?;
        trundle_core::require_in("depth of the vocabulary", depth as f64, "", 1.0, MOST_DEPTH as f64)?;
        if list.is_empty() {
            return Err(Invalid::new("nodes of the vocabulary", 0, "", "1 or more"));
        }
        let children = children_of(list, branching)?;
        let nodes = in_breadth(list, &children);
        let vocabulary = Self { branching, depth, nodes };
        vocabulary.check_depth()?;
        Ok(vocabulary)
    }

    /// Most children of a node.
    pub fn branching(&self) -> usize {
        self.branching
    }

    /// Levels below the root.
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Leaves.
    pub fn word_count(&self) -> usize {
        self.nodes.iter().skip(1).filter(|node| node.children == 0).count()
    }

    /// The word of a descriptor: from the root to the child of the nearest median, the first of equally near ones.
    pub fn word(&self, descriptor: &Descriptor) -> NodeId {
        let mut at = 0;
        while self.nodes[at as usize].children > 0 {
            at = self.nearest_child(at, descriptor);
        }
        at
    }

    /// The node of a word's path at `level` below the root, the word itself where the path is shorter: features of two
    /// images that fall under one node are worth comparing.
    pub fn node_of(&self, word: NodeId, level: usize) -> NodeId {
        let (mut at, mut up) = (word, self.level(word).saturating_sub(level));
        while up > 0 {
            at = self.nodes[at as usize].parent;
            up -= 1;
        }
        at
    }

    /// The words of an image, and the word of each of its features.
    pub fn describe(&self, descriptors: &[Descriptor]) -> (BagOfWords, Vec<NodeId>) {
        let words: Vec<NodeId> = descriptors.iter().map(|descriptor| self.word(descriptor)).collect();
        (BagOfWords::new(&words, |word| self.nodes[word as usize].weight), words)
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(super) fn set_weight(&mut self, word: NodeId, weight: f32) {
        self.nodes[word as usize].weight = weight;
    }

    fn nearest_child(&self, node: NodeId, descriptor: &Descriptor) -> NodeId {
        let node = self.nodes[node as usize];
        let (first, end) = (node.first_child, node.first_child + node.children);
        let distance = |i: NodeId| self.nodes[i as usize].descriptor.distance(descriptor);
        (first..end).min_by_key(|&i| distance(i)).expect("invariant: asked of a node with children")
    }

    fn level(&self, node: NodeId) -> usize {
        let (mut at, mut level) = (node, 0);
        while at != 0 {
            at = self.nodes[at as usize].parent;
            level += 1;
        }
        level
    }

    fn check_depth(&self) -> Result<(), Invalid> {
        let mut levels = vec![0; self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate().skip(1) {
            levels[i] = levels[node.parent as usize] + 1;
        }
        match levels.iter().max() {
            Some(&deepest) if deepest > self.depth => {
                let expected = format!("{} or fewer", self.depth);
                Err(Invalid::new("levels of the vocabulary", deepest, "", expected))
            }
            _ => Ok(()),
        }
    }
}

/// For the root (0) and each listed node (i + 1) its children.
fn children_of(list: &[ListedNode], branching: usize) -> Result<Vec<Vec<NodeId>>, Invalid> {
    let mut children = vec![Vec::new(); list.len() + 1];
    for (i, node) in list.iter().enumerate() {
        let name = |what: &str| format!("{what} of vocabulary node {}", i + 1);
        let parent = node.parent as usize;
        if parent > i || (parent > 0 && list[parent - 1].is_leaf) {
            return Err(Invalid::new(name("parent"), parent, "", "an inner node before it"));
        }
        if !(node.weight.is_finite() && node.weight >= 0.0) {
            return Err(Invalid::new(name("weight"), node.weight, "", "a finite number, 0 or more"));
        }
        children[parent].push(i as NodeId + 1);
        if children[parent].len() > branching {
            return Err(Invalid::new(
                name("place"),
                children[parent].len(),
                "",
                format!("{branching} children or fewer"),
            ));
        }
    }
    match list.iter().enumerate().find(|(i, node)| !node.is_leaf && children[i + 1].is_empty()) {
        Some((i, _)) => {
            Err(Invalid::new(format!("children of vocabulary node {}", i + 1), 0, "", "1 or more, or a leaf"))
        }
        None => Ok(children),
    }
}

/// The nodes level by level, so that the children of each follow one another.
fn in_breadth(list: &[ListedNode], children: &[Vec<NodeId>]) -> Vec<Node> {
    let blank =
        Node { descriptor: Descriptor::default(), parent: 0, first_child: 0, children: 0, weight: 0.0 };
    let mut nodes = vec![blank];
    let mut listed: Vec<NodeId> = vec![0];
    for at in 0..=list.len() {
        let own = &children[listed[at] as usize];
        nodes[at].first_child = nodes.len() as NodeId;
        nodes[at].children = own.len() as u32;
        for &child in own {
            let ListedNode { descriptor, weight, .. } = list[child as usize - 1];
            nodes.push(Node { descriptor, parent: at as NodeId, weight, ..blank });
            listed.push(child);
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(parent: NodeId, is_leaf: bool, bits: u64) -> ListedNode {
        ListedNode { parent, is_leaf, descriptor: Descriptor([bits, 0, 0, 0]), weight: 1.0 }
    }

    /// Root with two inner nodes of two leaves each.
    fn small() -> Vec<ListedNode> {
        vec![
            listed(0, false, 0x0F),
            listed(0, false, 0xF0),
            listed(1, true, 0x03),
            listed(2, true, 0x30),
            listed(1, true, 0x0C),
            listed(2, true, 0xC0),
        ]
    }

    #[test]
    fn a_descriptor_goes_down_to_the_nearest_leaf() {
        let tree = Vocabulary::from_list(2, 2, &small()).unwrap();
        assert_eq!(tree.word_count(), 4);
        let word = tree.word(&Descriptor([0x3C, 0, 0, 0]));
        assert_eq!(tree.nodes()[word as usize].descriptor.0[0], 0x0C, "below the first of equally near ones");
        let word = tree.word(&Descriptor([0xC0, 0, 0, 0]));
        let node = tree.node_of(word, 1);
        assert_eq!(tree.nodes()[node as usize].descriptor.0[0], 0xF0);
        assert_eq!((tree.node_of(word, 0), tree.node_of(word, 9)), (0, word));
    }

    #[test]
    fn broken_trees_are_refused_by_node() {
        let refused = |change: &dyn Fn(&mut Vec<ListedNode>)| {
            let mut list = small();
            change(&mut list);
            Vocabulary::from_list(2, 2, &list).unwrap_err().field
        };
        assert_eq!(refused(&|list| list[2].parent = 5), "parent of vocabulary node 3");
        assert_eq!(refused(&|list| list[4].parent = 3), "parent of vocabulary node 5");
        assert_eq!(refused(&|list| list[0].is_leaf = true), "parent of vocabulary node 3");
        assert_eq!(refused(&|list| list[5].weight = f32::NAN), "weight of vocabulary node 6");
        assert_eq!(refused(&|list| list[5].parent = 1), "place of vocabulary node 6");
        assert_eq!(refused(&|list| list[3].is_leaf = false), "children of vocabulary node 4");
        assert_eq!(refused(&|list| list.clear()), "nodes of the vocabulary");
        assert_eq!(Vocabulary::from_list(2, 1, &small()).unwrap_err().field, "levels of the vocabulary");
    }
}
