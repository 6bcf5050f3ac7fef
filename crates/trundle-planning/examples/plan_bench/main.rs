//! Benchmark of way-points, curve and timing on the maps of ../shared/data/nav: `cargo run --release -p trundle-planning --example
//! plan_bench [-- --csv PAIRS.csv] [--seed N]`.
//!
//! Each map has its own queries, and random queries between connected places. Each query runs 20 times on an up-to-date distance field. The
//! result is the best CPU time of the thread, which is meaningful on a busy machine too. `--only-plans`, `--only-updates`, `--only-large`,
//! `--only-outlines` and `--only-printed` select one part. Every trajectory is evaluated by the tests' independent checker.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a program for the terminal"
)]

mod barn;
#[path = "../../tests/it/nav_data.rs"]
mod nav_data;
#[path = "../../tests/it/outline_judge.rs"]
mod outline_judge;
mod outlines;
mod shortest;
#[path = "../../tests/it/support.rs"]
#[expect(dead_code, reason = "shared with the tests")]
mod support;
mod updates;

use std::fmt::Write as _;
use std::sync::OnceLock;
use std::time::Instant;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{DistanceField, Plan, PlanningTimes, PotentialConfig, PotentialKind, UnknownIs};

/// The robot of the comparison with Nav2's planners, m. Source: ours.
const RADIUS: f64 = 0.26;
/// Questions a map. Source: ours.
const QUESTIONS: usize = 60;
const ROUNDS: usize = 20;
/// The planner's clearance margin beyond the footprint, used if space allows, m. Source: ours.
const MARGIN: f64 = 0.05;

struct Row {
    ms: f64,
    length: f64,
    /// Time for the way-points.
    distance: f64,
    /// The shortest any-angle length for the footprint.
    shortest: f64,
    /// The shortest any-angle length with the clearance that the plan keeps, up to the margin.
    roomy: f64,
    curves: usize,
    stages: PlanningTimes,
}

fn main() {
    let Some(data) = nav_data::data() else { return };
    if std::env::args().any(|word| word == "--only-updates") {
        return field_updates(&data);
    }
    if std::env::args().any(|word| word == "--only-large") {
        return large();
    }
    if std::env::args().any(|word| word == "--only-outlines") {
        return outlines::print(&data);
    }
    if std::env::args().any(|word| word == "--only-printed") {
        return printed(&data);
    }
    let csv = argument("--csv");
    let mut shares = Vec::new();
    let mut lines = String::from("map,sx,sy,sa,gx,gy,ga,ms,length_m,shortest_m,roomy_m\n");
    println!(
        "disc of {RADIUS} m; CPU ms with the field up to date, each question's best of {ROUNDS}; length over Theta*'s of the same clearance, of the footprint"
    );
    println!(
        "| map | cells | found | in one curve | ms median | p99 | worst | length mean | worst | way-points worst | footprint mean | worst |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, file) in [
        ("depot", "nav2/depot.yaml"),
        ("tb3_sandbox", "nav2/tb3_sandbox.yaml"),
        ("office01add", "mrpb/maps/office01add/map.yaml"),
        ("room02", "mrpb/maps/room02/map.yaml"),
    ] {
        let grid = nav_data::read_map(&data.join(file));
        let mut pairs = match file.strip_prefix("nav2/") {
            Some(_) => nav_data::pairs(&data.join(format!("nav2/nav2_{name}.csv")), 1),
            None => nav_data::mrpb_pairs(&data, name),
        };
        pairs.extend(random_pairs(&grid, QUESTIONS - pairs.len()));
        let answers = measure(&grid, &pairs);
        let rows: Vec<&Row> = answers.iter().flatten().collect();
        print_row(name, &grid, pairs.len(), &rows);
        shares.push(format!("{name}: {}", shares_of(&rows)));
        for ((a, b), row) in pairs.iter().zip(&answers) {
            let numbers = match row {
                Ok(row) => format!("{},{},{},{}", row.ms, row.length, row.shortest, row.roomy),
                Err(ms) => format!("{ms},,,"),
            };
            let _ =
                writeln!(lines, "{name},{},{},{},{},{},{},{numbers}", a.x, a.y, a.theta, b.x, b.y, b.theta);
        }
    }
    if let Some(path) = csv {
        std::fs::write(path, lines).unwrap();
    }
    println!("\nShares of the time: {}", shares.join("; "));
    if std::env::args().any(|word| word == "--only-plans") {
        return;
    }
    println!();
    field_updates(&data);
    large();
    printed(&data);
}

