//! Manufacturing tolerances.

use crate::rng::normal;
use rand::Rng;

/// A deviate of a standard normal, cut at 2.5 sigma: what leaves a factory.
pub(super) fn tolerance(rng: &mut impl Rng) -> f64 {
    normal(rng.next_u64()).clamp(-2.5, 2.5)
}
