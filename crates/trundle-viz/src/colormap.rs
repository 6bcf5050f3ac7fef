//! A perceptual colour map of our own: lightness falls steadily from near to far, and never reaches black.

/// Pale yellow, orange, rose, violet, deep blue; evenly spaced. Source: ours.
const ANCHORS: [[f64; 3]; 7] = [
    [252.0, 246.0, 176.0],
    [253.0, 198.0, 99.0],
    [243.0, 139.0, 88.0],
    [212.0, 86.0, 108.0],
    [158.0, 55.0, 125.0],
    [98.0, 44.0, 130.0],
    [47.0, 38.0, 112.0],
];

/// The colour of `t` from 0 (near, light) to 1 (far, dark); values outside are clamped, NaN counts as 0.
pub(crate) fn color_at(t: f64) -> [u8; 3] {
    let held = if t > 0.0 { t.min(1.0) } else { 0.0 };
    let place = held * (ANCHORS.len() - 1) as f64;
    let lower = (place as usize).min(ANCHORS.len() - 2);
    let fraction = place - lower as f64;
    let mix = |channel: usize| {
        let (a, b) = (ANCHORS[lower][channel], ANCHORS[lower + 1][channel]);
        (a + (b - a) * fraction).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lightness(color: [u8; 3]) -> f64 {
        let linear = color.map(|c| (f64::from(c) / 255.0).powf(2.2));
        116.0 * (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]).cbrt() - 16.0
    }

    #[test]
    fn lightness_falls_steadily_and_stays_off_black() {
        let levels: Vec<f64> = (0..=60).map(|i| lightness(color_at(f64::from(i) / 60.0))).collect();
        for pair in levels.windows(2) {
            let step = pair[0] - pair[1];
            assert!((0.4..3.0).contains(&step), "a step of {step}");
        }
        assert!(levels[60] > 15.0, "the far end is nearly black: {}", levels[60]);
        assert_eq!(color_at(f64::NAN), color_at(0.0));
        assert_eq!(color_at(7.0), color_at(1.0));
    }
}
