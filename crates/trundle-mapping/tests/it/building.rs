//! Buildings of corridors and rooms, driven through with bad odometry: loops whose truth is known.

use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2, wrap_angle};

/// Free space as a union of rectangles: x0, y0, x1, y1.
pub struct Building {
    rooms: Vec<[f64; 4]>,
    /// Corners of the path.
    path: Vec<(f64, f64)>,
}

/// Data of a drive: true poses, odometry and scans.
pub struct Drive {
    pub truth: Vec<Pose2>,
    pub odom: Vec<Pose2>,
    pub scans: Vec<Scan>,
}

/// In [0, 1), from a hash.
fn random_share(seed: u64, i: u64) -> f64 {
    (crate::boxes::mix(seed.wrapping_mul(0x9e37_79b9) ^ i) >> 11) as f64 / 2_f64.powi(53)
}

/// About normal, sigma 1.
fn normal(seed: u64, i: u64) -> f64 {
    (0..6).map(|k| random_share(seed, 6 * i + k) - 0.5).sum::<f64>() * 2_f64.sqrt()
}

impl Building {
    /// A ladder of long corridors, as the infinite corridor of Killian Court: two loops of about 150 m, driven through twice.
    pub fn ladder() -> Self {
        let corners = [(0.0, 0.0), (50.0, 0.0), (50.0, 22.0), (0.0, 22.0)];
        let mut it = Self { rooms: Vec::new(), path: Vec::new() };
        it.corridor((0.0, 0.0), (50.0, 0.0), 2.2, 1);
        it.corridor((0.0, 22.0), (50.0, 22.0), 2.4, 2);
        for (k, x) in [0.0, 25.0, 50.0].into_iter().enumerate() {
            it.corridor((x, 0.0), (x, 22.0), 1.9 + 0.2 * k as f64, 3 + k as u64);
        }
        let [a, b, c, d] = corners;
        it.path = vec![a, b, c, d, a, (25.0, 0.0), (25.0, 22.0), d, a, (20.0, 0.0)];
        it
    }

    /// A corridor with equal rooms on both sides, as building 79 in Freiburg: in and out of every second one, and back.
    pub fn rooms() -> Self {
        let mut it = Self { rooms: vec![[-1.0, -1.0, 37.0, 1.0]], path: vec![(0.0, 0.0)] };
        for k in 0..9_u64 {
            let x = 4.0 * k as f64;
            for (side, up) in [(1.0, true), (-1.0, false)] {
                let deep = 4.0 + random_share(k, side as u64);
                let (low, high) = if up { (1.2, 1.2 + deep) } else { (-1.2 - deep, -1.2) };
                it.rooms.push([x, low, x + 3.8, high]);
                let door = x + 1.2 + random_share(k, 7 + side as u64);
                it.rooms.push([door, low.min(0.9), door + 0.9, high.max(-0.9)].map(|v: f64| v));
                let (low, high) = if up { (0.9, 1.3) } else { (-1.3, -0.9) };
                let last = it.rooms.len() - 1;
                it.rooms[last] = [door, low, door + 0.9, high];
                if (k % 2 == 0) == up {
                    let inside = if up { 3.2 } else { -3.2 };
                    it.path.extend([(door + 0.45, 0.0), (door + 0.45, inside), (door + 0.45, 0.0)]);
                }
            }
        }
        it.path.extend([(36.0, 0.0), (0.0, 0.0), (20.0, 0.0)]);
        it
    }

    /// Corridors around four blocks, as the ACES building in Austin: four loops that share their sides.
    pub fn blocks() -> Self {
        let mut it = Self { rooms: Vec::new(), path: Vec::new() };
        for k in 0..3_u64 {
            let at = 18.0 * k as f64;
            it.corridor((0.0, at), (36.0, at), 2.0, 10 + k);
            it.corridor((at, 0.0), (at, 36.0), 2.0, 20 + k);
        }
        it.path = [
            (0, 0),
            (1, 0),
            (2, 0),
            (2, 1),
            (2, 2),
            (1, 2),
            (0, 2),
            (0, 1),
            (0, 0),
            (1, 0),
            (1, 1),
            (1, 2),
            (0, 2),
            (0, 1),
            (1, 1),
            (2, 1),
            (2, 0),
            (1, 0),
        ]
        .map(|(x, y)| (18.0 * f64::from(x), 18.0 * f64::from(y)))
        .to_vec();
        it
    }

