use trundle_core::{Cell, CellIndex, Footprint, GridGeometry, OccupancyGrid, Pose2, Vector2};
use trundle_sim::{HeightBand, Scene};

/// What is in a Kobuki's way.
fn band() -> HeightBand {
    HeightBand::new(0.012, 0.6).unwrap()
}

/// Cells whose middle is farther than `radius` m from every occupied cell's square.
fn free_for(grid: &OccupancyGrid, radius: f64) -> Vec<bool> {
    let geometry = grid.geometry();
    let reach = (radius / geometry.resolution + 0.5).ceil() as i64;
    let is_near = |dc: i64, dr: i64| {
        let gap = |d: i64| ((d.abs() as f64 - 0.5) * geometry.resolution).max(0.0);
        gap(dc).hypot(gap(dr)) <= radius
    };
    let offsets: Vec<(i64, i64)> = (-reach..=reach)
        .flat_map(|dr| (-reach..=reach).map(move |dc| (dc, dr)))
        .filter(|&(dc, dr)| is_near(dc, dr))
        .collect();
    let mut free = vec![true; geometry.len()];
    for (at, _) in grid.cells().iter().enumerate().filter(|(_, cell)| **cell == Cell::Occupied) {
        let CellIndex { col, row } = geometry.cell(at);
        for (dc, dr) in &offsets {
            let (col, row) = (col as i64 + dc, row as i64 + dr);
            if (0..geometry.width as i64).contains(&col) && (0..geometry.height as i64).contains(&row) {
                free[row as usize * geometry.width + col as usize] = false;
            }
        }
    }
    free
}

fn are_connected(geometry: &GridGeometry, mut free: Vec<bool>, from: Vector2, to: Vector2) -> bool {
    let place = |p| geometry.linear(geometry.cell_at(p).unwrap());
    let (start, end) = (place(from), place(to));
    let mut front = vec![start];
    while let Some(at) = front.pop() {
        if !std::mem::replace(&mut free[at], false) {
            continue;
        }
        if at == end {
            return true;
        }
        // The scenes' walls enclose the free cells: a neighbour is never past an edge.
        front.extend([at - 1, at + 1, at - geometry.width, at + geometry.width]);
    }
    false
}

fn is_straight_way_blocked(scene: &Scene) -> bool {
    let (from, to) = (scene.start, scene.goal);
    let robot = Footprint::disc(0.05).unwrap();
    (0..=200).any(|i| {
        let pose = from.interpolate(&to, f64::from(i) / 200.0);
        scene.world.collides(&robot, pose, band()).unwrap()
    })
}

#[test]
fn every_seeds_goal_is_far_hidden_free_and_reachable() {
    for (name, seed) in Scene::NAMES.into_iter().flat_map(|name| (0..30).map(move |seed| (name, seed))) {
        let scene = Scene::by_name(name, seed).unwrap();
        assert!(scene.start.distance(&scene.goal) >= 5.0, "{name} {seed}");
        assert!(is_straight_way_blocked(&scene), "{name} {seed}");
        for pose in [scene.start, scene.goal] {
            let clearance = scene.world.clearance(&Footprint::KOBUKI, pose, band()).unwrap();
            assert!(clearance >= 0.35, "{name} {seed}: {clearance}");
        }
        let grid = scene.world.true_grid(0.02, band()).unwrap();
        let (from, to) = (scene.start.position(), scene.goal.position());
        // 0.40 m: the way is nowhere narrower than 0.8 m.
        for radius in [0.20, 0.40] {
            let free = free_for(&grid, radius);
            assert!(are_connected(grid.geometry(), free, from, to), "{name} {seed} at {radius} m");
        }
    }
}

#[test]
fn seeds_move_furniture_and_stay_themselves() {
    for name in Scene::NAMES {
        let solids = |seed| Scene::by_name(name, seed).unwrap().world.solids().to_vec();
        assert_eq!(solids(4), solids(4));
        assert_ne!(solids(4), solids(5));
    }
}

#[test]
fn low_tables_stop_the_robot_and_high_ones_do_not() {
    let scene = Scene::by_name("demo", 1).unwrap();
    let touches = |x, y| scene.world.collides(&Footprint::KOBUKI, Pose2::new(x, y, 0.0), band()).unwrap();
    assert!(touches(2.3, 2.75), "low table, 0.45 m");
    assert!(!touches(3.2, 5.3), "high table, 0.72 m");
    assert!(!touches(4.4, 3.9), "door");
}

#[test]
fn the_true_grid_and_contact_agree() {
    let scene = Scene::by_name("demo", 7).unwrap();
    let grid = scene.world.true_grid(0.05, band()).unwrap();
    let geometry = grid.geometry();
    let resolution = geometry.resolution;
    let (inner, outer) =
        (Footprint::disc(resolution * 0.49).unwrap(), Footprint::disc(resolution * 0.72).unwrap());
    for at in (0..geometry.len()).step_by(37) {
        let center = geometry.center(geometry.cell(at));
        let touches =
            |robot| scene.world.collides(robot, Pose2::new(center.x, center.y, 0.0), band()).unwrap();
        match grid.cells()[at] {
            Cell::Occupied => assert!(touches(&outer), "{center}"),
            _ => assert!(!touches(&inner), "{center}"),
        }
    }
}
