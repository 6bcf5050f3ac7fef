use super::{BagOfWords, NodeId};
use std::collections::BTreeMap;

/// The inverse index of \[GalvezLopez12\]: for each word the places that show it.
#[derive(Debug, Clone, Default)]
pub struct PlaceIndex {
    places_of: BTreeMap<NodeId, Vec<(u32, f32)>>,
}

impl PlaceIndex {
    /// Adds what `place` shows.
    pub fn add(&mut self, place: u32, bag: &BagOfWords) {
        for &(word, weight) in bag.entries() {
            self.places_of.entry(word).or_default().push((place, weight));
        }
    }

    /// Forgets `place`, which showed `bag`.
    pub fn remove(&mut self, place: u32, bag: &BagOfWords) {
        for (word, _) in bag.entries() {
            if let Some(places) = self.places_of.get_mut(word) {
                places.retain(|(other, _)| *other != place);
                if places.is_empty() {
                    self.places_of.remove(word);
                }
            }
        }
    }

    /// The places that share a word with `bag` and that `is_asked_for`, with their similarities, the most similar
    /// first, of equal ones the lower number.
    pub fn query(&self, bag: &BagOfWords, is_asked_for: impl Fn(u32) -> bool) -> Vec<(u32, f32)> {
        let mut similarity: BTreeMap<u32, f32> = BTreeMap::new();
        for (word, weight) in bag.entries() {
            for (place, other) in self.places_of.get(word).into_iter().flatten() {
                if is_asked_for(*place) {
                    *similarity.entry(*place).or_default() += weight.min(*other);
                }
            }
        }
        let mut found: Vec<(u32, f32)> = similarity.into_iter().collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_says_what_comparing_all_says() {
        let bag = |words: &[NodeId]| BagOfWords::new(words, |word| 1.0 + word as f32);
        let bags = [bag(&[1, 2, 3]), bag(&[3, 4]), bag(&[7]), bag(&[2, 2, 3])];
        let mut index = PlaceIndex::default();
        (0..).zip(&bags).for_each(|(place, bag)| index.add(place, bag));
        let asked = bag(&[2, 3, 3]);
        let found = index.query(&asked, |place| place != 1);
        let places: Vec<u32> = found.iter().map(|(place, _)| *place).collect();
        assert_eq!(places, [0, 3]);
        for (place, similarity) in found {
            assert_eq!(similarity, asked.similarity(&bags[place as usize]));
        }
        index.remove(0, &bags[0]);
        assert_eq!(index.query(&asked, |_| true)[0].0, 3);
        assert_eq!(index.query(&bag(&[7]), |_| true), [(2, 1.0)]);
    }
}
