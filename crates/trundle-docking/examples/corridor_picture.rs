//! Draws the four corridor scenarios of [Hong24], above by the paper's method, below by the optimal one:
//! `cargo run --release -p trundle-docking --example corridor_picture -- docs/pictures/docking-scenarios.png`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use tiny_skia::{Color, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::corridor::{Problem, Scenario};
use trundle_docking::{Docker, DockingConfig, Manoeuvre, Method, Obstacle, Plan};

/// Pixels a metre.
const SCALE: f64 = 230.0;
/// Of one drawing, px.
const SIZE: (f64, f64) = (260.0, 420.0);

fn main() {
    let out = std::env::args().nth(1).expect("the picture's path");
    let mut pixmap = Pixmap::new(4 * SIZE.0 as u32, 2 * SIZE.1 as u32).expect("a picture of some size");
    pixmap.fill(Color::WHITE);
    for (row, method) in [Method::Paper, Method::Optimal].into_iter().enumerate() {
        let docker = Docker::new(DockingConfig { method, ..DockingConfig::default() }).expect("valid");
        for (column, scenario) in Scenario::ALL.into_iter().enumerate() {
            let problem = scenario.problem();
            let scene = problem.scene().expect("valid");
            let plan =
                docker.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
            let Plan::Found(solution) = plan else { panic!("{scenario:?} has a manoeuvre") };
            let words: Vec<&str> = solution.manoeuvre.steps().iter().map(|step| step.motion.word()).collect();
            println!(
                "{method:?} ({}): {:.2} s, {}",
                scenario.letter(),
                solution.manoeuvre.duration(),
                words.join(", ")
            );
            let middle = Vector2::new(SIZE.0 * (column as f64 + 0.5), SIZE.1 * (row as f64 + 0.5));
            Drawing { pixmap: &mut pixmap, middle }.draw(&problem, &solution.manoeuvre);
        }
    }
    pixmap.save_png(out).expect("a file that can be written");
}

struct Drawing<'p> {
    pixmap: &'p mut Pixmap,
    /// Where the map's origin is drawn, px.
    middle: Vector2,
}

impl Drawing<'_> {
    fn draw(&mut self, problem: &Problem, manoeuvre: &Manoeuvre) {
        for obstacle in &problem.obstacles {
            match obstacle {
                Obstacle::Point(p) => self.outline(&[*p, *p], [90, 90, 90], 3.0),
                Obstacle::Segment(a, b) => self.outline(&[*a, *b], [90, 90, 90], 3.0),
                Obstacle::Polygon(corners) => self.fill(corners, [165, 165, 165]),
            }
        }
        let Footprint::Polygon { corners } = &problem.footprint else { return };
        let at = |pose: Pose2| corners.iter().map(|c| pose.transform(*c)).collect::<Vec<_>>();
        for i in 0..=(manoeuvre.duration() / 0.15) as usize {
            self.outline(&at(manoeuvre.at(0.15 * i as f64).0), [150, 185, 225], 0.7);
        }
        self.outline(&at(problem.start), [30, 95, 170], 2.5);
        self.outline(&at(problem.goal), [190, 55, 45], 2.5);
        for step in manoeuvre.steps() {
            self.outline(&[step.from.position(), step.to.position()], [30, 30, 30], 2.0);
        }
        for (pose, color) in [(problem.start, [30, 95, 170]), (problem.goal, [190, 55, 45])] {
            let arrow =
                [(0.18, 0.0), (0.10, 0.035), (0.10, -0.035)].map(|(x, y)| pose.transform(Vector2::new(x, y)));
            self.fill(&arrow, color);
        }
    }

    fn path(&self, points: &[Vector2]) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for (i, p) in points.iter().enumerate() {
            let (x, y) = ((self.middle.x + p.x * SCALE) as f32, (self.middle.y - p.y * SCALE) as f32);
            if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
        }
        builder.close();
        builder.finish()
    }

    fn outline(&mut self, points: &[Vector2], color: [u8; 3], width: f32) {
        if let Some(path) = self.path(points) {
            let stroke = Stroke { width, ..Stroke::default() };
            self.pixmap.stroke_path(&path, &paint(color), &stroke, Transform::identity(), None);
        }
    }

    fn fill(&mut self, points: &[Vector2], color: [u8; 3]) {
        if let Some(path) = self.path(points) {
            self.pixmap.fill_path(
                &path,
                &paint(color),
                tiny_skia::FillRule::Winding,
                Transform::identity(),
                None,
            );
        }
    }
}

fn paint(color: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(color[0], color[1], color[2], 255);
    paint
}
