//! Bags of binary words \[GalvezLopez12\]: what an image shows, as weighted words of a visual vocabulary.
//!
//! Problem: which of thousands of images shows this place? Idea: a tree of cluster centres cuts the space of
//! descriptors into words. An image is the set of its words, each weighted by its rarity. Images of one place
//! share rare words, and an inverted index finds them without a search of the others. Cost: branching x depth
//! distances a feature, and for a query the entries of its words.
//!
//! | \[GalvezLopez12\] | here | unit |
//! |---|---|---|
//! | k_w, L_w | [`VocabularyConfig`] `branching`, `depth` | |
//! | v_t | [`BagOfWords`] | L1 norm 1 |
//! | s(v1, v2), eq. 1 | [`BagOfWords::similarity`] | 0 to 1 |
//! | inverse index | [`PlaceIndex`] | |
//! | direct index | [`Vocabulary::node_of`] | |

mod bag;
mod builtin;
mod clusters;
mod compact;
mod dbow2;
mod entry_points;
mod hamming;
mod listed;
mod majority;
mod node_id;
mod place_index;
mod train;
mod tree;

pub use bag::BagOfWords;
pub use compact::VocabularyError;
pub use node_id::NodeId;
pub use place_index::PlaceIndex;
pub use train::VocabularyConfig;
pub use tree::Vocabulary;
