//! Evidence of images: how long none was recognised, against the usual length of such times.

use trundle_core::Stamp;

/// Time without a recognised image, among images that show enough, against the lengths of earlier such times.
///
/// At the estimated pose an outage ends at an unknown rate. With a Gamma prior of the rate its length has a Lomax distribution:
/// P(longer than t) = (1 + t / beta)^-alpha. Each outage that ended updates alpha and beta. At another place no image is
/// recognised at all, so that the log-likelihood ratio for another place is alpha ln(1 + t / beta). In a plain room, where only people
/// have features, long outages are usual and count little.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ImageEvidence {
    alpha: f64,
    beta_s: f64,
    /// Time of the present outage [s], over images that show enough.
    outage_s: f64,
    last: Option<Stamp>,
    located: Option<Stamp>,
}

/// Shape of the prior of outages \[1\]. Source: ours.
const PRIOR_OUTAGES: f64 = 3.0;
/// Scale of the prior \[s\]: a mean outage of 0.25 s, a person who crosses the view. Source: ours.
const PRIOR_SCALE_S: f64 = 0.5;
/// Largest weight of earlier outages \[1\]: older ones are forgotten. Source: ours.
const MAX_OUTAGES: f64 = 20.0;
/// Longest time between two images that counts \[s\]. Source: ours.
const MAX_IMAGE_GAP_S: f64 = 0.5;
/// Time after a recognised image \[s\] during which images speak for the estimated pose. Source: ours.
const LOCATED_FOR_S: f64 = 0.8;
/// Log-likelihood ratio of a recognised image for the estimated pose \[nats\]. Source: ours: a place in 20,000 looks like another.
const LOCATED_NATS: f64 = 10.0;

impl Default for ImageEvidence {
    fn default() -> Self {
        Self { alpha: PRIOR_OUTAGES, beta_s: PRIOR_SCALE_S, outage_s: 0.0, last: None, located: None }
    }
}

impl ImageEvidence {
    /// An image that shows enough features, or not, and was located in the visual map, or not.
    pub(crate) fn add(&mut self, stamp: Stamp, shows_enough: bool, is_located: bool) {
        let gap = self.last.map_or(0.0, |last| (stamp - last).clamp(0.0, MAX_IMAGE_GAP_S));
        self.last = Some(stamp);
        if is_located {
            self.located = Some(stamp);
            self.end_outage();
        } else if shows_enough {
            self.outage_s += gap;
        }
    }

    /// The pose was found by other means: the outage says nothing of the new pose.
    pub(crate) fn restart(&mut self) {
        self.outage_s = 0.0;
    }

    /// Log-likelihood ratio for another place than the estimate \[nats\].
    pub(crate) fn nats(&self, now: Stamp) -> f64 {
        self.nats_since(now.after(-self.outage_s), now)
    }

    /// The same for a robot that was carried away at a moment: what the outage had lasted by then is no sign of it.
    pub(crate) fn nats_since(&self, moment: Stamp, now: Stamp) -> f64 {
        if self.is_located(now) {
            return -LOCATED_NATS;
        }
        let before = (self.outage_s - (now - moment)).max(0.0);
        self.alpha * ((self.beta_s + self.outage_s) / (self.beta_s + before)).ln()
    }

    /// Whether an image was recognised shortly before.
    pub(crate) fn is_located(&self, now: Stamp) -> bool {
        self.located.is_some_and(|located| now - located <= LOCATED_FOR_S)
    }

    fn end_outage(&mut self) {
        if self.outage_s > 0.0 {
            self.alpha += 1.0;
            self.beta_s += self.outage_s;
            let weight = (MAX_OUTAGES / self.alpha).min(1.0);
            (self.alpha, self.beta_s) = (self.alpha * weight, self.beta_s * weight);
            self.outage_s = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evidence after images every 0.1 s, located where `is_located` is true.
    fn after(images: u32, is_located: impl Fn(u32) -> bool) -> (ImageEvidence, f64) {
        let mut evidence = ImageEvidence::default();
        let at = |i: u32| Stamp::default().after(0.1 * f64::from(i));
        (0..images).for_each(|i| evidence.add(at(i), true, is_located(i)));
        (evidence, evidence.nats(at(images)))
    }

    #[test]
    fn a_first_long_outage_speaks_for_another_place_and_a_recognised_image_against_it() {
        let (_, none) = after(50, |_| true);
        let (_, second) = after(30, |i| i < 18);
        let (_, seconds) = after(80, |i| i < 18);
        assert_eq!(none, -LOCATED_NATS);
        assert!((2.0..6.0).contains(&second), "{second} nats after a second");
        assert!((6.0..10.0).contains(&seconds), "{seconds} nats after six seconds");
    }

    #[test]
    fn where_long_outages_are_usual_another_one_says_little() {
        let (_, usual) = after(330, |i| i % 30 == 0);
        let (_, unusual) = after(330, |i| i < 301);
        assert!(usual < 0.6 * unusual, "{usual} and {unusual} nats after 2.9 s");
    }

    #[test]
    fn images_that_show_nothing_prove_nothing() {
        let mut evidence = ImageEvidence::default();
        (0..100).for_each(|i| evidence.add(Stamp::default().after(0.1 * f64::from(i)), false, false));
        assert_eq!(evidence.nats(Stamp::default().after(10.0)), 0.0);
    }
}
