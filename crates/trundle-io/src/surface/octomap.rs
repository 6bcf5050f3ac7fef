//! OctoMap's binary form (`.bt`): an octree of 16 levels, two bits a child. Source: the format's description in \[Hornung13\].

use std::ops::Range;

/// Levels of the tree below its root. Source: \[Hornung13\].
const TREE_LEVELS: u32 = 16;
/// Key of the voxel at the origin: the middle of the tree.
const ORIGIN_KEY: i32 = 1 << (TREE_LEVELS - 1);
/// Codes of a child: no voxel known, all free, all occupied, or a node with children. Source: \[Hornung13\].
const UNKNOWN_CODE: u16 = 0b00;
const FREE_CODE: u16 = 0b01;
const OCCUPIED_CODE: u16 = 0b10;
const INNER_CODE: u16 = 0b11;

/// A voxel of the tree: its place along the curve that visits each octant whole, and whether it is occupied.
type Leaf = (u64, bool);

/// The voxels, in units of their side of `resolution` m, as OctoMap's binary file. `true` is occupied, `false` free. A voxel that is farther
/// than 32,767 sides from the origin is left out: OctoMap's tree ends there.
#[must_use]
pub fn octomap_bytes(resolution: f64, voxels: impl Iterator<Item = ([i32; 3], bool)>) -> Vec<u8> {
    let leaf = |(voxel, occupied): ([i32; 3], bool)| Some((place(voxel)?, occupied));
    let mut leaves: Vec<Leaf> = voxels.filter_map(leaf).collect();
    leaves.sort_unstable();
    leaves.dedup_by_key(|leaf| leaf.0);
    let mut tree = Tree { leaves: &leaves, bytes: Vec::new(), nodes: 0 };
    if !leaves.is_empty() {
        tree.write_node(0..leaves.len(), TREE_LEVELS);
    }
    let mut bytes = format!(
        "# Octomap OcTree binary file\n# written by trundle: metres, z up\nid OcTree\nsize {}\nres {resolution}\ndata\n",
        tree.nodes
    )
    .into_bytes();
    bytes.extend(tree.bytes);
    bytes
}

/// The bits of the three keys, interleaved: x lowest.
fn place(voxel: [i32; 3]) -> Option<u64> {
    let mut place = 0;
    for (axis, at) in voxel.into_iter().enumerate() {
        let key = u64::try_from(at.checked_add(ORIGIN_KEY)?).ok().filter(|key| *key < 1 << TREE_LEVELS)?;
        (0..TREE_LEVELS).for_each(|bit| place |= (key >> bit & 1) << (3 * bit + axis as u32));
    }
    Some(place)
}

struct Tree<'a> {
    leaves: &'a [Leaf],
    bytes: Vec<u8>,
    nodes: usize,
}

impl Tree<'_> {
    /// Writes a node with the leaves of `range`, `level` levels above the voxels, and the nodes below it.
    fn write_node(&mut self, range: Range<usize>, level: u32) {
        self.nodes += 1;
        let children = self.children(range, level);
        let codes = children.clone().map(|child| self.code(&child, level - 1));
        let word = codes.iter().enumerate().fold(0, |word, (i, code)| word | code << (2 * i));
        self.bytes.extend(word.to_le_bytes());
        for (child, code) in children.into_iter().zip(codes) {
            match code {
                INNER_CODE => self.write_node(child, level - 1),
                UNKNOWN_CODE => {}
                _ => self.nodes += 1,
            }
        }
    }

    /// The leaves of each child.
    fn children(&self, range: Range<usize>, level: u32) -> [Range<usize>; 8] {
        let octant = |leaf: &Leaf| leaf.0 >> (3 * (level - 1)) & 7;
        let mut start = range.start;
        std::array::from_fn(|child| {
            let count = self.leaves[start..range.end].partition_point(|leaf| octant(leaf) <= child as u64);
            let leaves = start..start + count;
            start += count;
            leaves
        })
    }

    /// Code of a child: a node whose voxels are all known and equal has no children.
    fn code(&self, range: &Range<usize>, level: u32) -> u16 {
        let leaves = &self.leaves[range.clone()];
        let Some(first) = leaves.first() else { return UNKNOWN_CODE };
        let is_whole = 1_usize.checked_shl(3 * level) == Some(leaves.len());
        match (is_whole && leaves.iter().all(|leaf| leaf.1 == first.1), first.1) {
            (false, _) => INNER_CODE,
            (true, false) => FREE_CODE,
            (true, true) => OCCUPIED_CODE,
        }
    }
}
