//! Limits of the contact queries among points.
/// Difference below which two contacts are one, m or rad: a flat contact with a wall has thousands at one distance. It is a hundredth of
/// the distance by which motions back off. Source: ours.
pub(super) const SAME_CONTACT: f64 = 1e-7;

/// Number of points below which every point is queried. Source: ours.
pub const FEW_POINTS: usize = 200;
