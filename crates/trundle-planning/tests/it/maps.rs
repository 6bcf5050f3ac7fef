//! Real maps, if they are available.

use crate::nav_data::{data, mrpb_pairs, pairs, read_map};
use crate::support::{at_home, cpu_ms, judge, planner};
use trundle_core::{OccupancyGrid, Pose2, Twist2};
use trundle_planning::{Plan, PlannerConfig, PotentialConfig, PotentialKind};

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
                tally.way_lengths.push(result.waypoints.length());
                tally.fell_back += usize::from(result.fell_back);
                tally.drives += result.curves().count();
                tally.one_curve += usize::from(result.curves().count() == 1);
                tally.worst_stretch = tally.worst_stretch.max(result.length / result.waypoints.length());
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
        // Compared with the shortest path of a search without clearance costs.
        let mut config = at_home();
        config.room.margin = 0.0;
        config.room.comfort = 0.0;
        let tight = run("  without comfort", &grid, &pairs, config, radius);
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
    let mut potential = PotentialConfig::default();
    potential.kind = PotentialKind::Printed;
    for map in ["depot", "tb3_sandbox"] {
        let grid = read_map(&data.join(format!("nav2/{map}.yaml")));
        let pairs = pairs(&data.join(format!("nav2/nav2_{map}.csv")), 1);
        let mut config = at_home();
        config.potential = potential;
        let tally = run(&format!("{map}, printed"), &grid, &pairs, config, 0.1755);
        assert_eq!(tally.found, pairs.len());
        assert!(tally.fell_back < pairs.len());
    }
}

#[test]
fn mrpb_pairs_are_found() {
    let Some(data) = data() else { return };
    for map in ["office01add", "room02", "track", "office02_partially_unknown"] {
        let grid = read_map(&data.join(format!("mrpb/maps/{map}/map.yaml")));
        let pairs = mrpb_pairs(&data, map);
        if !pairs.is_empty() {
            let tally = run(map, &grid, &pairs, at_home(), 0.26);
            assert_eq!(tally.refused + tally.blocked, 0, "{map}");
        }
    }
}
