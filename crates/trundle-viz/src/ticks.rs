//! Round tick values along an axis and their labels.

/// Round numbers along an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// Tick values in increasing order, all within the requested range.
    pub values: Vec<f64>,
    step: f64,
}

impl Ticks {
    /// Multiples of 1, 2 or 5 times a power of ten within `low..=high`, about `count` of them. Empty for a range that is empty or not
    /// finite.
    pub(crate) fn new(low: f64, high: f64, count: usize) -> Self {
        let span = high - low;
        if !(span.is_finite() && span > 0.0) {
            return Self { values: Vec::new(), step: 1.0 };
        }
        let step = round_step(span / count.max(1) as f64);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let sensible = first.abs() < 1e12 && last - first < 1000.0;
        let count = if sensible { (last - first) as i64 + 1 } else { 0 };
        Self { values: (0..count).map(|i| (first + i as f64) * step).collect(), step }
    }

    /// A tick as text, with as many digits as distinguish it from the next.
    pub(crate) fn label(&self, value: f64) -> String {
        number(value, self.step)
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `min` (which must be positive).
pub(crate) fn round_step(min: f64) -> f64 {
    let power = 10_f64.powf(min.log10().floor());
    let choices = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    choices.into_iter().find(|&step| step >= min * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// A number with the digits required by a step of `step`.
pub(crate) fn number(value: f64, step: f64) -> String {
    if !(1e-4..1e6).contains(&step) && step > 0.0 {
        return format!("{value:.1e}");
    }
    let decimals = (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 4.0) as usize;
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if zero { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ticks_are_round_and_labelled_shortly() {
        let ticks = Ticks::new(-0.13, 0.42, 5);
        let labels: Vec<_> = ticks.values.iter().map(|&v| ticks.label(v)).collect();
        assert_eq!(labels, ["0.0", "0.2", "0.4"]);
        let ticks = Ticks::new(-1.0, 7.3, 6);
        assert_eq!(ticks.values, [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(ticks.label(-0.0), "0");
        assert_eq!(round_step(0.3), 0.5);
    }

    proptest! {
        #[test]
        fn ticks_stay_in_range_and_few(low in -1e6..1e6_f64, span in 1e-6..1e6_f64, count in 1..12_usize) {
            let ticks = Ticks::new(low, low + span, count);
            prop_assert!(ticks.values.len() <= count + 1);
            for v in ticks.values {
                prop_assert!(v >= low - span * 1e-6 && v <= low + span * (1.0 + 1e-6));
            }
        }

        #[test]
        fn any_range_is_survived(low in any::<f64>(), high in any::<f64>(), count in 0..20_usize) {
            let ticks = Ticks::new(low, high, count);
            prop_assert!(ticks.values.iter().all(|&v| !ticks.label(v).is_empty()));
        }
    }
}
