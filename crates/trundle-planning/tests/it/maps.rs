//! Real maps, where they are at hand.

use crate::support::{at_home, cpu_ms, judge, planner};
use std::path::{Path, PathBuf};
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, PlannerConfig, PotentialConfig, PotentialKind, RoomConfig};

fn data() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/nav");
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}

/// A map_server map, trinary: as much of PGM and YAML as these files need.
fn read_map(yaml: &Path) -> OccupancyGrid {
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

fn numbers(line: &str, skip: usize) -> Vec<f64> {
    line.split(',').skip(skip).map(|word| word.parse().unwrap()).collect()
}

fn pairs(csv: &Path, skip: usize) -> Vec<(Pose2, Pose2)> {
    let text = std::fs::read_to_string(csv).unwrap();
    let rows = text.lines().map(|line| numbers(line, skip));
    rows.map(|n| (Pose2::new(n[0], n[1], n[2]), Pose2::new(n[3], n[4], n[5]))).collect()
}

#[derive(Default, Debug)]
struct Tally {
    found: usize,
    blocked: usize,
    refused: usize,
    fell_back: usize,
    one_curve: usize,
    drives: usize,
    worst_stretch: f64,
    lengths: Vec<f64>,
    way_lengths: Vec<f64>,
    ms: Vec<f64>,
}

fn run(
    name: &str,
    grid: &OccupancyGrid,
    pairs: &[(Pose2, Pose2)],
    config: PlannerConfig,
    radius: f64,
) -> Tally {
    let mut planner = planner(config, radius);
    let mut tally = Tally::default();
    for (start, goal) in pairs {
        let begin = cpu_ms();
        let plan = planner.plan(grid, *start, Twist2::ZERO, *goal);
        tally.ms.push(cpu_ms() - begin);
        match plan {
            Plan::Found(result) => {
                judge(grid, &result, *start, *goal, radius);
                tally.found += 1;
                tally.lengths.push(result.length);
                tally.way_lengths.push(result.way_points.length());
                tally.fell_back += usize::from(result.fell_back);
                tally.drives += result.curves().count();
                tally.one_curve += usize::from(result.curves().count() == 1);
                tally.worst_stretch = tally.worst_stretch.max(result.length / result.way_points.length());
            }
            Plan::Blocked { .. } => tally.blocked += 1,
            _ => tally.refused += 1,
        }
    }
    tally.ms.sort_by(f64::total_cmp);
    let of = |share: f64| tally.ms[((tally.ms.len() - 1) as f64 * share) as usize];
    eprintln!(
        "{name}: {} found ({} in one curve), {} blocked, {} refused, {} fell back; {:.1} ms CPU median, {:.1} worst; curve / way-points at most {:.3}",
        tally.found,
        tally.one_curve,
        tally.blocked,
        tally.refused,
        tally.fell_back,
        of(0.5),
        of(1.0),
        tally.worst_stretch
    );
    tally
}

#[test]
fn nav2_pairs_are_all_found() {
    let Some(data) = data() else { return };
    for (map, radius) in [("depot", 0.1755), ("depot", 0.26), ("tb3_sandbox", 0.1755)] {
        let grid = read_map(&data.join(format!("nav2/{map}.yaml")));
        let pairs = pairs(&data.join(format!("nav2/nav2_{map}.csv")), 1);
        let tally = run(&format!("{map} {radius}"), &grid, &pairs, at_home(), radius);
        assert_eq!(tally.found, pairs.len());
        // Against the shortest way that the search finds when room costs nothing.
        let room = RoomConfig { margin: 0.0, comfort: 0.0, ..RoomConfig::default() };
        let tight = run("  without comfort", &grid, &pairs, PlannerConfig { room, ..at_home() }, radius);
        let ratio = |i: usize| tally.lengths[i] / tight.way_lengths[i];
        let worst = (0..pairs.len()).map(ratio).fold(0.0, f64::max);
        let mean = (0..pairs.len()).map(ratio).sum::<f64>() / pairs.len() as f64;
        eprintln!("  curve / shortest way-points: {mean:.3} on average, at most {worst:.3}");
        assert!(mean < 1.05);
    }
}

#[test]
fn the_printed_potential_falls_back_where_it_is_trapped() {
    let Some(data) = data() else { return };
    let potential = PotentialConfig { kind: PotentialKind::Printed, ..Default::default() };
    for map in ["depot", "tb3_sandbox"] {
        let grid = read_map(&data.join(format!("nav2/{map}.yaml")));
        let pairs = pairs(&data.join(format!("nav2/nav2_{map}.csv")), 1);
        let config = PlannerConfig { potential, ..at_home() };
        let tally = run(&format!("{map}, printed"), &grid, &pairs, config, 0.1755);
        assert_eq!(tally.found, pairs.len());
        assert!(tally.fell_back < pairs.len());
    }
}

#[test]
fn mrpb_pairs_are_found() {
    let Some(data) = data() else { return };
    let text = std::fs::read_to_string(data.join("mrpb/start_goal.csv")).unwrap();
    for map in ["office01add", "room02", "track", "office02_partially_unknown"] {
        let grid = read_map(&data.join(format!("mrpb/maps/{map}/map.yaml")));
        let rows = text.lines().skip(1).filter(|line| line.split(',').nth(1) == Some(map));
        let pairs: Vec<_> = rows
            .map(|line| numbers(line, 3))
            .map(|n| (Pose2::new(n[0], n[1], n[2]), Pose2::new(n[3], n[4], n[5])))
            .collect();
        if !pairs.is_empty() {
            let tally = run(map, &grid, &pairs, at_home(), 0.26);
            assert_eq!(tally.refused + tally.blocked, 0, "{map}");
        }
    }
}
