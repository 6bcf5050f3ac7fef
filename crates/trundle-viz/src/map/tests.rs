//! Tests of map pictures: extent, legend, places of layers and determinism.

use super::*;

const ROOM: &str = "
    ##########
    #........#
    #........#
    #...##...#
    #........#
    ##########
    ??????????
    ??????????";

fn room() -> OccupancyGrid {
    OccupancyGrid::from_ascii(0.1, ROOM).unwrap()
}

fn line(points: &[(f64, f64)]) -> Vec<Vector2> {
    points.iter().map(|&(x, y)| Vector2::new(x, y)).collect()
}

#[test]
fn the_view_holds_what_is_known_and_what_is_drawn() {
    let grid = room();
    let (low, high) = MapPicture::over(&grid).view().extent();
    assert!(low.y > 0.05 && high.y < 0.95, "unknown rows are cropped: {low} {high}");
    let path = line(&[(0.5, 0.5), (1.5, -0.4)]);
    let picture = MapPicture::over(&grid).polyline("path", &path, LineStyle::solid(Color::BLUE));
    let (low, high) = picture.view().extent();
    assert!(low.y < -0.4 && high.x > 1.5);
    let (low, high) = picture.window(Vector2::new(0.5, 0.5), 0.2).view().extent();
    assert!((low.x - 0.3).abs() < 0.11 && (high.x - 0.7).abs() < 0.11);
}

#[test]
fn the_legend_names_what_is_there_once_and_nothing_else() {
    let grid = room();
    let path = line(&[(0.5, 0.5), (0.6, 0.4)]);
    let picture = MapPicture::over(&grid)
        .polyline("path", &path, LineStyle::solid(Color::BLUE))
        .polyline("path", &path, LineStyle::solid(Color::BLUE))
        .polyline("nothing", &line(&[(f64::NAN, 0.0)]), LineStyle::solid(Color::BLUE))
        .dots("none", &[], DotStyle::crowd(Color::GREEN));
    let labels: Vec<String> = picture.legend().into_iter().map(|item| item.label).collect();
    assert_eq!(labels, ["path", "free", "occupied", "unknown"]);
}

#[test]
fn overlays_are_drawn_where_they_belong() {
    let grid = room();
    let center = Vector2::new(0.25, 0.65);
    let picture = MapPicture::over(&grid).dots(
        "d",
        &[center],
        DotStyle { color: Color::BLUE, radius: 3.0, hollow: false },
    );
    let view = picture.view();
    let mut plot = picture.ground(&view);
    let (x, y) = view.px(center);
    assert_eq!(plot.at(x as i64, y as i64), Color::FREE.over([0; 3]));
    picture.layers[0].draw(&mut plot, &view, &[]);
    assert_eq!(plot.at(x as i64, y as i64), Color::BLUE.over([0; 3]));
}

#[test]
fn same_content_same_bytes() {
    let grid = room();
    let picture = || {
        MapPicture::over(&grid).pose("goal", Pose2::new(0.3, 0.6, 1.0), PoseStyle::named(Color::VERMILLION))
    };
    assert_eq!(picture().to_png(), picture().to_png());
    assert_ne!(picture().to_png(), picture().without_legend().to_png());
}
