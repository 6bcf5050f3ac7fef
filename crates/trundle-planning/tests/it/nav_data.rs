//! Real maps and queries, if available: ../shared/data/nav.

use std::path::{Path, PathBuf};
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Pose2, Vector2};

pub fn data() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/nav");
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}

/// A map_server map, trinary: as much of PGM and YAML as these files need.
pub fn read_map(yaml: &Path) -> OccupancyGrid {
    let text = std::fs::read_to_string(yaml).unwrap();
    let field = |name: &str| text.lines().find_map(|line| line.strip_prefix(name)).unwrap().trim();
    let bytes = std::fs::read(yaml.with_file_name(field("image:"))).unwrap();
    let (mut words, mut at) = (Vec::new(), 0);
    while words.len() < 4 {
        let end = at + bytes[at..].iter().position(u8::is_ascii_whitespace).unwrap();
        if bytes[at] == b'#' {
            at += bytes[at..].iter().position(|b| *b == b'\n').unwrap() + 1;
        } else {
            if end > at {
                words.push(std::str::from_utf8(&bytes[at..end]).unwrap());
            }
            at = end + 1;
        }
    }
    assert_eq!(words[0], "P5");
    let (width, height): (usize, usize) = (words[1].parse().unwrap(), words[2].parse().unwrap());
    let number = |name: &str| field(name).parse::<f64>().unwrap();
    let origin: Vec<f64> =
        field("origin:").trim_matches(['[', ']']).split(',').map(|w| w.trim().parse().unwrap()).collect();
    let geometry =
        GridGeometry::new(number("resolution:"), Vector2::new(origin[0], origin[1]), width, height).unwrap();
    let cell = |value: &u8| {
        let occupied = (255.0 - f64::from(*value)) / 255.0;
        if occupied > number("occupied_thresh:") {
            Cell::Occupied
        } else if occupied < number("free_thresh:") {
            Cell::Free
        } else {
            Cell::Unknown
        }
    };
    let pixels = &bytes[at..at + width * height];
    OccupancyGrid::new(geometry, pixels.chunks(width).rev().flatten().map(cell).collect()).unwrap()
}

pub fn numbers(line: &str, skip: usize) -> Vec<f64> {
    line.split(',').skip(skip).map(|word| word.parse().unwrap()).collect()
}

pub fn pairs(csv: &Path, skip: usize) -> Vec<(Pose2, Pose2)> {
    let text = std::fs::read_to_string(csv).unwrap();
    let rows = text.lines().map(|line| numbers(line, skip));
    rows.map(|n| (Pose2::new(n[0], n[1], n[2]), Pose2::new(n[3], n[4], n[5]))).collect()
}

/// The queries of MRPB for one of its maps.
pub fn mrpb_pairs(data: &Path, map: &str) -> Vec<(Pose2, Pose2)> {
    let text = std::fs::read_to_string(data.join("mrpb/start_goal.csv")).unwrap();
    let rows = text.lines().skip(1).filter(|line| line.split(',').nth(1) == Some(map));
    let pair = |n: Vec<f64>| (Pose2::new(n[0], n[1], n[2]), Pose2::new(n[3], n[4], n[5]));
    rows.map(|line| pair(numbers(line, 3))).collect()
}
