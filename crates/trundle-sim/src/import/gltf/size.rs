//! The check that a scene has the size of a room or a building.

use crate::import::ImportNote;

/// Largest height of a scene \[m\]. A higher one is in another unit: halls are lower. Source: ours.
const MAX_HEIGHT_M: f64 = 40.0;
/// Largest length of a scene \[m\]. A longer one is in another unit. Source: ours.
const MAX_LENGTH_M: f64 = 1000.0;
/// Least length of a scene \[m\]. In a shorter one no robot can drive. Source: ours.
const MIN_LENGTH_M: f64 = 1.0;
/// Height of a room \[m\]. A unit that gives such a height is proposed. Source: ours.
const ROOM_HEIGHT_M: std::ops::RangeInclusive<f64> = 1.5..=12.0;
/// Units of files, and their metres.
const UNITS: [(&str, f64); 4] =
    [("centimetres", 0.01), ("millimetres", 0.001), ("inches", 0.0254), ("kilometres", 1000.0)];

/// A note if a scene of this size, m, is implausible as an indoor space.
pub(super) fn odd_size(size_m: [f64; 3]) -> Option<ImportNote> {
    let [x, y, height] = size_m;
    let length = x.max(y);
    if height <= MAX_HEIGHT_M && (MIN_LENGTH_M..=MAX_LENGTH_M).contains(&length) {
        return None;
    }
    let unit = UNITS.into_iter().find(|(_, metres)| ROOM_HEIGHT_M.contains(&(height * metres)));
    Some(ImportNote::OddSize { size_m, unit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_and_halls_pass_and_other_units_are_named() {
        assert_eq!(odd_size([4.0, 3.0, 2.0]), None);
        assert_eq!(odd_size([300.0, 200.0, 15.0]), None);
        let message = |size| odd_size(size).unwrap().to_string();
        let centimetres = message([400.0, 300.0, 200.0]);
        assert!(centimetres.starts_with("the scene is 400 x 300 m and 200 m high"), "{centimetres}");
        assert!(centimetres.ends_with("If the file is in centimetres, say --scale 0.01"), "{centimetres}");
        assert!(message([4000.0, 3000.0, 2500.0]).ends_with("--scale 0.001"));
        assert!(message([0.04, 0.03, 0.025]).ends_with("is the scale right?"));
    }
}
