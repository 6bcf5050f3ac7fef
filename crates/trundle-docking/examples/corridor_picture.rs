//! Draws the four corridor scenarios of [Hong24], by the paper's method and by the optimal one, as one SVG:
//! `cargo run --release -p trundle-docking --example corridor_picture > docking.svg`

use std::fmt::Write;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::corridor::{Problem, Scenario};
use trundle_docking::{Docker, DockingConfig, Manoeuvre, Method, Obstacle, Plan};

/// Pixels a metre.
const SCALE: f64 = 190.0;
/// Of one drawing, px.
const SIZE: (f64, f64) = (230.0, 400.0);

fn main() {
    let (width, height) = (SIZE.0 * 4.0, SIZE.1 * 2.0);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' font-family='sans-serif'>\n<rect width='100%' height='100%' fill='white'/>\n"
    );
    for (row, method) in [Method::Paper, Method::Optimal].into_iter().enumerate() {
        let docker = Docker::new(DockingConfig { method, ..DockingConfig::default() }).expect("valid");
        for (column, scenario) in Scenario::ALL.into_iter().enumerate() {
            let problem = scenario.problem();
            let scene = problem.scene().expect("valid");
            let plan =
                docker.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
            let Plan::Found(solution) = plan else { panic!("{scenario:?} has a manoeuvre") };
            let title = format!("({}) {:.1} s", scenario.letter(), solution.manoeuvre.duration());
            let at = (SIZE.0 * column as f64, SIZE.1 * row as f64);
            draw(&mut svg, at, &problem, &solution.manoeuvre, &title).expect("a string takes all");
        }
    }
    println!("{svg}</svg>");
}

fn draw(
    svg: &mut String,
    at: (f64, f64),
    problem: &Problem,
    manoeuvre: &Manoeuvre,
    title: &str,
) -> std::fmt::Result {
    let px = |p: Vector2| (at.0 + SIZE.0 / 2.0 + p.x * SCALE, at.1 + SIZE.1 * 0.47 - p.y * SCALE);
    writeln!(
        svg,
        "<svg x='{}' y='{}' width='{}' height='{}' viewBox='{} {} {} {}'>",
        at.0, at.1, SIZE.0, SIZE.1, at.0, at.1, SIZE.0, SIZE.1
    )?;
    for obstacle in &problem.obstacles {
        let points = match obstacle {
            Obstacle::Point(p) => vec![*p],
            Obstacle::Segment(a, b) => vec![*a, *b],
            Obstacle::Polygon(corners) => corners.clone(),
        };
        polygon(
            svg,
            &points.into_iter().map(px).collect::<Vec<_>>(),
            "fill='#999' stroke='#444' stroke-width='3'",
        )?;
    }
    let outline = |pose: Pose2| match &problem.footprint {
        Footprint::Polygon { corners } => corners.iter().map(|c| px(pose.transform(*c))).collect::<Vec<_>>(),
        Footprint::Disc { .. } => Vec::new(),
    };
    let samples = (manoeuvre.duration() / 0.15) as usize;
    for i in 0..=samples {
        let (pose, _) = manoeuvre.at(0.15 * i as f64);
        polygon(svg, &outline(pose), "fill='none' stroke='#7aa6d6' stroke-width='0.6'")?;
    }
    polygon(svg, &outline(problem.start), "fill='none' stroke='#1f5fa8' stroke-width='2'")?;
    polygon(svg, &outline(problem.goal), "fill='none' stroke='#c0392b' stroke-width='2'")?;
    for pose in [problem.start, problem.goal] {
        let (a, b) = (px(pose.position()), px(pose.position() + pose.direction() * 0.22));
        writeln!(
            svg,
            "<line x1='{:.1}' y1='{:.1}' x2='{:.1}' y2='{:.1}' stroke='#222' stroke-width='2'/>",
            a.0, a.1, b.0, b.1
        )?;
    }
    let words: Vec<&str> = manoeuvre.steps().iter().map(|step| step.motion.word()).collect();
    writeln!(
        svg,
        "<rect x='{}' y='{}' width='{}' height='48' fill='white'/>",
        at.0,
        at.1 + SIZE.1 - 48.0,
        SIZE.0
    )?;
    text(svg, at.0 + 10.0, at.1 + SIZE.1 - 30.0, 15, title)?;
    text(svg, at.0 + 10.0, at.1 + SIZE.1 - 12.0, 9, &words.join(", "))?;
    writeln!(svg, "</svg>")
}

fn polygon(svg: &mut String, points: &[(f64, f64)], style: &str) -> std::fmt::Result {
    let list: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    writeln!(svg, "<polygon points='{}' {style}/>", list.join(" "))
}

fn text(svg: &mut String, x: f64, y: f64, size: u32, text: &str) -> std::fmt::Result {
    writeln!(svg, "<text x='{x}' y='{y}' font-size='{size}'>{text}</text>")
}
