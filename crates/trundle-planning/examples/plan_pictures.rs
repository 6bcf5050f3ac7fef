//! Draws the pictures of docs/algorithms/planning.md: `cargo xtask pictures planning`, which calls
//! `cargo run --release -p trundle-planning --example plan_pictures -- FOLDER`.

#![expect(clippy::unwrap_used, reason = "a program for the terminal")]

#[path = "../tests/it/support.rs"]
#[expect(dead_code, reason = "shared with the tests")]
mod support;

use std::fmt::Write as _;
use trundle_core::{Cell, DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{
    Curve, DistanceField, HalfPlane, MovingObstacle, PlanResult, Planner, PlannerConfig, PotentialConfig,
    PotentialField, UnknownIs,
};

const ROOM: &str = "
    ############################################################
    #.............#....................#.......................#
    #.............#....................#.......................#
    #.............#....................#.......................#
    #.............#.........####.......#.......................#
    #.............#.........####.......#.......######..........#
    #.............#.........####.......#.......######..........#
    #.......................####...............######..........#
    #..........................................######..........#
    #..........................................................#
    #.............#....................#.......................#
    #.............#....................#.......................#
    #####.....#####...........##########.......................#
    #.............#...........#........####.....################
    #.............#...........#........#.......................#
    #.........................#........#.......................#
    #.........................#................................#
    #.............................................##...........#
    #.............#...........#...................##...........#
    #.............#...........#........#.......................#
    ############################################################";
/// The robot's radius, m. Source: ours.
const ROBOT: f64 = 0.13;
/// Pixels per metre. Source: ours.
const SCALE: f64 = 120.0;

/// A picture in the map frame.
struct Picture {
    body: String,
    low: Vector2,
    size: Vector2,
}

impl Picture {
    fn of(grid: &OccupancyGrid) -> Self {
        let geometry = *grid.geometry();
        let size = Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
        Self { body: String::new(), low: geometry.origin, size }
    }

    fn at(&self, p: Vector2) -> String {
        format!("{:.1},{:.1}", (p.x - self.low.x) * SCALE, (self.size.y - (p.y - self.low.y)) * SCALE)
    }

    fn cells(&mut self, grid: &OccupancyGrid, color: impl Fn(usize) -> Option<String>) {
        let geometry = *grid.geometry();
        let side = geometry.resolution * SCALE;
        for linear in 0..geometry.len() {
            if let Some(fill) = color(linear) {
                let cell = geometry.cell(linear);
                let (x, y) = (cell.col as f64 * side, (geometry.height - 1 - cell.row) as f64 * side);
                let _ = writeln!(
                    self.body,
                    "<rect x='{x:.1}' y='{y:.1}' width='{side:.1}' height='{side:.1}' fill='{fill}'/>"
                );
            }
        }
    }

    fn walls(&mut self, grid: &OccupancyGrid) {
        self.cells(grid, |i| (grid.cells()[i] == Cell::Occupied).then(|| "#3a3f47".to_owned()));
    }

    fn line(&mut self, points: &[Vector2], style: &str) {
        let points: Vec<String> = points.iter().map(|p| self.at(*p)).collect();
        let _ = writeln!(self.body, "<polyline points='{}' fill='none' {style}/>", points.join(" "));
    }

    fn polygon(&mut self, points: &[Vector2], style: &str) {
        let points: Vec<String> = points.iter().map(|p| self.at(*p)).collect();
        let _ = writeln!(self.body, "<polygon points='{}' {style}/>", points.join(" "));
    }

    fn disc(&mut self, p: Vector2, radius: f64, style: &str) {
        let at = self.at(p);
        let (x, y) = at.split_once(',').unwrap();
        let _ = writeln!(self.body, "<circle cx='{x}' cy='{y}' r='{:.1}' {style}/>", radius * SCALE);
    }

    fn text(&mut self, p: Vector2, text: &str) {
        let at = self.at(p);
        let (x, y) = at.split_once(',').unwrap();
        let style = "font-family='sans-serif' font-size='16' fill='#3a3f47'";
        let _ = writeln!(self.body, "<text x='{x}' y='{y}' {style}>{text}</text>");
    }

    fn save(self, name: &str) {
        let folder = std::env::args().nth(1).expect("the folder of the pictures");
        std::fs::create_dir_all(&folder).unwrap();
        let (w, h) = (self.size.x * SCALE, self.size.y * SCALE);
        let head =
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {w:.0} {h:.0}' width='{w:.0}'>");
        let text = format!("{head}\n<rect width='100%' height='100%' fill='white'/>\n{}</svg>\n", self.body);
        std::fs::write(format!("{folder}/{name}.svg"), text).unwrap();
    }
}

fn main() {
    let grid = OccupancyGrid::from_ascii(0.1, ROOM).unwrap();
    let (start, goal) = (Pose2::new(0.35, 0.35, 1.2), Pose2::new(5.5, 1.8, 0.6));
    let mut planner = support::planner(support::at_home(), ROBOT);
    let plan = support::found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    field(&grid);
    potential(&grid, goal.position());
    trajectory(&grid, &plan);
    speeds(&plan);
    outline();
    obstacles();
}

fn field(grid: &OccupancyGrid) {
    let field = DistanceField::from_grid(grid, UnknownIs::Free);
    let mut picture = Picture::of(grid);
    picture.cells(grid, |i| {
        let shade = (field.at_cell(grid.geometry().cell(i)) / 1.0).min(1.0);
        Some(format!(
            "rgb({:.0},{:.0},{:.0})",
            30.0 + 225.0 * shade,
            60.0 + 180.0 * shade,
            110.0 + 120.0 * shade
        ))
    });
    picture.walls(grid);
    picture.save("field");
}

/// The force of the printed potential, and the end points of its descents from all starts.
fn potential(grid: &OccupancyGrid, goal: Vector2) {
    let field = DistanceField::from_grid(grid, UnknownIs::Free);
    let printed = PotentialField::new(&field, goal, ROBOT, PotentialConfig::default());
    let mut picture = Picture::of(grid);
    picture.walls(grid);
    for i in (0..grid.geometry().len()).step_by(3) {
        let centre = grid.geometry().center(grid.geometry().cell(i));
        if field.distance(centre) > ROBOT {
            let along = printed.force(centre).try_normalize(1e-9).unwrap_or_default() * 0.09;
            picture.line(&[centre - along, centre + along], "stroke='#2a6fb0' stroke-width='2'");
            picture.disc(centre + along, 0.015, "fill='#2a6fb0'");
        }
    }
    picture.disc(goal, 0.08, "fill='#d1495b'");
    picture.save("potential");
}

fn trajectory(grid: &OccupancyGrid, plan: &PlanResult) {
    let mut picture = Picture::of(grid);
    for curve in plan.curves() {
        for planes in curve.corridors() {
            picture.polygon(
                &HalfPlane::outline(planes),
                "fill='#edae49' fill-opacity='0.10' stroke='#edae49' stroke-width='1'",
            );
        }
    }
    picture.walls(grid);
    picture.line(plan.raw.points(), "stroke='#9aa5b1' stroke-width='3' stroke-dasharray='4 6'");
    picture.line(plan.waypoints.points(), "stroke='#2a6fb0' stroke-width='2'");
    plan.waypoints.points().to_vec().into_iter().for_each(|p| picture.disc(p, 0.04, "fill='#2a6fb0'"));
    for curve in plan.curves() {
        picture.line(&along(curve), "stroke='#d1495b' stroke-width='5'");
        for row in curve.active() {
            let at = curve.pieces()[row.piece].control()[row.control];
            picture.disc(at, 0.05, "fill='none' stroke='#1b1b1e' stroke-width='3'");
        }
    }
    picture.save("way");
}

fn along(curve: &Curve) -> Vec<Vector2> {
    curve.samples(0.02).iter().map(|sample| sample.pose.position()).collect()
}

/// Speed above, turn rate below, over time, with the drive's limits dashed.
fn speeds(plan: &PlanResult) {
    let mut picture =
        Picture { body: String::new(), low: Vector2::new(-0.6, -0.5), size: Vector2::new(6.8, 3.6) };
    let points = plan.trajectory.points();
    let (limits, duration) = (DriveLimits::KOBUKI, plan.trajectory.duration());
    let v: Vec<_> = points.iter().map(|p| (p.time, p.twist.v)).collect();
    let omega: Vec<_> = points.iter().map(|p| (p.time, p.twist.omega)).collect();
    let speed = Axes { name: "speed, m/s", low: 1.8, high: 2.8, range: (0.0, 0.8), step: 0.2, duration };
    speed.draw(&mut picture, &v, &[limits.v], "#d1495b");
    let turning =
        Axes { name: "turn rate, rad/s", low: 0.0, high: 1.2, range: (-4.0, 4.0), step: 2.0, duration };
    turning.draw(&mut picture, &omega, &[limits.omega, -limits.omega], "#b07800");
    picture.text(Vector2::new(5.5, -0.4), "time, s");
    picture.save("speeds");
}

/// A chart over time in a part of a picture 6 m wide.
struct Axes {
    name: &'static str,
    /// Lower and upper border of the strip in the picture, m.
    low: f64,
    high: f64,
    range: (f64, f64),
    /// From tick to tick.
    step: f64,
    duration: f64,
}

impl Axes {
    fn place(&self, time: f64, value: f64) -> Vector2 {
        let share = (value - self.range.0) / (self.range.1 - self.range.0);
        Vector2::new(time / self.duration * 6.0, self.low + share * (self.high - self.low))
    }

    fn draw(&self, picture: &mut Picture, values: &[(f64, f64)], limits: &[f64], color: &str) {
        let faint = "stroke='#d5dae0' stroke-width='1'";
        for k in 0..=((self.range.1 - self.range.0) / self.step).round() as usize {
            let value = self.range.0 + k as f64 * self.step;
            picture.line(&[self.place(0.0, value), self.place(self.duration, value)], faint);
            picture.text(self.place(0.0, value) + Vector2::new(-0.35, -0.04), &format!("{value:.1}"));
        }
        for second in 0..=self.duration as usize {
            let foot = self.place(second as f64, self.range.0);
            picture.line(&[foot, foot + Vector2::new(0.0, -0.06)], "stroke='#5b6570' stroke-width='1'");
            if second.is_multiple_of(2) {
                picture.text(foot + Vector2::new(-0.04, -0.22), &second.to_string());
            }
        }
        for limit in limits {
            let ends = [self.place(0.0, *limit), self.place(self.duration, *limit)];
            picture.line(&ends, "stroke='#5b6570' stroke-width='2' stroke-dasharray='8 6'");
        }
        let points: Vec<_> = values.iter().map(|(time, value)| self.place(*time, *value)).collect();
        picture.line(&points, &format!("stroke='{color}' stroke-width='3'"));
        picture.text(Vector2::new(0.0, self.high + 0.08), self.name);
    }
}

/// A long robot in a corridor too narrow for its circumscribed circle.
fn outline() {
    let row = |r: usize| {
        let open = r > 0 && r < 18;
        let between = if open && r.abs_diff(9) < 3 { "." } else { "#" };
        let room = if open { "." } else { "#" };
        format!("#{}{}{}#", room.repeat(15), between.repeat(14), room.repeat(15))
    };
    let grid = OccupancyGrid::from_ascii(0.1, &(0..19).map(row).collect::<Vec<_>>().join("\n")).unwrap();
    let corners =
        [(0.5, 0.2), (-0.1, 0.2), (-0.1, -0.2), (0.5, -0.2)].map(|(x, y)| Vector2::new(x, y)).to_vec();
    let footprint = Footprint::polygon(corners.clone()).unwrap();
    let mut config = PlannerConfig::default();
    config.beyond = 0.0;
    let mut planner =
        Planner::new(config, &footprint, DriveLimits::KOBUKI, DifferentialDrive::KOBUKI).unwrap();
    let (start, goal) = (Pose2::new(0.7, 0.7, 1.3), Pose2::new(3.7, 1.1, -2.0));
    let plan = support::found_plan(planner.plan(&grid, start, Twist2::ZERO, goal));
    let mut picture = Picture::of(&grid);
    picture.walls(&grid);
    for point in plan.trajectory.points().iter().step_by(20) {
        let (along, p) = (point.pose.direction(), point.pose.position());
        let across = Vector2::new(-along.y, along.x);
        let outline: Vec<_> = corners.iter().map(|c| p + along * c.x + across * c.y).collect();
        picture.polygon(&outline, "fill='#2a6fb0' fill-opacity='0.05' stroke='#2a6fb0' stroke-width='1'");
        picture.disc(p, 0.015, "fill='#d1495b'");
    }
    picture.save("outline");
}

/// Someone crosses; the robot waits. Places of both, half a second apart.
fn obstacles() {
    let wall = "#".repeat(60);
    let art = format!("{wall}\n{}\n{wall}", vec![".".repeat(60); 24].join("\n"));
    let grid = OccupancyGrid::from_ascii(0.1, &art).unwrap();
    let (start, goal) = (Pose2::new(0.8, 1.3, 0.0), Pose2::new(5.0, 1.3, 0.0));
    let obstacle = MovingObstacle::new(Vector2::new(1.7, 0.3), Vector2::new(0.0, 0.7), 0.3).unwrap();
    let mut planner = support::planner(support::at_home(), 0.1755);
    let plan = support::found_plan(planner.plan_among_moving(&grid, &[obstacle], start, Twist2::ZERO, goal));
    let mut picture = Picture::of(&grid);
    picture.walls(&grid);
    for step in 0..=4 {
        let (time, shade) = (f64::from(step) * 0.5, 0.2 + 0.2 * f64::from(step));
        picture.disc(
            obstacle.at(time),
            0.3,
            &format!("fill='none' stroke='#d1495b' stroke-opacity='{shade}' stroke-width='3'"),
        );
        let robot = plan.trajectory.at(time).pose.position();
        picture.disc(
            robot,
            0.1755,
            &format!("fill='none' stroke='#2a6fb0' stroke-opacity='{shade}' stroke-width='3'"),
        );
    }
    plan.curves().for_each(|curve| picture.line(&along(curve), "stroke='#9aa5b1' stroke-width='2'"));
    picture.save("movers");
}
