use trundle::core::{Footprint, OccupancyGrid, Pose2, Vector2};
use trundle::docking::corridor::Problem;
use trundle::docking::{Manoeuvre, Obstacle, Solution};
use trundle::viz::{Color, DotStyle, LineStyle, MapPicture, PoseStyle};

/// Outlines of the robot are drawn so many times a manoeuvre.
const OUTLINES: usize = 40;

/// What stands around: a map or a list.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) grid: Option<&'a OccupancyGrid>,
    pub(crate) problem: Option<&'a Problem>,
}

/// Start, goal, what stands around, the robot's outlines along the manoeuvre, and what forbids one. A PNG.
pub(crate) fn manoeuvre_picture(
    around: Surroundings<'_>,
    footprint: &Footprint,
    (start, goal): (Pose2, Pose2),
    found: Option<&Solution>,
    in_the_way: Option<Vector2>,
) -> Vec<u8> {
    let blank = around.grid.map_or_else(MapPicture::blank, MapPicture::over);
    let mut picture = around.problem.map_or(blank, |problem| with_obstacles(MapPicture::blank(), problem));
    if let Some(found) = found {
        let (poses, way) = swept(&found.manoeuvre);
        picture = picture.outlines("the robot on its way", &poses, footprint, Color::BLUE).polyline(
            "way of the axle",
            &way,
            LineStyle::solid(Color::BLUE),
        );
    }
    if let Some(at) = in_the_way {
        picture = picture.dots("in the way", &[at], DotStyle::crowd(Color::VERMILLION).radius(7.0));
    }
    let half = start.distance(&goal) / 2.0 + 2.0 * footprint.circumscribed_radius() + 0.3;
    let pose = |color: Color| PoseStyle::named(color).with_footprint(footprint.clone());
    picture
        .pose("start", start, pose(Color::GREEN))
        .pose("goal", goal, pose(Color::VERMILLION))
        .window((start.position() + goal.position()) / 2.0, half)
        .to_png()
}

fn swept(manoeuvre: &Manoeuvre) -> (Vec<Pose2>, Vec<Vector2>) {
    let at = |i: usize| manoeuvre.at(manoeuvre.duration() * i as f64 / OUTLINES as f64).0;
    let poses: Vec<Pose2> = (0..=OUTLINES).map(at).collect();
    let way = poses.iter().map(Pose2::position).collect();
    (poses, way)
}

fn with_obstacles<'a>(picture: MapPicture<'a>, problem: &Problem) -> MapPicture<'a> {
    let line = LineStyle::solid(Color::BLACK).width(2.5).plain();
    problem.obstacles.iter().fold(picture, |picture, obstacle| match obstacle {
        Obstacle::Point(point) => {
            picture.dots("obstacles", &[*point], DotStyle::crowd(Color::BLACK).radius(2.5))
        }
        Obstacle::Segment(a, b) => picture.polyline("obstacles", &[*a, *b], line),
        Obstacle::Polygon(corners) => {
            let around: Vec<Vector2> = corners.iter().chain(corners.first()).copied().collect();
            picture.polyline("obstacles", &around, line)
        }
    })
}
