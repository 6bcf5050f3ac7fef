//! Pairs of similar descriptors.

use crate::Descriptor;

/// A pair of similar features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Match {
    /// Index in the first set.
    pub a: usize,
    /// Index in the second set.
    pub b: usize,
    /// Bits in which the descriptors differ, 0 to 256.
    pub distance: u32,
}

/// Pairs of descriptors each of which is the other's nearest, by rising `a`.
///
/// A pair differs in `max_distance` bits at most, and in both directions in fewer than `ratio` times as many as the next best \[Lowe04,
/// sec. 7.1\]; a `ratio` of 1 or more disables this test. Among equally near ones the lowest index is used. An exchange of `a` and `b`
/// gives the same pairs. Cost: one distance for each of a x b.
pub fn match_mutual(a: &[Descriptor], b: &[Descriptor], max_distance: u32, ratio: f32) -> Vec<Match> {
    let (from_a, from_b) = nearest_both_ways(a, b);
    let is_clear =
        |nearest: &Nearest| ratio >= 1.0 || (nearest.distance as f32) < ratio * nearest.next_distance as f32;
    let pair = |(i, nearest): (usize, &Nearest)| {
        let found = Match { a: i, b: nearest.index as usize, distance: nearest.distance };
        let back = from_b.get(found.b)?;
        let mutual = back.index as usize == i;
        (mutual && found.distance <= max_distance && is_clear(nearest) && is_clear(back)).then_some(found)
    };
    from_a.iter().enumerate().filter_map(pair).collect()
}

/// The best of the other set, and how near the second best is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Nearest {
    index: u32,
    distance: u32,
    next_distance: u32,
}

impl Nearest {
    /// Farther than any.
    const NONE: Self = Self { index: u32::MAX, distance: u32::MAX, next_distance: u32::MAX };

    fn offer(&mut self, index: u32, distance: u32) {
        // The condition is rarely true, so the time of this branch is negligible.
        if distance < self.next_distance {
            if distance < self.distance {
                *self = Self { index, distance, next_distance: self.distance };
            } else {
                self.next_distance = distance;
            }
        }
    }
}

/// For each of `a` the nearest of `b`, and for each of `b` the nearest of `a`.
fn nearest_both_ways(a: &[Descriptor], b: &[Descriptor]) -> (Vec<Nearest>, Vec<Nearest>) {
    let mut from_a = vec![Nearest::NONE; a.len()];
    let mut from_b = vec![Nearest::NONE; b.len()];
    let mut distances = vec![0; b.len()];
    for ((query, nearest), i) in a.iter().zip(&mut from_a).zip(0..) {
        measure(query, b, &mut distances);
        for ((&distance, back), j) in distances.iter().zip(&mut from_b).zip(0..) {
            nearest.offer(j, distance);
            back.offer(i, distance);
        }
    }
    (from_a, from_b)
}

/// The distances of `query` to each of `others`.
fn measure(query: &Descriptor, others: &[Descriptor], distances: &mut [u32]) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("popcnt") {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { measure_by_popcnt(query, others, distances) };
    }
    measure_plainly(query, others, distances);
}

/// The same as [`measure_plainly`] with the instruction that counts bits: the baseline of x86-64 does not have it.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "popcnt")]
fn measure_by_popcnt(query: &Descriptor, others: &[Descriptor], distances: &mut [u32]) {
    measure_plainly(query, others, distances);
}

#[inline(always)]
fn measure_plainly(query: &Descriptor, others: &[Descriptor], distances: &mut [u32]) {
    for (distance, other) in distances.iter_mut().zip(others) {
        *distance = query.distance(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_descriptors() -> impl Strategy<Value = Vec<Descriptor>> {
        // Few distinct bits, which makes ties frequent.
        let word = prop::array::uniform4(0..16u64);
        prop::collection::vec(word.prop_map(Descriptor), 0..24)
    }

    proptest! {
        #[test]
        fn pairs_are_mutual_nearest_neighbours(
            a in any_descriptors(), b in any_descriptors(), max in 0..6u32, ratio in 0.5..1.2_f32,
        ) {
            for pair in match_mutual(&a, &b, max, ratio) {
                prop_assert_eq!(pair.distance, a[pair.a].distance(&b[pair.b]));
                prop_assert!(pair.distance <= max);
                prop_assert!(b.iter().all(|other| a[pair.a].distance(other) >= pair.distance));
                prop_assert!(a.iter().all(|other| b[pair.b].distance(other) >= pair.distance));
                let rival = b.iter().enumerate().filter(|(j, _)| *j != pair.b).map(|(_, d)| a[pair.a].distance(d)).min();
                if let (Some(rival), true) = (rival, ratio < 1.0) {
                    prop_assert!((pair.distance as f32) < ratio * rival as f32);
                }
            }
        }

        #[test]
        fn exchanging_the_sets_exchanges_the_pairs(
            a in any_descriptors(), b in any_descriptors(), max in 0..6u32, ratio in 0.5..0.99_f32,
        ) {
            let mut back: Vec<Match> = match_mutual(&b, &a, max, ratio)
                .into_iter()
                .map(|m| Match { a: m.b, b: m.a, distance: m.distance })
                .collect();
            back.sort_by_key(|m| m.a);
            prop_assert_eq!(match_mutual(&a, &b, max, ratio), back);
        }
    }

    proptest! {
        #[test]
        fn counting_bits_by_one_instruction_changes_nothing(words in prop::collection::vec(any::<[u64; 4]>(), 1..20)) {
            let set: Vec<Descriptor> = words.into_iter().map(Descriptor).collect();
            let (mut plain, mut fast) = (vec![0; set.len()], vec![0; set.len()]);
            measure_plainly(&set[0], &set, &mut plain);
            measure(&set[0], &set, &mut fast);
            prop_assert_eq!(plain, fast);
        }
    }

    fn descriptor(bits: u32) -> Descriptor {
        Descriptor([if bits == 0 { 0 } else { u64::MAX >> (64 - bits) }, 0, 0, 0])
    }

    #[test]
    fn a_set_matches_itself_and_ties_go_to_the_lowest_index() {
        let set: Vec<Descriptor> = [0, 10, 20, 30].map(descriptor).to_vec();
        let pairs = match_mutual(&set, &set, 0, 0.8);
        assert_eq!(pairs, (0..4).map(|i| Match { a: i, b: i, distance: 0 }).collect::<Vec<_>>());
        let twins = [descriptor(5), descriptor(5)];
        assert_eq!(match_mutual(&twins, &twins, 9, 1.0), vec![Match { a: 0, b: 0, distance: 0 }]);
        assert_eq!(match_mutual(&twins, &twins, 9, 0.9), vec![]);
        assert_eq!(match_mutual(&set, &[], 256, 1.0), vec![]);
    }
}
