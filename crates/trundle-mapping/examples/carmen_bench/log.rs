//! The little of CARMEN's format that this needs; `trundle-io` has the reader for users.

use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};

pub struct Log {
    /// Odometry and scan.
    pub scans: Vec<(Pose2, Scan)>,
}

impl Log {
    pub fn read(path: &str, laser_x: f64) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let lines: Vec<Vec<&str>> = text
            .lines()
            .filter(|line| line.starts_with("FLASER"))
            .map(|line| line.split_whitespace().collect())
            .collect();
        let range = |field: &str| field.parse::<f64>().unwrap();
        let beams = |line: &Vec<&str>| line[1].parse::<usize>().unwrap();
        let all = lines.iter().flat_map(|line| line[2..2 + beams(line)].iter().map(|f| range(f)));
        let limit = all.fold(0.0, f64::max) - 0.25;
        let scan = |line: &Vec<&str>| {
            let n = beams(line);
            let beam = |f: &&str| {
                let range = range(f);
                if range < limit { Beam::Hit { range } } else { Beam::Unseen }
            };
            let step = std::f64::consts::PI / (n - n % 2) as f64;
            let stamp = Stamp::from_secs(line[n + 8].parse().unwrap()).unwrap();
            let all = line[2..2 + n].iter().map(beam).collect();
            let scan = Scan::new(stamp, Vector2::new(laser_x, 0.0), -std::f64::consts::FRAC_PI_2, step, all);
            let odom = Pose2::new(range(line[n + 5]), range(line[n + 6]), range(line[n + 7]));
            (odom, scan.unwrap())
        };
        Self { scans: lines.iter().map(scan).collect() }
    }
}

/// `t x y theta` lines.
pub fn read_trajectory(path: &str) -> Option<Vec<(Stamp, Pose2)>> {
    let text = std::fs::read_to_string(path).ok()?;
    let pose = |line: &str| {
        let v: Vec<f64> = line.split_whitespace().map(|f| f.parse().unwrap()).collect();
        (Stamp::from_secs(v[0]).unwrap(), Pose2::new(v[1], v[2], v[3]))
    };
    Some(text.lines().map(pose).collect())
}
