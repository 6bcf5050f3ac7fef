//! Tests of the device's clock: jitter, drift, jumps, restarts, stalls of the host.

use super::*;
use crate::clock::MillisUnwrapper;

/// Period of the simulated packets, s.
const PERIOD_S: f64 = 0.02;

/// Uniform numbers from 0 to 1.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// A device that sends packets: converts true times to device stamps.
struct Device {
    drift: f64,
    jitter_s: f64,
    rng: u64,
    shift_s: f64,
    last_arrival: f64,
    unwrapper: MillisUnwrapper,
    last: Option<Stamp>,
}

impl Device {
    fn new(drift_ppm: f64, jitter_s: f64) -> Self {
        let unwrapper = MillisUnwrapper::default();
        Self {
            drift: drift_ppm * 1e-6,
            jitter_s,
            rng: 7,
            shift_s: 3.0,
            last_arrival: 0.0,
            unwrapper,
            last: None,
        }
    }

    /// Counter value and arrival of the packet sent at true time `t`.
    fn packet(&mut self, t: f64) -> (u16, Stamp) {
        let device_ms = ((t + self.shift_s) * (1.0 - self.drift) * 1000.0).floor();
        self.last_arrival = self.last_arrival.max(t + 0.002 + self.jitter_s * uniform(&mut self.rng));
        (device_ms.rem_euclid(65536.0) as u16, Stamp::from_secs(self.last_arrival).unwrap())
    }
}

/// Largest error after `warm_up`, s, of `seconds` of packets. The smallest delay of 2 ms is configured.
fn worst_error(device: &mut Device, clock: &mut DeviceClock, from: f64, to: f64, warm_up: f64) -> f64 {
    let mut worst = 0.0f64;
    for i in 0..((to - from) / PERIOD_S) as u64 {
        let t = from + i as f64 * PERIOD_S;
        let (value, arrival) = device.packet(t);
        let stamp = clock.to_host(device.unwrapper.unwrap(value, arrival), arrival);
        assert!(device.last.is_none_or(|last| stamp >= last) && stamp <= arrival, "at {t}");
        device.last = Some(stamp);
        if t - from > warm_up {
            worst = worst.max((stamp.as_secs() - t).abs());
        }
    }
    worst
}

fn clock() -> DeviceClock {
    DeviceClock::new(DeviceClockConfig { transport_delay_s: 0.002, ..DeviceClockConfig::default() })
}

#[test]
fn jitter_and_drift_leave_a_few_milliseconds() {
    for drift_ppm in [-100.0, 0.0, 100.0] {
        let mut clock = clock();
        let worst = worst_error(&mut Device::new(drift_ppm, 0.05), &mut clock, 0.0, 300.0, 15.0);
        assert!(worst < 0.003, "{drift_ppm} ppm: {worst} s");
        let drift = clock.drift_ppm().unwrap();
        assert!((drift - drift_ppm).abs() < 30.0, "{drift_ppm} ppm: {drift} ppm");
        assert_eq!(clock.jumps(), 0);
    }
}

#[test]
fn a_second_is_enough_for_ten_milliseconds() {
    let worst = worst_error(&mut Device::new(100.0, 0.05), &mut clock(), 0.0, 15.0, 1.0);
    assert!(worst < 0.010, "{worst} s");
}

#[test]
fn without_jitter_only_the_device_s_resolution_is_left() {
    let worst = worst_error(&mut Device::new(0.0, 0.0), &mut clock(), 0.0, 100.0, 0.1);
    assert!(worst < 0.0015, "{worst} s");
}

#[test]
fn jumps_of_the_device_are_followed_both_ways() {
    for jump_s in [0.5, -0.5, 20.0, -20.0] {
        let (mut device, mut clock) = (Device::new(50.0, 0.05), clock());
        worst_error(&mut device, &mut clock, 0.0, 60.0, 15.0);
        device.shift_s += jump_s;
        let worst = worst_error(&mut device, &mut clock, 60.0, 160.0, 15.0);
        assert!(worst < 0.003, "jump of {jump_s} s: {worst} s");
        assert_eq!(clock.jumps(), 1, "jump of {jump_s} s");
    }
}

#[test]
fn a_stall_of_the_host_is_not_a_jump() {
    let (mut device, mut clock) = (Device::new(50.0, 0.01), clock());
    worst_error(&mut device, &mut clock, 0.0, 60.0, 15.0);
    device.last_arrival = 61.5;
    let worst = worst_error(&mut device, &mut clock, 60.0, 70.0, 0.0);
    assert!(worst < 0.003 && clock.jumps() == 0, "{worst} s, {} jumps", clock.jumps());
}

#[test]
fn extreme_stamps_do_no_harm() {
    let mut clock = clock();
    for (device, host) in [(i64::MIN, 0), (i64::MAX, 1), (0, i64::MAX), (0, i64::MIN), (i64::MIN, i64::MAX)] {
        clock.to_host(device, Stamp::from_nanos(host));
    }
    assert!(clock.slope.is_finite() && clock.intercept.is_finite());
}