/// One row per query, or the time to find that no path exists, ms.
fn measure(grid: &OccupancyGrid, pairs: &[(Pose2, Pose2)]) -> Vec<Result<Row, f64>> {
    let field = DistanceField::from_grid(grid, UnknownIs::Free);
    let mut planner = support::planner(support::at_home(), RADIUS);
    planner.set_clock(Some(seconds));
    planner.plan(grid, pairs[0].0, Twist2::ZERO, pairs[0].1);
    let ask = |(start, goal): &(Pose2, Pose2)| {
        let (mut last, mut ms, mut stages) = (None, f64::INFINITY, PlanningTimes::default());
        for _ in 0..ROUNDS {
            let begin = support::cpu_ms();
            last = Some(planner.plan(grid, *start, Twist2::ZERO, *goal));
            let spent = support::cpu_ms() - begin;
            if spent < ms {
                (ms, stages) = (spent, planner.stage_times());
            }
        }
        let Some(Plan::Found(result)) = last else {
            println!("{start:?} {goal:?}: {}", last.unwrap());
            return Err(ms);
        };
        support::judge(grid, &result, *start, *goal, RADIUS);
        let by = |room: f64| shortest::shortest(&field, RADIUS + room, start.position(), goal.position());
        let (shortest, roomy) = (by(0.0), by(result.min_clearance.clamp(0.0, MARGIN)));
        let (curves, distance) = (result.curves().count(), result.waypoints.length());
        Ok(Row { ms, length: result.length, distance, shortest, roomy, curves, stages })
    };
    pairs.iter().map(ask).collect()
}

/// The wall clock, for the stages' shares.
fn seconds() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Share of each stage in the whole time.
fn shares_of(rows: &[&Row]) -> String {
    let sum = |of: fn(&PlanningTimes) -> f64| rows.iter().map(|row| of(&row.stages)).sum::<f64>();
    let stages = [sum(|s| s.field), sum(|s| s.waypoints), sum(|s| s.curve), sum(|s| s.timing)];
    let total: f64 = stages.iter().sum();
    let share = |i: usize| 100.0 * stages[i] / total;
    format!(
        "field {:.0} %, way-points {:.0} %, curve {:.0} %, timing {:.0} %",
        share(0),
        share(1),
        share(2),
        share(3)
    )
}

fn print_row(name: &str, grid: &OccupancyGrid, asked: usize, rows: &[&Row]) {
    let sorted = |of: fn(&Row) -> f64| {
        let mut values: Vec<f64> = rows.iter().map(|row| of(row)).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let ms = sorted(|row| row.ms);
    let ratio = sorted(|row| row.length / row.roomy);
    let bare = sorted(|row| row.length / row.shortest);
    let distance = sorted(|row| row.distance / row.roomy);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let at = |values: &[f64], share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    let one = rows.iter().filter(|row| row.curves == 1).count();
    println!(
        "| {name} | {} x {} | {} of {asked} | {one} | {:.2} | {:.2} | {:.2} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} |",
        grid.geometry().width,
        grid.geometry().height,
        rows.len(),
        at(&ms, 0.5),
        at(&ms, 0.99),
        at(&ms, 1.0),
        mean(&ratio),
        at(&ratio, 1.0),
        at(&distance, 1.0),
        mean(&bare),
        at(&bare, 1.0)
    );
}

/// The word after an option.
fn argument(option: &str) -> Option<String> {
    std::env::args().skip_while(|word| word != option).nth(1)
}

/// Questions between places that 4-neighbour moves between free centres connect.
fn random_pairs(grid: &OccupancyGrid, count: usize) -> Vec<(Pose2, Pose2)> {
    let field = DistanceField::from_grid(grid, UnknownIs::Free);
    let geometry = *grid.geometry();
    let sure = RADIUS + geometry.resolution / 2.0;
    let open = |cell: CellIndex| field.at_cell(cell) >= sure && grid.get(cell) == Cell::Free;
    let mut seed = argument("--seed").map_or(1_u64, |seed| seed.parse().unwrap());
    let mut next = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let mut cell = || geometry.cell((next() * geometry.len() as f64) as usize);
        let (from, to) = (cell(), cell());
        let reached = open(from) && open(to) && reachable_cells(&geometry, from, open)[geometry.linear(to)];
        let mut pose = |cell| {
            let at = geometry.center(cell);
            Pose2::new(at.x, at.y, next() * std::f64::consts::TAU)
        };
        if reached {
            pairs.push((pose(from), pose(to)));
        }
    }
    pairs
}

