//! Training, built-in vocabulary and file formats.

use super::{Vocabulary, VocabularyConfig, VocabularyError, builtin, compact, dbow2, train};
use crate::Descriptor;
use std::sync::Arc;
use trundle_core::Invalid;

impl Vocabulary {
    /// The vocabulary that is part of the program, read once: every call hands out the same one.
    pub fn builtin() -> Arc<Self> {
        builtin::builtin()
    }

    /// Trains a vocabulary on the descriptors of many images: hierarchical k-medians, words weighted by ln(images /
    /// images that show them). A word that none shows (each was nearer to another median in the end) weighs as much as one
    /// that a single image shows. The same images and seed give the same tree on any number of threads.
    ///
    /// # Errors
    /// When the configuration is invalid or no descriptor is given.
    pub fn train(images: &[Vec<Descriptor>], config: &VocabularyConfig, seed: u64) -> Result<Self, Invalid> {
        train::train(images, config, seed)
    }

    /// The vocabulary as bytes with version and checksum, little endian. They are the head, the descriptors of all nodes level by level (32
    /// bytes each), the number of children of the root and each node (a byte each), and the weights of the words (4 bytes each).
    pub fn to_bytes(&self) -> Vec<u8> {
        compact::to_bytes(self)
    }

    /// Reads [`Vocabulary::to_bytes`].
    ///
    /// # Errors
    /// When the bytes are of another kind or version, cut off, damaged, or the nodes are not a tree.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, VocabularyError> {
        compact::from_bytes(bytes)
    }

    /// The text format of DBoW2 for ORB-SLAM programs. The first line is `branching depth 0 0` (L1 score, tf-idf weights); each node, in
    /// the order of numbers from 1, is a line `parent is_leaf 32 bytes weight`. The text has no newline at its end: some readers would read
    /// another node after it.
    pub fn to_dbow2_text(&self) -> String {
        dbow2::to_text(self)
    }

    /// Reads the text form of DBoW2 (see [`Vocabulary::to_dbow2_text`]). Nodes get new numbers, level by level; scores
    /// and weights other than L1 and tf-idf are taken as these.
    ///
    /// # Errors
    /// When a line is invalid, with its number, or the nodes are not a tree.
    pub fn from_dbow2_text(text: &str) -> Result<Self, VocabularyError> {
        dbow2::from_text(text)
    }
}
