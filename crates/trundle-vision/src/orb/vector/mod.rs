//! Operations on rows of pixels, block by block. The kernels exist twice: for any processor, and for processors with AVX2 or NEON. Both
//! variants give equal bits, compared by their tests. The kernels are written once, against the operations of [`Bytes`] and the few others
//! that each family of processors defines here.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "aarch64")]
mod neon;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::{BLOCK_PX, Bytes, mix_16, shrink_8};
#[cfg(target_arch = "aarch64")]
pub(crate) use neon::{BLOCK_PX, Bytes, shrink_8};

/// Whether this processor has the features that the kernels are compiled for.
#[inline(always)]
pub(crate) fn is_available() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2");
    #[cfg(target_arch = "aarch64")]
    return std::arch::is_aarch64_feature_detected!("neon");
}

/// Start positions of blocks of `size` that cover `length`, which is at least `size`. The last block may overlap the previous one: single
/// pixels at the end of a row would cost as much as a block each.
#[inline(always)]
pub(crate) fn starts(length: usize, size: usize) -> impl Iterator<Item = usize> {
    (0..length).step_by(size).map(move |start| start.min(length - size))
}

/// The `N` elements from `start`. Panics if fewer exist.
#[inline(always)]
pub(crate) fn block<const N: usize, T>(slice: &[T], start: usize) -> &[T; N] {
    slice[start..].first_chunk().expect("invariant: a block lies within its row")
}

/// The `N` elements from `start`. Panics if fewer exist.
#[inline(always)]
pub(crate) fn block_mut<const N: usize, T>(slice: &mut [T], start: usize) -> &mut [T; N] {
    slice[start..].first_chunk_mut().expect("invariant: a block lies within its row")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test machine must have vectors: without them, the tests of the kernels would compare nothing.
    #[test]
    fn the_test_machine_has_vectors() {
        assert!(is_available());
    }
}
