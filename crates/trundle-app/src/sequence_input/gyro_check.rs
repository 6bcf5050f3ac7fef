//! Whether a gyro turns as the odometry of its base does: sign, unit and clock.

use trundle_core::{GyroRate, Pose2, Stamp, difference_of_angles};

/// Length of a window whose turns are compared \[s\]. In it the odometry turns farther than it is noisy, and the gyro's stamps may be off by
/// a tenth of it. Source: ours.
const WINDOW_S: f64 = 0.5;
/// Turn by odometry within a window \[rad\], 6 deg/s. Windows with less are left out: in them the gyro shows its zero rate. Source: ours.
const MIN_WINDOW_TURN_RAD: f64 = 0.05;
/// Sum of the turns by odometry \[rad\], about half a turn. Below it the gyro is not judged. Source: ours.
const MIN_TURN_RAD: f64 = 3.0;
/// Square of the correlation of the turns \[1\]. Below it gyro and odometry do not describe one body. Source: ours.
const MIN_CORRELATION_SQUARED: f64 = 0.25;
/// Largest factor between the gyro's turns and those of the odometry \[1\]. Source: ours; the wheels of a skid-steered base slip in each turn.
const MAX_FACTOR: f64 = 3.0;
/// Range of the factor that a gyro in degrees a second has \[1\]: 180 / pi within the error of odometry. Source: ours.
const DEGREE_FACTORS: std::ops::Range<f64> =
    180.0 / std::f64::consts::PI / MAX_FACTOR..180.0 / std::f64::consts::PI * MAX_FACTOR;

/// A sentence about a gyro that does not turn as the odometry; `None` for one that does, or without enough turns to judge it. Both by
/// rising stamps; the headings of `odometry` are in rad, the rates in rad/s around the vertical.
#[must_use]
pub fn gyro_problem(odometry: &[(Stamp, Pose2)], gyro: &[GyroRate]) -> Option<String> {
    let turns = Turns::of(odometry, gyro);
    if turns.odometry_rad < MIN_TURN_RAD {
        return None;
    }
    let (factor, correlation_squared) = turns.fit()?;
    let fact = format!("over turns of {:.0} deg by odometry", turns.odometry_rad.to_degrees());
    if correlation_squared < MIN_CORRELATION_SQUARED {
        return Some(format!(
            "the gyro does not turn with the odometry {fact} (correlation {:.2}, expected near 1): is it the gyro of this base, and are both on one clock?",
            correlation_squared.sqrt()
        ));
    }
    if factor < 0.0 {
        return Some(format!(
            "the gyro turns against the odometry {fact} (factor {factor:.2}, expected about 1): turns to the left are positive; is the frame of the IMU upside down in the transforms?"
        ));
    }
    let hint = if DEGREE_FACTORS.contains(&factor) {
        "are its rates in degrees a second?"
    } else {
        "is it in rad/s, and are the settings of the base right?"
    };
    (!(1.0 / MAX_FACTOR..=MAX_FACTOR).contains(&factor)).then(|| {
        format!("the gyro turns {factor:.2} times as far as the odometry {fact}, expected about once, in rad/s: {hint}")
    })
}

/// Sums over the windows with a turn. The zero rate of a gyro is small beside their rates.
#[derive(Debug, Default)]
struct Turns {
    /// Sum of the turns by odometry, each without its sign \[rad\].
    odometry_rad: f64,
    /// Sums of the squares of the turns by odometry and by gyro \[rad^2\].
    squares: [f64; 2],
    /// Sum of the products of both turns \[rad^2\].
    product: f64,
}

impl Turns {
    /// The turns of windows over which the gyro has readings from end to end.
    fn of(odometry: &[(Stamp, Pose2)], gyro: &[GyroRate]) -> Self {
        let (mut turns, mut start, mut by_odometry) = (Self::default(), 0, 0.0);
        let begin = odometry.first().map_or(Stamp::default(), |(stamp, _)| *stamp);
        let mut rates = gyro.iter().skip_while(|rate| rate.stamp < begin).peekable();
        let (mut by_gyro, mut is_covered) = (0.0, true);
        for (i, pair) in odometry.windows(2).enumerate() {
            let [(_, from), (now, to)] = [pair[0], pair[1]];
            by_odometry += difference_of_angles(to.theta, from.theta);
            is_covered &= rates.peek().is_some();
            while let Some(rate) = rates.next_if(|rate| rate.stamp <= now) {
                let turn = rates.peek().and_then(|next| held_turn(rate, next.stamp));
                is_covered &= turn.is_some();
                by_gyro += turn.unwrap_or(0.0);
            }
            if now - odometry[start].0 >= WINDOW_S {
                if is_covered {
                    turns.add(by_odometry, by_gyro);
                }
                (start, by_odometry, by_gyro, is_covered) = (i + 1, 0.0, 0.0, true);
            }
        }
        turns
    }

