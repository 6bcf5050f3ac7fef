//! The queue of a perception job holds the newest image.

use super::*;
use proptest::prelude::*;

fn image(seconds: f64) -> LazyImage {
    LazyImage::new(Stamp::default().after(seconds), || Err("no image of this test is decoded".to_owned()))
}

proptest! {
    /// Each image is taken or dropped, once: the newest one is taken, and the older ones are dropped in their order.
    #[test]
    fn each_image_is_taken_or_dropped_once(takes in prop::collection::vec(any::<bool>(), 1..40)) {
        let mut queue = ImageQueue::default();
        let (mut taken, mut pushed) = (Vec::new(), 0);
        for is_take in takes {
            if is_take {
                let newest = queue.take().map(|image| image.stamp());
                prop_assert!(newest.is_none_or(|stamp| stamp == Stamp::default().after(f64::from(pushed))));
                taken.extend(newest);
            } else {
                pushed += 1;
                queue.push(image(f64::from(pushed)));
            }
        }
        taken.extend(queue.take().map(|image| image.stamp()));
        prop_assert!(queue.take().is_none());
        prop_assert!(queue.dropped().windows(2).all(|pair| pair[0] < pair[1]));
        let mut all: Vec<Stamp> = queue.dropped().iter().copied().chain(taken).collect();
        all.sort();
        prop_assert_eq!(all, (1..=pushed).map(|k| Stamp::default().after(f64::from(k))).collect::<Vec<_>>());
    }
}
