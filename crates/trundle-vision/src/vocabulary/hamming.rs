//! The nearest of several descriptors.

use crate::Descriptor;

/// Index and distance of the nearest of `candidates`, the first of equally near ones; `None` if there is none.
#[inline]
pub(super) fn nearest(candidates: &[Descriptor], descriptor: &Descriptor) -> Option<(usize, u32)> {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("popcnt") {
        // SAFETY: the processor has the one feature that the function is compiled for.
        return unsafe { nearest_by_popcnt(candidates, descriptor) };
    }
    nearest_plainly(candidates, descriptor)
}

/// Calls [`nearest_plainly`], compiled for the POPCNT instruction, which counts the set bits of a word. The baseline of x86-64 lacks
/// that instruction.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "popcnt")]
fn nearest_by_popcnt(candidates: &[Descriptor], descriptor: &Descriptor) -> Option<(usize, u32)> {
    nearest_plainly(candidates, descriptor)
}

#[inline(always)]
fn nearest_plainly(candidates: &[Descriptor], descriptor: &Descriptor) -> Option<(usize, u32)> {
    let mut best: Option<(usize, u32)> = None;
    for (i, candidate) in candidates.iter().enumerate() {
        let distance = candidate.distance(descriptor);
        if best.is_none_or(|(_, min)| distance < min) {
            best = Some((i, distance));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn both_ways_find_the_first_of_the_nearest(
            // Few distinct bits, so that ties are common.
            words in prop::collection::vec(prop::array::uniform4(0..8_u64), 0..20), asked in prop::array::uniform4(0..8_u64),
        ) {
            let candidates: Vec<Descriptor> = words.into_iter().map(Descriptor).collect();
            let asked = Descriptor(asked);
            let expected = candidates.iter().map(|c| c.distance(&asked)).enumerate().min_by_key(|(_, d)| *d);
            prop_assert_eq!(nearest_plainly(&candidates, &asked), expected);
            prop_assert_eq!(nearest(&candidates, &asked), expected);
        }
    }
}
