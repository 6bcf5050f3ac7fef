//! Pictures of a docking manoeuvre: the whole, and each of its motions.

use super::table::amount;
use trundle_core::{Footprint, OccupancyGrid, Pose2, Vector2};
use trundle_docking::corridor::Problem;
use trundle_docking::{Manoeuvre, Motion, Obstacle, Solution, Step};
use trundle_viz::{Color, DotStyle, LineStyle, MapPicture, PoseStyle};

/// Time between two outlines of the footprint; together they show the floor that it covers. Source: ours.
const OUTLINE_PERIOD_S: f64 = 0.1;
/// Largest number of outlines in a picture. Source: ours.
const MAX_OUTLINES: f64 = 400.0;
/// Colour of obstacles.
const SOLID: Color = Color::rgb(0x9a_a1_a9);

/// The obstacles of a docking task: a map or a list.
#[derive(Debug, Clone, Copy)]
pub struct DockingObstacles<'a> {
    /// The map.
    pub grid: Option<&'a OccupancyGrid>,
    /// The list.
    pub problem: Option<&'a Problem>,
}

/// Picture of a docking task: obstacles, start, goal, and the numbered motions of the manoeuvre. Without a manoeuvre, `in_the_way` marks
/// the obstacle that prevents it.
pub fn manoeuvre_picture<'a>(
    around: DockingObstacles<'a>,
    footprint: &Footprint,
    ends: (Pose2, Pose2),
    found: Option<&Solution>,
    in_the_way: Option<Vector2>,
) -> MapPicture<'a> {
    let mut picture = ground(around);
    if let Some(found) = found {
        picture = with_manoeuvre(picture, &found.manoeuvre, footprint);
    }
    if let Some(at) = in_the_way {
        picture = picture.dots("in the way", &[at], DotStyle::crowd(Color::PURPLE).radius(7.0));
    }
    let (center, half) = view(footprint, ends, found);
    let picture = with_ends(picture, footprint, ends).window(center, half);
    match found {
        Some(found) => with_numbers(picture, &found.manoeuvre, footprint),
        None => picture,
    }
}

/// A picture of each motion. Its title has the number, kind, amount and duration of the motion.
pub fn step_pictures<'a>(
    around: DockingObstacles<'a>,
    footprint: &Footprint,
    ends: (Pose2, Pose2),
    found: &Solution,
) -> Vec<(String, MapPicture<'a>)> {
    let (center, half) = view(footprint, ends, Some(found));
    let picture = |step: &Step| {
        let poses = between(step.lasts, |time| found.manoeuvre.at(step.starts + time).0);
        with_ends(ground(around), footprint, ends)
            .swept("floor covered", &poses, footprint, Color::SKY)
            .outlines("before the motion", &[step.from], footprint, Color::BLUE.alpha(90))
            .outlines("after it", &[step.to], footprint, Color::BLUE)
            .arrow("motion", &trail(step, footprint), LineStyle::solid(Color::BLACK).width(1.4))
            .window(center, half)
    };
    let titled = |(i, step): (usize, &Step)| {
        let (word, amount) = (step.motion.word(), amount(step.motion));
        (format!("{}  {word} {amount}, {:.1} s", i + 1, step.lasts), picture(step))
    };
    found.manoeuvre.steps().iter().enumerate().map(titled).collect()
}

/// Middle and half side of the square that holds the manoeuvre, m.
pub fn view(
    footprint: &Footprint,
    (start, goal): (Pose2, Pose2),
    found: Option<&Solution>,
) -> (Vector2, f64) {
    let steps = found.map_or(&[][..], |found| found.manoeuvre.steps());
    let places = steps.iter().map(|step| step.to.position()).chain([goal.position()]);
    let (low, high) =
        places.fold((start.position(), start.position()), |(low, high), p| (low.inf(&p), high.sup(&p)));
    ((low + high) / 2.0, (high - low).amax() / 2.0 + 1.3 * footprint.circumscribed_radius() + 0.15)
}

