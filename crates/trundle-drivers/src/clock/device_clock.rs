//! Device stamps on the host's clock.
//!
//! A packet arrives after its stamp, with a delay of at least a minimum. The difference between arrival and stamp is thus the offset of the
//! clocks, plus their drift, plus a delay. The packets with the smallest delay are on the lower edge of these differences over time. The
//! map between the clocks is a line below all of them, along an edge of their lower convex hull \[Zhang02\]. Bounding the drift is the idea
//! of \[Olson10\].
//!
//! The minimum delay itself is not observable. It is [`DeviceClockConfig::transport_delay_s`].
//!
//! | paper's symbol | name here | unit |
//! |---|---|---|
//! | p, device stamp | `device_nanos` | ns |
//! | q, host stamp | `arrival` | ns |
//! | q - p | `offset` | s |
//! | skew | `slope` | s/s |
//!
//! Cost: at most 61 points a call, one for each second of the window.

use super::lower_hull::{Point, lower_hull, slope_at};
use std::collections::VecDeque;
use trundle_core::Stamp;

/// Device time from which only the packet with the smallest delay is stored: 1 s. Source: ours; 50 packets of a Kobuki.
const BIN_S: f64 = 1.0;
/// Span of packets below which the drift counts as zero: 10 s. Source: ours; 100 ppm over 10 s are 1 ms.
const MIN_DRIFT_SPAN_S: f64 = 10.0;
/// Time of arrival over which packets exceed the largest delay after a jump of the device's clock: 0.3 s. Source: ours; the backlog of a
/// stalled host arrives in one burst.
const MIN_LATE_SPAN_S: f64 = 0.3;
/// Largest spread of the offsets of these packets: 0.1 s. Source: ours; the offsets of a backlog shrink from packet to packet.
const MAX_JUMP_SPREAD_S: f64 = 0.1;

/// Configuration of a [`DeviceClock`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DeviceClockConfig {
    /// Time over which the smallest delays are stored, s, 10 to 600. Default 60.
    pub window_s: f64,
    /// Largest drift between the clocks, ppm, 0 to 10000. Default 500: twice the sum of two poor crystals.
    pub max_drift_ppm: f64,
    /// Largest time by which a packet may arrive early, s, above 0; an earlier one is a jump of the device's clock. Default 0.02.
    pub max_early_s: f64,
    /// Delay beyond which a series of packets is a jump of the device's clock, s, above 0. Default 0.3.
    pub max_delay_s: f64,
    /// Smallest delay from the stamp to the arrival, s, 0 or above; subtracted from the result. Default 0.
    pub transport_delay_s: f64,
}

impl Default for DeviceClockConfig {
    fn default() -> Self {
        Self {
            window_s: 60.0,
            max_drift_ppm: 500.0,
            max_early_s: 0.02,
            max_delay_s: 0.3,
            transport_delay_s: 0.0,
        }
    }
}

/// Maps unwrapped device stamps to the host's clock.
#[derive(Debug, Clone)]
pub struct DeviceClock {
    config: DeviceClockConfig,
    /// First device stamp and arrival since the last jump, ns.
    origin: Option<(i64, i64)>,
    /// The smallest offset of each second: device time and offset, s since the origin.
    bins: VecDeque<Point>,
    slope: f64,
    intercept: f64,
    late: Option<LateRun>,
    last: Option<Stamp>,
    jumps: u64,
}

/// Packets in a row beyond the largest delay.
#[derive(Debug, Clone, Copy)]
struct LateRun {
    since: Stamp,
    /// Lowest offset, s.
    low: f64,
    /// Highest offset, s.
    high: f64,
}

impl DeviceClock {
    /// A clock before its first packet.
    pub fn new(config: DeviceClockConfig) -> Self {
        Self {
            config,
            origin: None,
            bins: VecDeque::new(),
            slope: 0.0,
            intercept: 0.0,
            late: None,
            last: None,
            jumps: 0,
        }
    }

    /// The host's time of a device stamp (ns, unwrapped) whose packet arrived at `arrival` (host's clock).
    ///
    /// The result is never after `arrival`, and never before an earlier result.
    pub fn to_host(&mut self, device_nanos: i64, arrival: Stamp) -> Stamp {
        let (device, mut offset) = self.since_origin(device_nanos, arrival);
        let delay = offset - self.offset_at(device);
        if self.is_jump(delay, offset, arrival) {
            self.restart();
            self.jumps += 1;
            offset = self.since_origin(device_nanos, arrival).1;
        }
        let device = self.since_origin(device_nanos, arrival).0;
        if self.late.is_none() {
            self.add(device, offset);
        }
        let delay = (offset - self.offset_at(device)).max(0.0);
        self.in_order(arrival.after(-delay - self.config.transport_delay_s), arrival)
    }

