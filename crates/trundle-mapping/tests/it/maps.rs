//! Maps of simulated rooms against the true walls.

use crate::flat_room::FlatRoom;
use std::f64::consts::TAU;
use trundle_core::{Cell, CellIndex, OccupancyGrid, Pose2, Vector2};
use trundle_mapping::{GridMapper, MapperConfig};

/// The part of a grid that is known, as ASCII art, highest y first.
fn ascii(grid: &OccupancyGrid) -> String {
    let geometry = grid.geometry();
    let known: Vec<CellIndex> =
        (0..geometry.len()).filter(|&i| grid.cells()[i] != Cell::Unknown).map(|i| geometry.cell(i)).collect();
    let cols = || known.iter().map(|c| c.col);
    let rows = || known.iter().map(|c| c.row);
    let (Some(left), Some(right)) = (cols().min(), cols().max()) else { return String::new() };
    let (bottom, top) = (rows().min().unwrap(), rows().max().unwrap());
    let letter = |row, col| match grid.get(CellIndex { col, row }) {
        Cell::Occupied => '#',
        Cell::Free => '.',
        Cell::Unknown => ' ',
    };
    let line = |row| (left..=right).map(|col| letter(row, col)).collect::<String>().trim_end().to_owned();
    (bottom..=top).rev().map(line).collect::<Vec<_>>().join("\n")
}

/// Moves the walls from the borders of cells to their middles.
const INTO_CELLS: Pose2 = Pose2 { x: 0.1, y: 0.1, theta: 0.0 };

fn coarse() -> GridMapper {
    let mut config = MapperConfig::default();
    config.resolution = 0.2;
    config.blind_range = 0.0;
    GridMapper::new(config).unwrap()
}

#[test]
fn one_place_with_a_narrow_view() {
    let mut mapper = coarse();
    let pose = Pose2::new(-2.5, 0.1, 0.0);
    for _ in 0..5 {
        mapper.insert(INTO_CELLS * pose, &FlatRoom::furnished().scan(pose, 1.2, 400, 4.5, |_| 0.0));
    }
    insta::assert_snapshot!(ascii(mapper.grid()), @r"
                 ########
               ...........
              ............
            ..............
           ...............
         ............#..
        .............#
      ...............###...
     ......................
    .......................
    .......................
     .#####................
            ...............
                 ..........
                     ......
                         .
    ");
}

// Corner cells of 0.2 m that are half free may become free or occupied.
#[test]
fn the_whole_room_after_a_walk() {
    let mut mapper = coarse();
    for i in 0..40 {
        let t = f64::from(i) / 40.0 * TAU;
        let pose = Pose2::new(2.5 * t.cos(), 1.5 * t.sin(), t);
        mapper.insert(INTO_CELLS * pose, &FlatRoom::furnished().scan(pose, TAU, 1440, 8.0, |_| 0.0));
    }
    insta::assert_snapshot!(ascii(mapper.grid()), @r"
    ###############################
    #.............................#
    #.............................#
    #.............................#
    #.............................#
    #...................# #.......#
    #...................# #.......#
    #...................###.......#
    #.............................#
    #.............................#
    #.............................#
    #....### #....................#
    #....#   #....................#
    #....#####....................#
    #.............................#
    #.............................#
    #.............................#
    #.............................#
    #.............................#
    #.............................#
    ###############################
    ");
}

#[test]
fn walls_lie_within_a_cell_of_the_truth_and_the_inside_is_free() {
    let room = FlatRoom::furnished();
    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    let into_cells = Pose2::new(0.025, 0.025, 0.0);
    for i in 0..60 {
        let t = f64::from(i) / 60.0 * TAU;
        let pose = Pose2::new(2.5 * t.cos(), 1.5 * t.sin(), t);
        let noise =
            |beam: usize| (crate::boxes::mix(beam as u64 ^ (i as u64) << 32) >> 11) as f64 / 2_f64.powi(53);
        mapper.insert(into_cells * pose, &room.scan(pose, TAU, 720, 8.0, |b| (noise(b) - 0.5) * 0.03));
    }
    let geometry = *mapper.grid().geometry();
    let (mut occupied, mut free, mut shadow) = (0, 0, 0);
    for (i, cell) in mapper.grid().cells().iter().enumerate() {
        let p = into_cells.inverse().transform(geometry.center(geometry.cell(i)));
        let outside = (p.x.abs() - 3.0).max(p.y.abs() - 2.0);
        match cell {
            Cell::Occupied => {
                occupied += 1;
                let near = (0..64)
                    .filter_map(|k| room.cast(p + Vector2::repeat(1e-6), f64::from(k) / 64.0 * TAU))
                    .fold(f64::INFINITY, f64::min);
                assert!(near < 0.06, "an obstacle {near} m from any wall");
            }
            Cell::Free => {
                free += 1;
                assert!(outside < 0.03, "free {outside} m outside");
            }
            Cell::Unknown => shadow += usize::from(outside < -0.03 && !in_furniture(p)),
        }
    }
    assert!(shadow < 60, "{shadow} cells unseen: some of the corner behind the box is");
    assert!(occupied > 450 && free as f64 * 0.0025 > 22.5, "{occupied} occupied, {free} free");
}

fn in_furniture(p: Vector2) -> bool {
    let within = |x: (f64, f64), y: (f64, f64)| {
        p.x > x.0 - 0.04 && p.x < x.1 + 0.04 && p.y > y.0 - 0.04 && p.y < y.1 + 0.04
    };
    within((1.0, 1.4), (0.6, 1.0)) || within((-2.0, -1.2), (-0.6, -0.2))
}
