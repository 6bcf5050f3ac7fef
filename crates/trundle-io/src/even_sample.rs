//! A bounded, even sample of a sequence.

/// Every n-th element of a sequence, in order. n doubles each time the sample is full, so that the sample holds between a quarter and all of
/// its largest size.
#[derive(Debug, Clone, PartialEq)]
pub struct EvenSample<T> {
    elements: Vec<T>,
    max: usize,
    stride: usize,
    /// Number of elements until the next one of the sample.
    left_out: usize,
}

impl<T> EvenSample<T> {
    /// An empty sample with less than `max` elements, `max` at least 2.
    #[must_use]
    pub fn new(max: usize) -> Self {
        Self { elements: Vec::new(), max: max.max(2), stride: 1, left_out: 0 }
    }

    /// Takes the next element of the sequence into the sample, or drops it.
    pub fn push(&mut self, element: T) {
        if self.left_out > 0 {
            self.left_out -= 1;
            return;
        }
        self.elements.push(element);
        // Of a full sample the newest element may be dropped: the next one then stands where it was.
        self.left_out = self.stride - 1;
        if self.elements.len() >= self.max {
            self.drop_every_second();
        }
    }

    /// The elements of the sample, in order.
    #[must_use]
    pub fn elements(&self) -> &[T] {
        &self.elements
    }

    fn drop_every_second(&mut self) {
        let is_newest_dropped = self.elements.len().is_multiple_of(2);
        let mut k = 0;
        self.elements.retain(|_| {
            k += 1;
            k % 2 == 1
        });
        self.left_out += if is_newest_dropped { 0 } else { self.stride };
        self.stride *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sample_is_even_and_bounded_whatever_the_length() {
        for max in [2, 3, 8, 13, 1024] {
            let mut sample = EvenSample::new(max);
            for k in 0..5000_usize {
                sample.push(k);
                let elements = sample.elements();
                assert!(elements.len() < max && elements[0] == 0);
                assert!(4 * elements.len() >= max.min(k + 1), "{max} {k}: {}", elements.len());
                let steps: Vec<usize> = elements.windows(2).map(|pair| pair[1] - pair[0]).collect();
                assert!(steps.windows(2).all(|pair| pair[0] == pair[1]), "{max} {k}: {elements:?}");
            }
        }
    }
}