    /// Estimated drift of the host's clock relative to the device's, ppm; positive if the host's is faster. `None` in the first 10 s.
    pub fn drift_ppm(&self) -> Option<f64> {
        (self.span() >= MIN_DRIFT_SPAN_S).then_some(self.slope * 1e6)
    }

    /// Jumps of the device's clock so far, its restarts among them.
    pub fn jumps(&self) -> u64 {
        self.jumps
    }

    /// Device time and offset, s since the origin, which the first packet sets.
    fn since_origin(&mut self, device_nanos: i64, arrival: Stamp) -> Point {
        let (device, host) = *self.origin.get_or_insert((device_nanos, arrival.nanos));
        let elapsed = device_nanos.saturating_sub(device);
        let offset = arrival.nanos.saturating_sub(host).saturating_sub(elapsed);
        (elapsed as f64 * 1e-9, offset as f64 * 1e-9)
    }

    fn offset_at(&self, device: f64) -> f64 {
        self.intercept + self.slope * device
    }

    fn span(&self) -> f64 {
        self.bins.front().zip(self.bins.back()).map_or(0.0, |(first, last)| last.0 - first.0)
    }

    /// Whether the device's clock jumped: forwards, when a packet arrives too early; backwards, when all are late by the same time.
    fn is_jump(&mut self, delay: f64, offset: f64, arrival: Stamp) -> bool {
        if delay <= self.config.max_delay_s {
            self.late = None;
            return !self.bins.is_empty() && delay < -self.early_limit();
        }
        let LateRun { since, low, high } =
            self.late.unwrap_or(LateRun { since: arrival, low: offset, high: offset });
        let run = LateRun { since, low: low.min(offset), high: high.max(offset) };
        let is_steady = run.high - run.low <= MAX_JUMP_SPREAD_S;
        self.late = Some(if is_steady { run } else { LateRun { since: arrival, low: offset, high: offset } });
        is_steady && arrival - since >= MIN_LATE_SPAN_S
    }

    /// Largest time by which a packet may be early, s: in the first second the smallest delay is unknown.
    fn early_limit(&self) -> f64 {
        if self.bins.len() > 1 { self.config.max_early_s } else { self.config.max_delay_s }
    }

    /// Discards the device's clock, for example after a lost link: the device may have been switched off. Later results are still in order.
    pub fn restart(&mut self) {
        (self.origin, self.slope, self.intercept) = (None, 0.0, 0.0);
        self.bins.clear();
        self.late = None;
    }

    /// Adds an offset to its bin and fits the line again.
    fn add(&mut self, device: f64, offset: f64) {
        match self.bins.back_mut() {
            Some(last) if device < (last.0 / BIN_S).floor() * BIN_S + BIN_S => {
                if offset - last.1 < self.slope * (device - last.0) {
                    *last = (device.max(last.0), offset);
                }
            }
            _ => self.bins.push_back((device, offset)),
        }
        while self.bins.front().is_some_and(|first| device - first.0 > self.config.window_s) {
            self.bins.pop_front();
        }
        self.fit();
    }

    /// The line below all points with the smallest mean distance: along the hull's edge at their mean time.
    fn fit(&mut self) {
        let limit = self.config.max_drift_ppm * 1e-6;
        self.slope = if self.span() < MIN_DRIFT_SPAN_S {
            0.0
        } else {
            let mean = self.bins.iter().map(|(device, _)| device).sum::<f64>() / self.bins.len() as f64;
            slope_at(&lower_hull(self.bins.iter().copied()), mean).clamp(-limit, limit)
        };
        let intercepts = self.bins.iter().map(|(device, offset)| offset - self.slope * device);
        self.intercept = intercepts.fold(f64::INFINITY, f64::min);
    }

    /// Limits a stamp to the interval from the last result to the arrival.
    fn in_order(&mut self, stamp: Stamp, arrival: Stamp) -> Stamp {
        let stamp = stamp.min(arrival).max(self.last.unwrap_or(stamp));
        self.last = Some(stamp);
        stamp
    }
}

#[cfg(test)]
mod tests;
