//! Rows of pixels a block at a time, for the kernels that exist twice: for any processor, and for those with AVX2. Both give the
//! same bits, which their tests compare. This part is for processors of the x86-64 family alone.

use std::arch::x86_64::*;

/// Pixels of a block: as many as a register of AVX2 has bytes.
pub(crate) const BLOCK_PX: usize = 32;

/// Where blocks of `size` start that cover `length`, which is `size` or more. The last may overlap the one before: single pixels
/// at the end of a row would cost as much as a block each.
#[inline(always)]
pub(crate) fn starts(length: usize, size: usize) -> impl Iterator<Item = usize> {
    (0..length).step_by(size).map(move |start| start.min(length - size))
}

/// The `N` elements from `start`. Panics when there are fewer.
#[inline(always)]
pub(crate) fn block<const N: usize, T>(slice: &[T], start: usize) -> &[T; N] {
    slice[start..].first_chunk().expect("invariant: a block lies within its row")
}

/// The `N` elements from `start`. Panics when there are fewer.
#[inline(always)]
pub(crate) fn block_mut<const N: usize, T>(slice: &mut [T], start: usize) -> &mut [T; N] {
    slice[start..].first_chunk_mut().expect("invariant: a block lies within its row")
}

/// 32 bytes.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn load(from: &[u8; 32]) -> __m256i {
    // SAFETY: 32 bytes can be read, and need no alignment.
    unsafe { _mm256_loadu_si256(from.as_ptr().cast()) }
}

/// 16 bytes.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn load_half(from: &[u8; 16]) -> __m128i {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { _mm_loadu_si128(from.as_ptr().cast()) }
}

/// Eight words of 16 bits.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn load_half_words(from: &[i16; 8]) -> __m128i {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { _mm_loadu_si128(from.as_ptr().cast()) }
}

/// Sixteen words of 16 bits.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn store_words(to: &mut [i16; 16], value: __m256i) {
    // SAFETY: 32 bytes can be written, and need no alignment.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), value) }
}

/// 32 bytes.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn store(to: &mut [u8; 32], value: __m256i) {
    // SAFETY: 32 bytes can be written, and need no alignment.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), value) }
}
