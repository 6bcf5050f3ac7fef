//! Set of free stretches of a beam, as bits of range bins.

/// A set of stretches of a beam, as 128 bins of equal length up to the greatest range.
pub(super) type SpanBits = u128;

/// Number of bins of a beam. Source: ours.
pub(super) const BIN_COUNT: usize = 128;

/// `BELOW[n]`: the first `n` bins.
pub(super) const BELOW: [SpanBits; BIN_COUNT + 1] = {
    let mut table = [0; BIN_COUNT + 1];
    let mut n = 1;
    while n <= BIN_COUNT {
        table[n] = (table[n - 1] << 1) | 1;
        n += 1;
    }
    table
};

/// The bins from `from` up to, but without, `to`.
#[inline]
pub(super) fn bins(from: usize, to: usize) -> SpanBits {
    BELOW[to.min(BIN_COUNT)] & !BELOW[from.min(BIN_COUNT)]
}

/// Closes gaps of one bin.
pub(super) fn bridged(bits: SpanBits) -> SpanBits {
    bits | ((bits << 1) & (bits >> 1))
}

/// The runs of neighbouring bins, each as its first bin and the bin after its last.
pub(super) fn spans(mut bits: SpanBits) -> impl Iterator<Item = (usize, usize)> {
    let mut shifted = 0;
    std::iter::from_fn(move || {
        if bits == 0 {
            return None;
        }
        let gap = bits.trailing_zeros() as usize;
        bits >>= gap;
        let length = bits.trailing_ones() as usize;
        bits = if length == BIN_COUNT { 0 } else { bits >> length };
        let from = shifted + gap;
        shifted = from + length;
        Some((from, shifted))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stretches_by_hand() {
        assert_eq!(spans(0).count(), 0);
        assert_eq!(spans(u128::MAX).collect::<Vec<_>>(), [(0, 128)]);
        assert_eq!(spans(bins(3, 5) | bins(127, 128)).collect::<Vec<_>>(), [(3, 5), (127, 128)]);
        assert_eq!(bins(5, 3) | bins(128, 200), 0);
        assert_eq!(bridged(bins(0, 3) | bins(4, 6) | bins(8, 9)), bins(0, 6) | bins(8, 9));
    }

    proptest! {
        #[test]
        fn stretches_put_together_are_the_set(bits: u128) {
            prop_assert_eq!(spans(bits).fold(0, |sum, (from, to)| sum | bins(from, to)), bits);
        }
    }
}
