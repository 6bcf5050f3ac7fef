//! Detects a computer that is too slow for its images, for the log.

use trundle_core::Stamp;

/// Time over which images are counted \[s\]. Source: ours.
const WINDOW_S: f64 = 10.0;
/// Share of dropped images above which the computer counts as too slow. At half of 30 Hz the robot still drives well. Source: ours.
const MAX_DROPPED_PART: f64 = 0.6;

/// Counts images that newer ones replaced before they were processed.
#[derive(Debug, Default)]
pub(crate) struct OverloadWatch {
    window: Option<Window>,
}

#[derive(Debug, Clone, Copy)]
struct Window {
    from: Stamp,
    images: usize,
    /// Images dropped in the run before the window.
    dropped_before: usize,
}

impl OverloadWatch {
    /// Records an image; `dropped` is the number of images dropped in the run so far. Returns a warning if too many were dropped in the
    /// last ten seconds.
    pub(crate) fn on_image(&mut self, stamp: Stamp, dropped: usize) -> Option<String> {
        let fresh = Window { from: stamp, images: 0, dropped_before: dropped };
        let window = self.window.get_or_insert(fresh);
        window.images += 1;
        if stamp - window.from < WINDOW_S {
            return None;
        }
        let Window { images, dropped_before, .. } = std::mem::replace(window, fresh);
        let lost = dropped - dropped_before;
        (lost as f64 > MAX_DROPPED_PART * images as f64).then(|| {
            format!(
                "{lost} of the last {images} images were dropped, because this computer is too slow for them: lower the camera's rate or \
                 size, or end other programs (docs/how-to/small-computer.md)"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warnings in 30 s at 30 Hz if one of `nth` images is processed.
    fn sentences(nth: usize) -> usize {
        let (mut watch, mut dropped) = (OverloadWatch::default(), 0);
        let images = (0..900).filter_map(|i| {
            dropped += usize::from(i % nth != 0);
            watch.on_image(Stamp::default().after(i as f64 / 30.0), dropped)
        });
        images.count()
    }

    #[test]
    fn only_a_computer_that_drops_more_than_it_processes_is_named_every_ten_seconds() {
        assert_eq!([sentences(1), sentences(2), sentences(3)], [0, 0, 2]);
    }
}
