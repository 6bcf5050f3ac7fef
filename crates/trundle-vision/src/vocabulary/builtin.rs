use super::Vocabulary;
use std::sync::{Arc, OnceLock};

/// The trained vocabulary that is part of the program; how it was made stands in `data/README.md` of the crate.
static BYTES: &[u8] = include_bytes!("../../data/vocabulary.bin");

static BUILTIN: OnceLock<Arc<Vocabulary>> = OnceLock::new();

impl Vocabulary {
    /// The vocabulary that is part of the program, read once: every call hands out the same one.
    pub fn builtin() -> Arc<Self> {
        let read =
            || Arc::new(Self::from_bytes(BYTES).expect("invariant: the program's own vocabulary is whole"));
        Arc::clone(BUILTIN.get_or_init(read))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_programs_own_vocabulary_is_whole_and_small() {
        assert!(BYTES.len() <= 12_000_000, "{} bytes", BYTES.len());
        let vocabulary = Vocabulary::builtin();
        assert!(Arc::ptr_eq(&vocabulary, &Vocabulary::builtin()));
        assert!(vocabulary.word_count() > 10_000, "{} words", vocabulary.word_count());
    }
}
