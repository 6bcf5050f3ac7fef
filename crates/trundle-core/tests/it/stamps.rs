//! Laws of stamps: order, arithmetic, saturation, printing; and the stamps of sensor events.

use proptest::prelude::*;
use trundle_core::{
    Beam, Cliff, ColorImage, DepthImage, GyroRate, Pose2, RgbdImage, Scan, SensorEvent, Stamp, Touch,
    Vector2, WheelTicks,
};

/// Nanoseconds of a century around the epoch.
const CENTURY: i64 = 3_155_760_000_000_000_000;

proptest! {
    #[test]
    fn differences_change_their_sign_with_the_order(a in -CENTURY..CENTURY, b in -CENTURY..CENTURY) {
        let (a, b) = (Stamp::from_nanos(a), Stamp::from_nanos(b));
        prop_assert_eq!(a - b, -(b - a));
        prop_assert_eq!(a < b, a - b < 0.0);
    }

    #[test]
    fn a_stamp_after_some_time_is_later_by_that_time(a in -CENTURY..CENTURY, micros in -1_000_000_000_i64..1_000_000_000) {
        let (stamp, secs) = (Stamp::from_nanos(a), micros as f64 * 1e-6);
        prop_assert_eq!(stamp.after(secs).nanos, a + micros * 1000);
        prop_assert!((stamp.after(secs) - stamp - secs).abs() < 1e-12);
        prop_assert_eq!(stamp.after(secs).after(-secs), stamp);
    }

    #[test]
    fn seconds_come_back_to_the_nanosecond_while_f64_has_the_digits(nanos in -1_000_000_000_000_000_i64..1_000_000_000_000_000) {
        prop_assert_eq!(Stamp::from_secs(Stamp::from_nanos(nanos).as_secs()), Some(Stamp::from_nanos(nanos)));
    }

    #[test]
    fn the_printed_stamp_has_every_digit(nanos in any::<i64>()) {
        let text = Stamp::from_nanos(nanos).to_string();
        let digits = text.replace('.', "");
        prop_assert_eq!(digits.parse::<i64>().unwrap(), nanos);
        prop_assert_eq!(text.len() - text.find('.').unwrap(), 10);
    }
}

#[test]
fn arithmetic_saturates_at_both_ends_of_time() {
    let (first, last) = (Stamp::from_nanos(i64::MIN), Stamp::from_nanos(i64::MAX));
    assert_eq!((last.after(1.0), first.after(-1.0)), (last, first));
    assert_eq!((Stamp::default().after(1e300), Stamp::default().after(-1e300)), (last, first));
    assert_eq!(last - first, i64::MAX as f64 * 1e-9);
}

#[test]
fn seconds_beyond_292_years_or_not_finite_are_not_a_stamp() {
    assert_eq!(Stamp::from_secs(9.3e9), None);
    assert_eq!(Stamp::from_secs(-9.3e9), None);
    assert_eq!(Stamp::from_secs(f64::INFINITY), None);
    assert_eq!(Stamp::from_secs(9.2e9).map(|stamp| stamp.nanos), Some(9_200_000_000_000_000_000));
}

#[test]
fn seconds_are_rounded_to_the_nearest_nanosecond() {
    assert_eq!(Stamp::from_secs(1.4e-9), Some(Stamp::from_nanos(1)));
    assert_eq!(Stamp::from_secs(-1.6e-9), Some(Stamp::from_nanos(-2)));
}

#[test]
fn every_sensor_event_has_the_stamp_of_its_reading() {
    let stamp = Stamp::from_nanos(7);
    let image =
        RgbdImage::new(stamp, ColorImage::filled(2, 2, [0; 3]), DepthImage::filled(2, 2, 1.0)).unwrap();
    let scan = Scan::new(stamp, Vector2::zeros(), 0.0, 0.1, vec![Beam::Unseen]).unwrap();
    let events = [
        SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }),
        SensorEvent::Gyro(GyroRate { stamp, omega: 0.0 }),
        SensorEvent::Rgbd(image),
        SensorEvent::Touch(Touch { stamp, pressed: true }),
        SensorEvent::Cliff(Cliff { stamp, over_edge: true }),
        SensorEvent::Scan(scan),
        SensorEvent::Truth { stamp, pose: Pose2::IDENTITY },
    ];
    for event in events {
        assert_eq!(event.stamp(), stamp, "{event:?}");
    }
}