    fn add(&mut self, by_odometry: f64, by_gyro: f64) {
        if by_odometry.abs() < MIN_WINDOW_TURN_RAD {
            return;
        }
        self.odometry_rad += by_odometry.abs();
        self.squares[0] += by_odometry * by_odometry;
        self.squares[1] += by_gyro * by_gyro;
        self.product += by_odometry * by_gyro;
    }

    /// Factor from the turns by odometry to those by gyro, and the square of their correlation; `None` for a gyro that shows no turn.
    fn fit(&self) -> Option<(f64, f64)> {
        let [odometry, gyro] = self.squares;
        (odometry > 0.0 && gyro > 0.0)
            .then(|| (self.product / odometry, self.product * self.product / (odometry * gyro)))
    }
}

/// The turn by a rate until the next reading \[rad\]; `None` across a gap.
fn held_turn(rate: &GyroRate, next: Stamp) -> Option<f64> {
    let seconds = next - rate.stamp;
    (seconds < WINDOW_S).then_some(rate.omega * seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    /// 20 s of turns to both sides; the gyro's rates are those of the odometry through `gyro`.
    fn drive(gyro: impl Fn(f64, i64) -> f64) -> (Vec<(Stamp, Pose2)>, Vec<GyroRate>) {
        let heading = |ms: i64| (1.2 * (ms as f64 / 1000.0)).sin();
        let rate = |ms: i64| 1.2 * (1.2 * (ms as f64 / 1000.0)).cos();
        let odometry = (0..400).map(|i| (stamp(50 * i), Pose2::new(0.0, 0.0, heading(50 * i))));
        let rates = (0..2000).map(|i| GyroRate { stamp: stamp(10 * i), omega: gyro(rate(10 * i), i) });
        (odometry.collect(), rates.collect())
    }

    fn problem(gyro: impl Fn(f64, i64) -> f64) -> Option<String> {
        let (odometry, rates) = drive(gyro);
        gyro_problem(&odometry, &rates)
    }

    #[test]
    fn a_gyro_with_bias_and_a_base_that_slips_are_no_problem() {
        assert_eq!(problem(|rate, _| rate), None);
        assert_eq!(problem(|rate, _| 0.7 * rate + 0.05), None);
        let (_, rates) = drive(|_, _| 0.5);
        let steady =
            (0..400).map(|i| (stamp(50 * i), Pose2::new(0.0, 0.0, 0.025 * i as f64))).collect::<Vec<_>>();
        assert_eq!(gyro_problem(&steady, &rates), None, "one turn rate for the whole drive");
    }

    #[test]
    fn another_sign_unit_and_body_are_named() {
        let against = problem(|rate, _| 0.1 - rate).unwrap();
        assert!(against.contains("against the odometry") && against.contains("upside down"), "{against}");
        let degrees = problem(|rate, _| rate.to_degrees()).unwrap();
        assert!(degrees.contains("57.") && degrees.ends_with("degrees a second?"), "{degrees}");
        let slow = problem(|rate, _| 0.1 * rate).unwrap();
        assert!(slow.contains("0.10 times"), "{slow}");
        let other = problem(|_, i| (0.37 * i as f64 / 100.0).sin()).unwrap();
        assert!(other.contains("one clock"), "{other}");
    }

    #[test]
    fn only_the_time_with_readings_counts() {
        let (odometry, rates) = drive(|rate, _| rate);
        assert_eq!(gyro_problem(&odometry, &rates[..600]), None, "it ends early");
        let gap: Vec<_> = rates
            .iter()
            .filter(|rate| !(500..1500).contains(&(rate.stamp.nanos / 10_000_000)))
            .copied()
            .collect();
        assert_eq!(gyro_problem(&odometry, &gap), None, "a gap of 10 s");
        let early = (0..1000).map(|i| GyroRate { stamp: stamp(10 * i - 10_000), omega: 1.0 });
        let early: Vec<_> = early.chain(rates).collect();
        assert_eq!(gyro_problem(&odometry, &early), None, "it begins before the odometry");
    }

    #[test]
    fn a_straight_drive_and_a_still_gyro_say_nothing() {
        let (mut odometry, rates) = drive(|rate, _| -rate);
        odometry.iter_mut().for_each(|(_, pose)| pose.theta *= 0.02);
        assert_eq!(gyro_problem(&odometry, &rates), None);
        assert_eq!(gyro_problem(&odometry, &[]), None);
        assert_eq!(gyro_problem(&[], &rates), None);
    }
}