fn reachable_cells(geometry: &GridGeometry, from: CellIndex, open: impl Fn(CellIndex) -> bool) -> Vec<bool> {
    let mut reached = vec![false; geometry.len()];
    let mut stack = vec![from];
    while let Some(cell) = stack.pop() {
        if std::mem::replace(&mut reached[geometry.linear(cell)], true) {
            continue;
        }
        let CellIndex { col, row } = cell;
        let near = [(col + 1, row), (col, row + 1), (col.wrapping_sub(1), row), (col, row.wrapping_sub(1))];
        let inside = near.into_iter().filter(|(c, r)| *c < geometry.width && *r < geometry.height);
        stack.extend(inside.map(|(col, row)| CellIndex { col, row }).filter(|cell| open(*cell)));
    }
    reached
}

/// Cost of a change of the distance field: on the maps, and in large empty halls.
fn field_updates(data: &std::path::Path) {
    println!("| map | cells | new field, ms | 6 x 6 m changed | ms CPU, median | worst of 80 |");
    println!("|---|---|---|---|---|---|");
    for (name, file) in all_maps().filter(|(name, _)| *name != "empty_world") {
        updates::print(name, &nav_data::read_map(&data.join(file)));
    }
    updates::print("empty hall", &updates::hall(1000, 0.05));
    updates::print("empty hall", &updates::hall(4000, 0.05));
    updates::print("empty hall of 2.5 cm cells", &updates::hall(1000, 0.025));
}

/// The maps of ../shared/data/nav.
fn all_maps() -> impl Iterator<Item = (&'static str, String)> {
    let nav2 = ["depot", "tb3_sandbox"].map(|map| (map, format!("nav2/{map}.yaml")));
    let mrpb = ["office01add", "room02", "office02_partially_unknown", "track", "empty_world"];
    nav2.into_iter().chain(mrpb.map(|map| (map, format!("mrpb/maps/{map}/map.yaml"))))
}

/// A warehouse of 200 x 200 m with boxes of 1 m, shifted from row to row. The plan crosses it with a new planner.
fn large() {
    const SIZE: usize = 4000;
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), SIZE, SIZE).unwrap();
    let cell = |i: usize| {
        let (col, row) = (i % SIZE, i / SIZE);
        let is_box = row % 50 >= 30 && (col + row / 50 * 17) % 50 >= 30;
        if is_box { Cell::Occupied } else { Cell::Free }
    };
    let grid = OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap();
    let mut planner = support::planner(support::at_home(), RADIUS);
    let (start, goal) = (Pose2::new(1.0, 1.0, 0.0), Pose2::new(195.0, 195.0, 1.0));
    let begin = support::cpu_ms();
    let plan = planner.plan(&grid, start, Twist2::ZERO, goal);
    let ms = support::cpu_ms() - begin;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or("?").trim();
    println!("\n{SIZE} x {SIZE} cells, field and plan: {ms:.0} ms CPU, {peak} at most resident; {plan}");
}

/// Number of trapped descents of the printed potential over the queries of all maps; one query per BARN world.
fn printed(data: &std::path::Path) {
    println!("\n| map | questions | found | printed potential trapped |");
    println!("|---|---|---|---|");
    let mut potential = PotentialConfig::default();
    potential.kind = PotentialKind::Printed;
    let asked = |grid: &OccupancyGrid, pairs: &[(Pose2, Pose2)]| {
        let mut config = support::at_home();
        config.potential = potential;
        let mut planner = support::planner(config, RADIUS);
        let mut found = (0, 0);
        for (start, goal) in pairs {
            if let Plan::Found(result) = planner.plan(grid, *start, Twist2::ZERO, *goal) {
                found = (found.0 + 1, found.1 + usize::from(result.fell_back));
            }
        }
        found
    };
    for (map, file) in all_maps() {
        let grid = nav_data::read_map(&data.join(file));
        let pairs = random_pairs(&grid, 100);
        let (found, trapped) = asked(&grid, &pairs);
        println!("| {map} | {} | {found} | {trapped} |", pairs.len());
    }
    let worlds = barn::worlds(data);
    let answers = worlds.iter().map(|grid| asked(grid, &[barn::question()]));
    let (found, trapped) = answers.fold((0, 0), |sum, answer| (sum.0 + answer.0, sum.1 + answer.1));
    println!("| BARN's worlds | {} | {found} | {trapped} |", worlds.len());
}
