use crate::Descriptor;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Rounds of assignment and new medians at most; it hardly ever takes as many.
const MOST_ROUNDS: usize = 20;

/// At most `k` clusters of descriptors under the Hamming distance: members of each, by rising index, and medians.
///
/// Seeds by k-means++ \[Arthur07\], then Lloyd's rounds with the bitwise majority as the centre, which minimises the sum of
/// distances. Fewer clusters come out where there are fewer distinct descriptors.
pub(super) fn clusters(
    descriptors: &[Descriptor],
    members: &[u32],
    k: usize,
    rng: &mut ChaCha8Rng,
) -> Vec<(Descriptor, Vec<u32>)> {
    let mut centers = seeds(descriptors, members, k, rng);
    let mut assigned: Vec<u32> = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let nearest = |i: &u32| nearest_of(&centers, &descriptors[*i as usize]);
        let now: Vec<u32> = members.iter().map(nearest).collect();
        if now == assigned {
            break;
        }
        assigned = now;
        for (c, center) in centers.iter_mut().enumerate() {
            let own = assigned.iter().zip(members).filter(|(to, _)| **to as usize == c);
            if let Some(median) = majority(own.map(|(_, i)| &descriptors[*i as usize])) {
                *center = median;
            }
        }
    }
    let mut groups: Vec<(Descriptor, Vec<u32>)> = centers.into_iter().map(|c| (c, Vec::new())).collect();
    for (&to, &i) in assigned.iter().zip(members) {
        groups[to as usize].1.push(i);
    }
    groups.retain(|(_, own)| !own.is_empty());
    groups
}

/// k-means++: each seed is drawn with the square of its distance to the seeds before it.
fn seeds(descriptors: &[Descriptor], members: &[u32], k: usize, rng: &mut ChaCha8Rng) -> Vec<Descriptor> {
    let first = descriptors[members[rng.random_range(0..members.len())] as usize];
    let mut seeds = vec![first];
    let square = |i: u32, seed: &Descriptor| u64::from(descriptors[i as usize].distance(seed)).pow(2);
    let mut cost: Vec<u64> = members.iter().map(|&i| square(i, &first)).collect();
    while seeds.len() < k {
        let total: u64 = cost.iter().sum();
        if total == 0 {
            break;
        }
        let mut draw = rng.random_range(0..total);
        let drawn = cost.iter().position(|&c| {
            let is_it = draw < c;
            draw = draw.saturating_sub(c);
            is_it
        });
        let seed = descriptors[members[drawn.expect("invariant: the draw is below the total")] as usize];
        cost.iter_mut().zip(members).for_each(|(c, &i)| *c = (*c).min(square(i, &seed)));
        seeds.push(seed);
    }
    seeds
}

fn nearest_of(centers: &[Descriptor], descriptor: &Descriptor) -> u32 {
    let nearest = (0..).zip(centers).min_by_key(|(_, center)| center.distance(descriptor));
    nearest.expect("invariant: there is a centre").0
}

/// Each bit as most have it, 1 where half have it; `None` of nothing.
fn majority<'a>(descriptors: impl Iterator<Item = &'a Descriptor>) -> Option<Descriptor> {
    let mut ones = [0_u32; 256];
    let mut count = 0;
    for descriptor in descriptors {
        count += 1;
        for (word, ones) in descriptor.0.iter().zip(ones.chunks_exact_mut(64)) {
            for (bit, ones) in ones.iter_mut().enumerate() {
                *ones += (word >> bit & 1) as u32;
            }
        }
    }
    let bits = |ones: &[u32]| (0..64).fold(0, |word, bit| word | u64::from(2 * ones[bit] >= count) << bit);
    let words: Vec<u64> = ones.chunks_exact(64).map(bits).collect();
    (count > 0).then(|| Descriptor([words[0], words[1], words[2], words[3]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn well_parted_groups_are_found_and_their_centres_are_majorities() {
        let center = [0, u64::MAX, 0xFFFF_0000_FFFF_0000];
        let member =
            |i: u64| Descriptor([center[i as usize % 3] ^ 1 << (i % 64), center[i as usize % 3], 0, 0]);
        let descriptors: Vec<Descriptor> = (0..300).map(member).collect();
        let members: Vec<u32> = (0..300).collect();
        let mut found = clusters(&descriptors, &members, 3, &mut ChaCha8Rng::seed_from_u64(1));
        found.sort_by_key(|(_, own)| own[0]);
        for (c, (median, own)) in found.iter().enumerate() {
            assert_eq!(median.0, [center[c], center[c], 0, 0]);
            assert!(own.iter().all(|i| *i as usize % 3 == c) && own.len() == 100);
        }
    }

    #[test]
    fn equal_descriptors_are_one_cluster() {
        let descriptors = vec![Descriptor([5; 4]); 7];
        let found = clusters(&descriptors, &[0, 2, 6], 4, &mut ChaCha8Rng::seed_from_u64(1));
        assert_eq!(found, vec![(Descriptor([5; 4]), vec![0, 2, 6])]);
    }
}
