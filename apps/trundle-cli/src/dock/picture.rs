use trundle::core::{Footprint, OccupancyGrid, Pose2, Vector2};
use trundle::docking::corridor::Problem;
use trundle::docking::{Manoeuvre, Obstacle, Solution};
use trundle::viz::{Color, DotStyle, LineStyle, MapPicture, PoseStyle};

/// Seconds between two of the outlines that show the floor that is covered.
const EVERY: f64 = 0.1;
/// Outlines of a long manoeuvre at most.
const OUTLINES: f64 = 400.0;
/// Boxes and other solid things.
const SOLID: Color = Color::rgb(0x9a_a1_a9);

/// What stands around: a map or a list.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) grid: Option<&'a OccupancyGrid>,
    pub(crate) problem: Option<&'a Problem>,
}

/// Start, goal, what stands around, the robot along the manoeuvre, and what forbids one.
pub(crate) fn manoeuvre_picture<'a>(
    around: Surroundings<'a>,
    footprint: &Footprint,
    (start, goal): (Pose2, Pose2),
    found: Option<&Solution>,
    in_the_way: Option<Vector2>,
) -> MapPicture<'a> {
    let blank = around.grid.map_or_else(MapPicture::blank, MapPicture::over);
    let mut picture = around.problem.map_or(blank, |problem| with_obstacles(MapPicture::blank(), problem));
    if let Some(found) = found {
        picture = with_manoeuvre(picture, &found.manoeuvre, footprint);
    }
    if let Some(at) = in_the_way {
        picture = picture.dots("in the way", &[at], DotStyle::crowd(Color::PURPLE).radius(7.0));
    }
    let reach = found.map_or(0.0, |found| {
        let ends = found.manoeuvre.steps().iter().map(|step| step.to.position());
        ends.map(|p| (p - (start.position() + goal.position()) / 2.0).amax()).fold(0.0, f64::max)
    });
    let half = reach.max(start.distance(&goal) / 2.0) + 1.3 * footprint.circumscribed_radius() + 0.15;
    // Both are named by the legend: side by side, two names would cover each other.
    let pose = |color: Color| PoseStyle::named(color).nameless().with_footprint(footprint.clone());
    picture
        .pose("start", start, pose(Color::GREEN))
        .pose("goal", goal, pose(Color::VERMILLION))
        .window((start.position() + goal.position()) / 2.0, half)
}

/// The floor it covers, the outlines where a motion ends, the axle's way and where it turns.
fn with_manoeuvre<'a>(
    picture: MapPicture<'a>,
    manoeuvre: &Manoeuvre,
    footprint: &Footprint,
) -> MapPicture<'a> {
    let count = (manoeuvre.duration() / EVERY).clamp(1.0, OUTLINES).round();
    let at = |i: usize| manoeuvre.at(manoeuvre.duration() * i as f64 / count).0;
    let poses: Vec<Pose2> = (0..=count as usize).map(at).collect();
    let steps = manoeuvre.steps();
    let between: Vec<Pose2> = steps.iter().rev().skip(1).map(|step| step.to).collect();
    let way: Vec<Vector2> = std::iter::once(manoeuvre.start())
        .chain(steps.iter().map(|step| step.to))
        .map(|p| p.position())
        .collect();
    picture
        .swept("floor covered", &poses, footprint, Color::SKY)
        .outlines("after a motion", &between, footprint, Color::BLUE)
        .polyline("way of the axle", &way, LineStyle::solid(Color::BLACK).width(1.2))
        .dots("turning place", &way, DotStyle::circles(Color::BLACK).radius(2.0))
}

fn with_obstacles<'a>(picture: MapPicture<'a>, problem: &Problem) -> MapPicture<'a> {
    let line = LineStyle::solid(Color::BLACK).width(2.0).plain();
    let points: Vec<Vector2> = problem.obstacles.iter().filter_map(point).collect();
    let picture = picture.dots("points", &points, DotStyle::crowd(Color::BLACK).radius(1.5));
    problem.obstacles.iter().fold(picture, |picture, obstacle| match obstacle {
        Obstacle::Point(_) => picture,
        Obstacle::Segment(a, b) => picture.polyline("wall", &[*a, *b], line),
        Obstacle::Polygon(corners) => picture.area("box", corners, SOLID),
    })
}

fn point(obstacle: &Obstacle) -> Option<Vector2> {
    match obstacle {
        Obstacle::Point(p) => Some(*p),
        Obstacle::Segment(..) | Obstacle::Polygon(_) => None,
    }
}