    /// A corridor along an axis with niches at uneven distances.
    fn corridor(&mut self, a: (f64, f64), b: (f64, f64), width: f64, seed: u64) {
        let half = width / 2.0;
        self.rooms.push([a.0 - half, a.1 - half, b.0 + half, b.1 + half]);
        let along_x = b.0 > a.0;
        let length = (b.0 - a.0) + (b.1 - a.1);
        let mut at = 1.5;
        for i in 0.. {
            at += 1.5 + 4.0 * random_share(seed, 3 * i);
            if at > length - 3.0 {
                break;
            }
            let (wide, deep) =
                (0.7 + 0.6 * random_share(seed, 3 * i + 1), 0.12 + 0.5 * random_share(seed, 3 * i + 2));
            let side = if i % 2 == 0 { (half - 0.1, half + deep) } else { (-half - deep, -half + 0.1) };
            self.rooms.push(if along_x {
                [a.0 + at, a.1 + side.0, a.0 + at + wide, a.1 + side.1]
            } else {
                [a.0 + side.0, a.1 + at, a.0 + side.1, a.1 + at + wide]
            });
        }
    }

    /// Distance to the wall along a direction, m.
    fn cast(&self, from: Vector2, angle: f64) -> f64 {
        let (s, c) = angle.sin_cos();
        let mut range = 0.0;
        loop {
            let p = (from.x + c * (range + 1e-6), from.y + s * (range + 1e-6));
            let exit = |room: &[f64; 4]| {
                let [x0, y0, x1, y1] = *room;
                let inside = p.0 >= x0 && p.0 <= x1 && p.1 >= y0 && p.1 <= y1;
                let until = |p: f64, d: f64, low: f64, high: f64| {
                    if d > 0.0 {
                        (high - p) / d
                    } else if d < 0.0 {
                        (low - p) / d
                    } else {
                        f64::INFINITY
                    }
                };
                inside.then(|| until(from.x, c, x0, x1).min(until(from.y, s, y0, y1)))
            };
            match self.rooms.iter().filter_map(exit).max_by(f64::total_cmp) {
                Some(exit) if exit > range => range = exit + 1e-6,
                _ => return range,
            }
        }
    }

    /// Drives the path with a laser of 180 beams. The odometry is 2 % short, turns 0.3 deg/m, is noisy, and loses one step in 150.
    pub fn drive(&self, seed: u64) -> Drive {
        let truth = self.poses();
        let mut odom = vec![Pose2::IDENTITY];
        for (i, pair) in truth.windows(2).enumerate() {
            let step = pair[0].inverse() * pair[1];
            let (n, path) = (|k| normal(seed, 3 * i as u64 + k), step.position().norm());
            let reported = if random_share(seed ^ 77, i as u64) < 1.0 / 150.0 {
                Pose2::IDENTITY
            } else {
                let turn = step.theta * 1.02 + 0.005 * path + 0.02 * path * n(0) + 0.03 * step.theta * n(1);
                Pose2::new(step.x * (0.98 + 0.05 * n(2)), step.y, turn)
            };
            odom.push(odom[i] * reported);
        }
        let scans = truth.iter().enumerate().map(|(i, pose)| self.scan(*pose, i, seed)).collect();
        Drive { truth, odom, scans }
    }

