//! Items by an id that is never reused.

/// Items by an id that rises with each item and is never reused.
///
/// The slot of a removed item is reused. Memory is that of the largest number of items alive at once, and four bytes for each item ever
/// created.
#[derive(Debug, Clone)]
pub(crate) struct Arena<T> {
    /// The slot of each id, [`REMOVED_SLOT`] of a removed item.
    places: Vec<u32>,
    things: Vec<Option<T>>,
    free: Vec<u32>,
}

/// The slot of a removed item.
const REMOVED_SLOT: u32 = u32::MAX;

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { places: Vec::new(), things: Vec::new(), free: Vec::new() }
    }
}

impl<T> Arena<T> {
    /// Adds an item; returns its id.
    pub fn insert(&mut self, thing: T) -> usize {
        let place = self.free.pop().unwrap_or_else(|| {
            self.things.push(None);
            u32::try_from(self.things.len() - 1).expect("invariant: an arena holds less than 2^32 things")
        });
        self.things[place as usize] = Some(thing);
        self.places.push(place);
        self.places.len() - 1
    }

    /// Removes an item and returns it; `None` if it was removed before.
    pub fn remove(&mut self, number: usize) -> Option<T> {
        let place = std::mem::replace(self.places.get_mut(number)?, REMOVED_SLOT);
        let thing = self.things.get_mut(place as usize)?.take();
        self.free.push(place);
        thing
    }

    /// The thing; `None` if it was removed.
    pub fn get(&self, number: usize) -> Option<&T> {
        self.things.get(*self.places.get(number)? as usize)?.as_ref()
    }

    /// The thing; `None` if it was removed.
    pub fn get_mut(&mut self, number: usize) -> Option<&mut T> {
        self.things.get_mut(*self.places.get(number)? as usize)?.as_mut()
    }

    /// All items, by rising id.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (usize, &T)> {
        let thing = |place: u32| self.things.get(place as usize)?.as_ref();
        self.places.iter().enumerate().filter_map(move |(number, place)| Some((number, thing(*place)?)))
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.things.len() - self.free.len()
    }

    /// The id of the next item: higher than all earlier ids.
    pub fn bound(&self) -> usize {
        self.places.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_never_used_twice_and_slots_are() {
        let mut arena = Arena::default();
        let numbers: Vec<usize> = ["a", "b", "c"].into_iter().map(|thing| arena.insert(thing)).collect();
        assert_eq!((arena.remove(numbers[1]), arena.remove(numbers[1])), (Some("b"), None));
        assert_eq!(arena.insert("d"), 3);
        assert_eq!(arena.iter().collect::<Vec<_>>(), vec![(0, &"a"), (2, &"c"), (3, &"d")]);
        assert_eq!(arena.iter().next_back(), Some((3, &"d")));
        assert_eq!((arena.len(), arena.bound(), arena.things.len()), (3, 4, 3));
        assert_eq!((arena.get(1), arena.get(9), arena.get(3)), (None, None, Some(&"d")));
        assert!(arena.get_mut(1).is_none() && arena.remove(9).is_none());
    }
}
