//! The vocabulary of the program.

use super::Vocabulary;
use std::sync::{Arc, OnceLock};

/// The built-in trained vocabulary; `data/README.md` of the crate describes its training.
static BYTES: &[u8] = include_bytes!("../../data/vocabulary.bin");

static BUILTIN: OnceLock<Arc<Vocabulary>> = OnceLock::new();

/// See [`Vocabulary::builtin`].
pub(super) fn builtin() -> Arc<Vocabulary> {
    let read =
        || Arc::new(Vocabulary::from_bytes(BYTES).expect("invariant: the program's own vocabulary is whole"));
    Arc::clone(BUILTIN.get_or_init(read))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// New training changes these numbers: set them to those of the new file.
    #[test]
    fn the_builtin_vocabulary_is_the_one_that_its_readme_describes() {
        assert!(BYTES.len() <= 12_000_000, "{} bytes", BYTES.len());
        let vocabulary = Vocabulary::builtin();
        assert!(Arc::ptr_eq(&vocabulary, &Vocabulary::builtin()));
        assert_eq!((vocabulary.branching(), vocabulary.depth()), (10, 5));
        assert_eq!((vocabulary.word_count(), BYTES.len()), (96_477, 3_923_508));
        // The reader has compared the checksum with the content.
        assert_eq!(BYTES[24..32], 0x7074_8058_D88E_9E62_u64.to_le_bytes());
        assert_eq!(vocabulary.to_bytes(), BYTES);
    }
}