    fn poses(&self) -> Vec<Pose2> {
        let mut poses: Vec<Pose2> = Vec::new();
        for pair in self.path.windows(2) {
            let (a, b) = (Vector2::new(pair[0].0, pair[0].1), Vector2::new(pair[1].0, pair[1].1));
            let heading = (b.y - a.y).atan2(b.x - a.x);
            if let Some(last) = poses.last().copied() {
                let turn = wrap_angle(heading - last.theta);
                let steps = (turn.abs() / 0.25).ceil().max(1.0);
                poses.extend(
                    (1..=steps as i32)
                        .map(|k| Pose2::new(a.x, a.y, last.theta + turn * f64::from(k) / steps)),
                );
            }
            let steps = ((b - a).norm() / 0.35).max(1.0) as i32;
            poses.extend((1..=steps).map(|k| {
                let p = a + (b - a) * (f64::from(k) / f64::from(steps));
                Pose2::new(p.x, p.y, heading)
            }));
        }
        poses
    }

    fn scan(&self, pose: Pose2, i: usize, seed: u64) -> Scan {
        let beam = |k: usize| {
            let range = self.cast(pose.position(), pose.theta - FRAC_PI_2 + k as f64 * PI / 180.0);
            let noise = 0.01 * normal(seed ^ 99, (i * 180 + k) as u64);
            if range < 25.0 { Beam::Hit { range: (range + noise).max(0.0) } } else { Beam::Unseen }
        };
        let stamp = Stamp::from_nanos(1_000_000_000 + i as i64 * 500_000_000);
        Scan::new(stamp, Vector2::zeros(), -FRAC_PI_2, PI / 180.0, (0..180).map(beam).collect()).unwrap()
    }
}

#[test]
fn loops_of_corridors_are_closed_whatever_the_seed() {
    use trundle_mapping::{ParticleConfig, ParticleMapper, ScanUpdate};
    let building = Building::ladder();
    for seed in 1..=2 {
        let drive = building.drive(seed);
        let mut config = ParticleConfig::default();
        config.particles = 6;
        let mut mapper = ParticleMapper::new(config, seed).unwrap();
        let mut bends = 0;
        for (odom, scan) in drive.odom.iter().zip(&drive.scans) {
            if let ScanUpdate::Processed(done) = mapper.update(*odom, scan) {
                bends += usize::from(done.loop_correction_m.is_some());
            }
        }
        mapper.finish();
        let origin = drive.truth[0].inverse();
        let truth = origin * *drive.truth.last().unwrap();
        let by_odometry = drive.odom.last().unwrap().distance(&truth);
        let off = mapper.pose().distance(&truth);
        assert!(by_odometry > 5.0, "the odometry alone is {by_odometry} m off");
        assert!(off < 0.3 && bends > 0, "seed {seed}: {off} m off after {bends} bends");
        let filter = relative_errors(&mapper, &drive);
        assert!(mapper.polish(&|| true).is_some());
        let polished = relative_errors(&mapper, &drive);
        let (median, worst) = (filter.len() / 2, filter.len() - 1);
        let both = (filter[median], polished[median]);
        assert!(both.1 < 0.3 * both.0 && both.1 < 0.01, "seed {seed}: {both:?} m");
        assert!(polished[worst] < filter[worst] + 0.05, "seed {seed}: {} m", polished[worst]);
        let end = mapper.trajectory().last().unwrap().1;
        assert!(mapper.pose().distance(&end) < 1e-6, "all particles continue from the end");
    }
}

/// Errors of the relative poses of stored scans ten apart, ascending, m.
#[cfg(test)]
fn relative_errors(mapper: &trundle_mapping::ParticleMapper, drive: &Drive) -> Vec<f64> {
    let truth = |stamp: Stamp| {
        let at = drive.scans.iter().position(|scan| scan.stamp() == stamp);
        drive.truth[at.unwrap()]
    };
    let error = |pair: &[(Stamp, Pose2)]| {
        let known = truth(pair[0].0).inverse() * truth(pair[10].0);
        known.distance(&(pair[0].1.inverse() * pair[10].1))
    };
    let mut errors: Vec<f64> = mapper.trajectory().windows(11).map(error).collect();
    errors.sort_by(f64::total_cmp);
    errors
}
