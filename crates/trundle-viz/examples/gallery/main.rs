//! Draws every kind of picture from made-up data: `cargo run -p trundle-viz --example gallery -- out/gallery`.

mod camera;
mod charts;
mod room;

use std::{env, fs, io, path::Path};
use trundle_core::{Footprint, Pose2, Vector2, Vector3};
use trundle_viz::{
    CameraView, Card, Color, LineStyle, MapPicture, PlanScene, RunMap, RunReport, Table, Verdict,
    depth_picture, feature_picture, plan_picture, trajectory_picture,
};

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).unwrap_or_else(|| "out/gallery".to_owned());
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    let run = run_report();
    let view = camera::view();
    let save = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes);
    save("report.html", run.to_html().as_bytes())?;
    save("map.png", &run.map.to_png())?;
    save("plan.png", &plan())?;
    save("trajectory.png", &trajectory())?;
    save("features.png", &feature_picture(&view.color, &view.features))?;
    save("depth.png", &depth_picture(&camera::depth()))?;
    save("typeface.png", &typeface())
}

fn run_report() -> RunReport {
    let (estimate, truth) = room::paths();
    let end = estimate[estimate.len() - 1];
    RunReport {
        title: "A drive through the room".into(),
        subtitle:
            "Room “demo”, seed 1: the robot starts with an empty map and drives to a goal behind the table."
                .into(),
        verdict: Some(Verdict::Ok(
            "The robot stands 1.8 cm and 0.6° from its goal and touched nothing.".into(),
        )),
        cards: vec![
            Card::new("distance to the goal", "1.8").unit("cm").remark("limit 5 cm").good(true),
            Card::new("heading error", "0.6").unit("deg").remark("limit 3 deg").good(true),
            Card::new("contacts", "0").remark("none allowed").good(true),
            Card::new("path", "8.31").unit("m"),
            Card::new("time to the goal", "21.4").unit("s"),
            Card::new("worst pose error", "6.2").unit("cm").remark("limit 5 cm").good(false),
        ],
        map: RunMap {
            grid: Some(room::grid()),
            landmarks: room::landmarks(),
            way_points: room::curve().iter().copied().step_by(24).collect(),
            curve: room::curve(),
            start: Some(estimate[0]),
            goal: Some(Pose2::new(end.x + 0.015, end.y - 0.01, end.theta + 0.01)),
            footprint: Some(Footprint::KOBUKI),
            scan: Some((end, room::scan(end))),
            estimated_path: estimate.clone(),
            true_path: truth.clone(),
        },
        camera: Some(CameraView { ..camera::view() }),
        depth: Some(camera::depth()),
        figures: Vec::new(),
        charts: charts::all(&estimate, &truth),
        tables: tables(),
        ..RunReport::default()
    }
}

fn tables() -> Vec<Table> {
    let errors = Table::new("Against truth", ["quantity", "value", "limit"])
        .row(["distance to the goal, m", "0.018", "0.05"])
        .row(["heading error, deg", "0.6", "3"])
        .row(["ATE RMSE, m", "0.021", ""]);
    let stages = Table::new("Time of each stage, ms", ["stage", "runs", "median", "99th percentile"])
        .row(["features", "428", "11.2", "17.9"])
        .row(["tracking", "428", "6.1", "12.4"])
        .row(["mapping", "107", "3.3", "9.8"])
        .row(["planning", "9", "24.0", "41.7"]);
    vec![errors, stages]
}

fn plan() -> Vec<u8> {
    let curve = room::curve();
    let way_points: Vec<Vector2> = curve.iter().copied().step_by(24).collect();
    plan_picture(&PlanScene {
        grid: &room::grid(),
        start: Pose2::new(curve[0].x, curve[0].y, 0.3),
        goals: &[Pose2::new(curve[curve.len() - 1].x, curve[curve.len() - 1].y, 1.57)],
        replaced: &[],
        lanes: &[],
        route: &[],
        way_points: &way_points,
        curve: &curve,
        footprint: &Footprint::KOBUKI,
        keep_out: None,
        slow: None,
    })
}

fn trajectory() -> Vec<u8> {
    let at = |i: i32| {
        let t = f64::from(i) * 0.02;
        Vector3::new(1.4 * t.sin() + 0.1 * (5.0 * t).sin(), 0.1 * (3.0 * t).cos(), 0.8 * (2.0 * t).sin())
    };
    let truth: Vec<Vector3> = (0..310).map(at).collect();
    let wobble = |(i, p): (usize, &Vector3)| p + Vector3::new(0.03, 0.0, 0.04) * (i as f64 * 0.09).sin();
    let estimate: Vec<Vector3> = truth.iter().enumerate().map(wobble).collect();
    trajectory_picture(&estimate, Some(&truth))
}

/// Every letter of the typeface, as the legend of an empty picture.
fn typeface() -> Vec<u8> {
    let letters: String = (' '..='~').chain("°±²µ·×–→".chars()).collect();
    let letters: Vec<char> = letters.chars().collect();
    let point = [Vector2::zeros(), Vector2::new(1.0, 0.3)];
    let picture =
        MapPicture::blank().polyline("The quick brown fox jumps", &point, LineStyle::solid(Color::BLUE));
    letters
        .chunks(24)
        .fold(picture, |picture, part| {
            picture.polyline(&String::from_iter(part), &point, LineStyle::dashed(Color::BLUE))
        })
        .to_png()
}
