//! Finds similar bags of words by an inverse index.

use super::{BagOfWords, NodeId};
use std::collections::BTreeMap;

/// The inverse index of \[GalvezLopez12\]: for each word the places that show it.
///
/// A query costs the entries of its words, plus memory for one number per place.
#[derive(Debug, Clone, Default)]
pub struct PlaceIndex {
    /// Entries by word, up to the largest word that a place has shown.
    shown: Vec<Vec<Entry>>,
    /// The slot of each place.
    slots: BTreeMap<u32, u32>,
    /// The place of each slot; a free slot retains its last place.
    places: Vec<u32>,
    free: Vec<u32>,
}

/// A place with a word. Places have slots, numbered without gaps: sums over places are an array.
#[derive(Debug, Clone, Copy)]
struct Entry {
    slot: u32,
    weight: f32,
}

/// Words that a place shares with the query.
#[derive(Debug, Clone, Copy, Default)]
struct Common {
    words: u32,
    similarity: f32,
}

impl PlaceIndex {
    /// The number of places.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Whether the index has no place.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Adds the words of `place`, which must be a new one.
    pub fn add(&mut self, place: u32, bag: &BagOfWords) {
        let slot = self.free.pop().unwrap_or(self.places.len() as u32);
        assert!(self.slots.insert(place, slot).is_none(), "invariant: place {place} is added once");
        if slot as usize == self.places.len() {
            self.places.push(place);
        }
        self.places[slot as usize] = place;
        let max = bag.entries().last().map_or(0, |(word, _)| *word as usize + 1);
        if self.shown.len() < max {
            self.shown.resize_with(max, Vec::new);
        }
        for &(word, weight) in bag.entries() {
            self.shown[word as usize].push(Entry { slot, weight });
        }
    }

    /// Removes `place`, which showed `bag`; no effect when it is unknown.
    pub fn remove(&mut self, place: u32, bag: &BagOfWords) {
        let Some(slot) = self.slots.remove(&place) else { return };
        for (word, _) in bag.entries() {
            if let Some(entries) = self.shown.get_mut(*word as usize) {
                entries.retain(|entry| entry.slot != slot);
            }
        }
        self.free.push(slot);
    }

    /// The places that share a word with `bag` and satisfy `is_asked_for`, with their similarities; the most similar first, among equal
    /// ones the lower number.
    pub fn query(&self, bag: &BagOfWords, is_asked_for: impl Fn(u32) -> bool) -> Vec<(u32, f32)> {
        self.query_sharing(bag, 0.0, is_asked_for)
    }

    /// [`PlaceIndex::query`] with a minimum number of shared words: `min_share` (0 to 1) of the largest number that any place shares with
    /// `bag`; 0.8 in \[MurArtal17\].
    pub fn query_sharing(
        &self,
        bag: &BagOfWords,
        min_share: f32,
        is_asked_for: impl Fn(u32) -> bool,
    ) -> Vec<(u32, f32)> {
        let common = self.common(bag);
        let shares = self.places.iter().zip(common).filter(|(_, common)| common.words > 0);
        let asked: Vec<(u32, Common)> = shares
            .map(|(place, common)| (*place, common))
            .filter(|(place, _)| is_asked_for(*place))
            .collect();
        let max = asked.iter().map(|(_, common)| common.words).max().unwrap_or(0);
        let enough = asked.iter().filter(|(_, common)| common.words as f32 >= min_share * max as f32);
        let mut found: Vec<(u32, f32)> = enough.map(|(place, common)| (*place, common.similarity)).collect();
        found.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        found
    }

    /// For each slot the common words of its place with `bag`, summed in the order of the words.
    fn common(&self, bag: &BagOfWords) -> Vec<Common> {
        let mut common = vec![Common::default(); self.places.len()];
        for &(word, weight) in bag.entries() {
            for entry in self.entries(word) {
                let common = &mut common[entry.slot as usize];
                common.words += 1;
                common.similarity += weight.min(entry.weight);
            }
        }
        common
    }

    fn entries(&self, word: NodeId) -> &[Entry] {
        self.shown.get(word as usize).map_or(&[], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bag(words: &[NodeId]) -> BagOfWords {
        BagOfWords::new(words, |word| 1.0 + word as f32)
    }

    #[test]
    fn places_with_too_few_common_words_are_left_out() {
        let mut index = PlaceIndex::default();
        let bags = [bag(&[1, 2, 3, 4, 5]), bag(&[1, 2, 3, 4]), bag(&[3, 4, 5]), bag(&[9])];
        (10..).zip(&bags).for_each(|(place, bag)| index.add(place, bag));
        let asked = bag(&[1, 2, 3, 4, 5]);
        let places = |min, allowed: fn(u32) -> bool| -> Vec<u32> {
            index.query_sharing(&asked, min, allowed).into_iter().map(|(place, _)| place).collect()
        };
        assert_eq!(places(0.0, |_| true), [10, 12, 11]);
        assert_eq!(places(0.8, |_| true), [10, 11]);
        assert_eq!(places(0.8, |place| place != 10), [11], "three of four are less than 0.8");
        assert_eq!((places(1.0, |place| place > 12), index.len()), (vec![], 4));
    }

    proptest! {
        /// Independent of insertions, removals and slots.
        #[test]
        fn the_index_finds_what_comparing_all_finds(
            steps in prop::collection::vec((0..12_u32, prop::collection::vec(1..30_u32, 0..12)), 1..60),
            asked in prop::collection::vec(1..30_u32, 0..12),
            left_out in 0..12_u32,
        ) {
            let (mut index, mut there) = (PlaceIndex::default(), BTreeMap::new());
            for (place, words) in steps {
                match there.remove(&place) {
                    Some(bag) => index.remove(place, &bag),
                    None => {
                        index.add(place, &bag(&words));
                        there.insert(place, bag(&words));
                    }
                }
            }
            let asked = bag(&asked);
            let compared = there.iter().map(|(place, bag)| (*place, asked.similarity(bag)));
            let mut expected: Vec<(u32, f32)> = compared.filter(|(p, s)| *s > 0.0 && *p != left_out).collect();
            expected.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            prop_assert_eq!(index.query(&asked, |place| place != left_out), expected);
            prop_assert_eq!(index.len(), there.len());
        }
    }
}
