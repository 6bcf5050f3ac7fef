//! Axes and coordinates of a chart.

use crate::ticks::Ticks;

/// Size of a chart's own coordinates; the page scales it. Source: ours.
pub(crate) const WIDTH: f64 = 540.0;
pub(crate) const HEIGHT: f64 = 280.0;
/// The plotted rectangle: left, top, right, bottom. Source: ours.
pub(crate) const PLOT_RECTANGLE: [f64; 4] = [52.0, 38.0, WIDTH - 12.0, HEIGHT - 42.0];

/// An axis: numbers to places.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Place of `low` and of `high`.
    ends: (f64, f64),
}

impl Axis {
    /// An axis slightly wider than the range of `values`. Without values the axis covers 0 to 1.
    pub(crate) fn over(
        values: impl Iterator<Item = f64>,
        logarithmic: bool,
        slack: f64,
        ends: (f64, f64),
    ) -> Self {
        let usable = |v: &f64| v.abs() < 1e15 && (!logarithmic || *v > 1e-15);
        let scaled = values.filter(usable).map(|v| if logarithmic { v.log10() } else { v });
        let range = scaled.fold(None, |range: Option<(f64, f64)>, v| {
            Some(range.map_or((v, v), |(low, high)| (low.min(v), high.max(v))))
        });
        let (low, high) = match range {
            None => (0.0, 1.0),
            Some((low, high)) if high - low < 1e-9 * high.abs().max(1e-6) => {
                (low - 0.5 * low.abs().max(1e-6), high + 0.5 * low.abs().max(1e-6))
            }
            Some((low, high)) => {
                let pad = slack * (high - low);
                let grounded = !logarithmic && low >= 0.0 && low < 0.4 * high;
                (if grounded { 0.0 } else { low - pad }, high + pad)
            }
        };
        Self { low, high, logarithmic, ends }
    }

    /// The place of a number. `None` if the number cannot be shown.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let value = if self.logarithmic { value.log10() } else { value };
        let fraction = (value - self.low) / (self.high - self.low);
        (fraction.is_finite() && (-1e-6..=1.0 + 1e-6).contains(&fraction))
            .then_some(self.ends.0 + fraction * (self.ends.1 - self.ends.0))
    }

    /// Ticks: place and label.
    pub(crate) fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        if self.logarithmic && self.high - self.low > 1.0 {
            let powers = self.low.ceil() as i32..=self.high.floor() as i32;
            let value = |power: i32| 10_f64.powi(power);
            let label = |power: i32| {
                if (-3..=5).contains(&power) { value(power).to_string() } else { format!("1e{power}") }
            };
            return powers.filter_map(|p| Some((self.place(value(p))?, label(p)))).collect();
        }
        let raw = |scaled: f64| if self.logarithmic { 10_f64.powf(scaled) } else { scaled };
        let ticks = Ticks::new(raw(self.low), raw(self.high), count);
        ticks.values.iter().filter_map(|&v| Some((self.place(v)?, ticks.label(v)))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_run_from_end_to_end() {
        let axis = Axis::over([2.0, 4.0].into_iter(), false, 0.0, (100.0, 200.0));
        assert_eq!(axis.place(3.0), Some(150.0));
        assert_eq!(axis.place(5.0), None);
        assert_eq!(axis.place(f64::NAN), None);
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        let axis = Axis::over([0.01, 500.0, 0.0, -1.0].into_iter(), true, 0.0, (0.0, 1.0));
        let labels: Vec<String> = axis.ticks(5).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.01", "0.1", "1", "10", "100"]);
    }

    #[test]
    fn nothing_and_constants_have_an_axis_too() {
        for values in [vec![], vec![0.0], vec![3.0, 3.0], vec![f64::NAN]] {
            let axis = Axis::over(values.iter().copied(), false, 0.05, (0.0, 1.0));
            assert!(axis.ticks(5).len() >= 2, "{values:?}");
        }
    }
}
