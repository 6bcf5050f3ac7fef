//! Plans of robots with an outline, on all maps.

use crate::support::{LIMITS, at_home, cpu_ms};
use crate::{all_maps, nav_data, outline_judge, random_pairs};
use std::path::Path;
use trundle_core::{DifferentialDrive, Footprint, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, Planner};

/// Questions of an outline on a map. Source: the goal of these figures.
const QUESTIONS: usize = 50;

/// Outlines of the benchmark: rear, front and half width in m; the axle is at 0.
const OUTLINES: [(&str, f64, f64, f64); 5] = [
    ("0.36 x 0.36 m", -0.18, 0.18, 0.18),
    ("0.5 x 0.4 m", -0.25, 0.25, 0.2),
    ("0.6 x 0.4 m, axle at the rear", -0.1, 0.5, 0.2),
    ("0.8 x 0.3 m", -0.4, 0.4, 0.15),
    ("0.9 x 0.6 m", -0.45, 0.45, 0.3),
];

/// Times and answers of an outline.
#[derive(Default)]
struct Answers {
    /// Processor time of each answer \[ms\].
    ms: Vec<f64>,
    found: usize,
    /// Start or goal in an obstacle.
    misplaced: usize,
    /// No path.
    blocked: usize,
}

/// A row an outline, and one of all. Every found trajectory is judged by the tests' checker.
pub fn print(data: &Path) {
    println!(
        "| outline | plans | found | start or goal in an obstacle | no path | ms median | p99 | worst |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let maps: Vec<_> = all_maps().map(|(_, file)| nav_data::read_map(&data.join(file))).collect();
    let pairs: Vec<_> = maps.iter().map(|grid| random_pairs(grid, QUESTIONS)).collect();
    let mut all = Answers::default();
    for (name, rear, front, half) in OUTLINES {
        let outline = [(front, half), (rear, half), (rear, -half), (front, -half)];
        let outline: Vec<_> = outline.map(|(x, y)| Vector2::new(x, y)).to_vec();
        let mut answers = Answers::default();
        for (grid, pairs) in maps.iter().zip(&pairs) {
            answers.ask(grid, &outline, pairs);
        }
        answers.print(name);
        all.add(answers);
    }
    all.print("all");
}

impl Answers {
    /// Asks a planner that has the map's distance field.
    fn ask(&mut self, grid: &OccupancyGrid, outline: &[Vector2], pairs: &[(Pose2, Pose2)]) {
        let footprint = Footprint::polygon(outline.to_vec()).unwrap();
        let mut planner = Planner::new(at_home(), &footprint, LIMITS, DifferentialDrive::KOBUKI).unwrap();
        planner.plan(grid, pairs[0].0, Twist2::ZERO, pairs[0].1);
        for (start, goal) in pairs {
            let begin = cpu_ms();
            let plan = planner.plan(grid, *start, Twist2::ZERO, *goal);
            self.ms.push(cpu_ms() - begin);
            match plan {
                // The planner leads such a robot out of the obstacle first.
                Plan::Found(_) if outline_judge::touches(grid, outline, *start) => self.misplaced += 1,
                Plan::Found(result) => {
                    outline_judge::judge_outline(grid, outline, &result, (*start, *goal));
                    self.found += 1;
                }
                Plan::Blocked { .. } => self.blocked += 1,
                _ => self.misplaced += 1,
            }
        }
    }

    fn add(&mut self, other: Self) {
        self.ms.extend(other.ms);
        self.found += other.found;
        self.misplaced += other.misplaced;
        self.blocked += other.blocked;
    }

    fn print(&self, name: &str) {
        let mut ms = self.ms.clone();
        ms.sort_by(f64::total_cmp);
        let at = |share: f64| ms[((ms.len() - 1) as f64 * share).round() as usize];
        let (found, misplaced, blocked) = (self.found, self.misplaced, self.blocked);
        println!(
            "| {name} | {} | {found} | {misplaced} | {blocked} | {:.2} | {:.1} | {:.1} |",
            ms.len(),
            at(0.5),
            at(0.99),
            at(1.0)
        );
    }
}