fn ground(around: DockingObstacles<'_>) -> MapPicture<'_> {
    match (around.problem, around.grid) {
        (Some(problem), _) => with_obstacles(MapPicture::blank(), problem),
        (None, Some(grid)) => MapPicture::over(grid),
        (None, None) => MapPicture::blank(),
    }
}

/// Adds start and goal. The legend names them, because two names beside each other would overlap.
fn with_ends<'a>(
    picture: MapPicture<'a>,
    footprint: &Footprint,
    (start, goal): (Pose2, Pose2),
) -> MapPicture<'a> {
    let pose = |color: Color| PoseStyle::named(color).nameless().with_footprint(footprint.clone());
    picture.pose("start", start, pose(Color::GREEN)).pose("goal", goal, pose(Color::VERMILLION))
}

/// Adds the floor that the footprint covers, and its outline at the end of each motion.
fn with_manoeuvre<'a>(
    picture: MapPicture<'a>,
    manoeuvre: &Manoeuvre,
    footprint: &Footprint,
) -> MapPicture<'a> {
    let poses = between(manoeuvre.duration(), |time| manoeuvre.at(time).0);
    let ends: Vec<Pose2> = manoeuvre.steps().iter().rev().skip(1).map(|step| step.to).collect();
    picture.swept("floor covered", &poses, footprint, Color::SKY).outlines(
        "after a motion",
        &ends,
        footprint,
        Color::BLUE,
    )
}

/// Adds an arrow with a number for each motion.
fn with_numbers<'a>(picture: MapPicture<'a>, manoeuvre: &Manoeuvre, footprint: &Footprint) -> MapPicture<'a> {
    let trails: Vec<Vec<Vector2>> = manoeuvre.steps().iter().map(|step| trail(step, footprint)).collect();
    let aside = 0.2 * footprint.circumscribed_radius();
    let numbered = |(i, trail): (usize, &Vec<Vector2>)| ((i + 1).to_string(), beside(trail, aside));
    let numbers: Vec<(String, Vector2)> = trails.iter().enumerate().map(numbered).collect();
    let style = LineStyle::solid(Color::BLACK).width(1.4);
    trails.iter().fold(picture, |picture, trail| picture.arrow("motion", trail, style)).badges(
        "its number",
        &numbers,
        Color::BLACK,
    )
}

/// The path of the axle's centre. For a turn on the spot: the path of a point ahead of it, at half the circumscribed radius.
fn trail(step: &Step, footprint: &Footprint) -> Vec<Vector2> {
    const PIECES: u32 = 24;
    match step.motion {
        Motion::Drive(_) => {
            vec![step.from.position(), (step.from.position() + step.to.position()) / 2.0, step.to.position()]
        }
        Motion::Turn(angle) => {
            let arm = 0.5 * footprint.circumscribed_radius();
            let at = |i: u32| step.motion.after(step.from, angle * f64::from(i) / f64::from(PIECES));
            (0..=PIECES).map(|i| at(i).position() + at(i).direction() * arm).collect()
        }
    }
}

/// A place beside the middle of a trail, at the distance `by` \[m\].
fn beside(trail: &[Vector2], by: f64) -> Vector2 {
    let (first, last) = (trail[0], trail[trail.len() - 1]);
    let across = Vector2::new(first.y - last.y, last.x - first.x).try_normalize(1e-9).unwrap_or_default();
    // An arc's number lies on its outside.
    let outward = if (trail[trail.len() / 2] - (first + last) / 2.0).dot(&across) < 0.0 { -by } else { by };
    trail[trail.len() / 2] + across * outward
}

/// Poses close together over a duration, s.
fn between(seconds: f64, at: impl Fn(f64) -> Pose2) -> Vec<Pose2> {
    let count = (seconds / OUTLINE_PERIOD_S).clamp(1.0, MAX_OUTLINES).round();
    (0..=count as usize).map(|i| at(seconds * i as f64 / count)).collect()
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
