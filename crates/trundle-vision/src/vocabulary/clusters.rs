//! Clusters of binary descriptors, by k-medians.

use super::hamming::nearest;
use super::majority::BitCounts;
use crate::Descriptor;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Largest number of rounds of assignment and new medians. Source: ours.
const MAX_ROUNDS: usize = 20;

/// Smallest number of descriptors that a thread assigns at a time. Source: ours.
const MIN_BATCH: usize = 4096;

/// Descriptors at a small Hamming distance from each other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cluster {
    /// The bitwise majority of its members.
    pub median: Descriptor,
    /// Members in the order of the input.
    pub members: Vec<Descriptor>,
}

/// At most `k` clusters of descriptors under the Hamming distance, none of them empty.
///
/// Seeds by k-means++ \[Arthur07\], then Lloyd's rounds. The centre of a cluster is its bitwise majority, which minimises the sum
/// of distances. Fewer than `k` distinct descriptors give fewer clusters. The result is the same on any number of threads.
pub(super) fn clusters(descriptors: &[Descriptor], k: usize, rng: &mut ChaCha8Rng) -> Vec<Cluster> {
    let mut centers = seeds(descriptors, k, rng);
    let mut assigned = Vec::new();
    for _ in 0..MAX_ROUNDS {
        let now = assign(descriptors, &centers);
        if now == assigned {
            break;
        }
        assigned = now;
        move_to_medians(&mut centers, descriptors, &assigned);
    }
    let empty = |median| Cluster { median, members: Vec::new() };
    let mut found: Vec<Cluster> = centers.into_iter().map(empty).collect();
    for (&to, descriptor) in assigned.iter().zip(descriptors) {
        found[to].members.push(*descriptor);
    }
    found.retain(|cluster| !cluster.members.is_empty());
    found
}

/// Seeds by k-means++: the probability of a descriptor is proportional to the square of its distance from the nearest earlier seed.
fn seeds(descriptors: &[Descriptor], k: usize, rng: &mut ChaCha8Rng) -> Vec<Descriptor> {
    let mut seeds = vec![descriptors[rng.random_range(0..descriptors.len())]];
    let mut cost = vec![u64::MAX; descriptors.len()];
    while seeds.len() < k {
        let last = &seeds[seeds.len() - 1..];
        let square = |d: &Descriptor| nearest(last, d).map_or(0, |(_, distance)| u64::from(distance).pow(2));
        cost.iter_mut().zip(descriptors).for_each(|(cost, d)| *cost = (*cost).min(square(d)));
        let total: u64 = cost.iter().sum();
        if total == 0 {
            break;
        }
        let mut draw = rng.random_range(0..total);
        let drawn = cost.iter().position(|&cost| {
            let is_it = draw < cost;
            draw = draw.saturating_sub(cost);
            is_it
        });
        seeds.push(descriptors[drawn.expect("invariant: the draw is below the total")]);
    }
    seeds
}

/// Index of the nearest centre of each descriptor.
fn assign(descriptors: &[Descriptor], centers: &[Descriptor]) -> Vec<usize> {
    let to = |d: &Descriptor| nearest(centers, d).expect("invariant: there is a centre").0;
    descriptors.par_iter().with_min_len(MIN_BATCH).map(to).collect()
}

/// Moves each centre to the bitwise majority of the descriptors assigned to it. A centre without descriptors stays.
fn move_to_medians(centers: &mut [Descriptor], descriptors: &[Descriptor], assigned: &[usize]) {
    let mut counts = vec![BitCounts::new(); centers.len()];
    for (&to, descriptor) in assigned.iter().zip(descriptors) {
        counts[to].add(descriptor);
    }
    for (center, counts) in centers.iter_mut().zip(counts) {
        *center = counts.median().unwrap_or(*center);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn separated_groups_are_found_and_their_centres_are_majorities() {
        let center = [0, u64::MAX, 0xFFFF_0000_FFFF_0000];
        let member =
            |i: u64| Descriptor([center[i as usize % 3] ^ 1 << (i % 64), center[i as usize % 3], 0, 0]);
        let descriptors: Vec<Descriptor> = (0..300).map(member).collect();
        let mut found = clusters(&descriptors, 3, &mut ChaCha8Rng::seed_from_u64(1));
        assert_eq!(found.len(), 3);
        found.sort_by_key(|cluster| descriptors.iter().position(|d| *d == cluster.members[0]));
        for (c, cluster) in found.iter().enumerate() {
            assert_eq!(cluster.median.0, [center[c], center[c], 0, 0]);
            assert_eq!(cluster.members, descriptors.iter().copied().skip(c).step_by(3).collect::<Vec<_>>());
        }
    }

    #[test]
    fn equal_descriptors_are_one_cluster() {
        let descriptors = vec![Descriptor([5; 4]); 7];
        let found = clusters(&descriptors, 4, &mut ChaCha8Rng::seed_from_u64(1));
        assert_eq!(found, vec![Cluster { median: Descriptor([5; 4]), members: descriptors }]);
    }
}
