//! Check of a goal against the present map and its zones.

use super::refusal::CommandRefusal;
use trundle_core::{MapAnnotations, OccupancyGrid, Pose2, ZoneKind};
use trundle_planning::FootprintCheck;

/// Centimetres of a metre. Source: SI.
const CM_PER_M: f64 = 100.0;

/// Checks that the outline at a goal reaches into no obstacle of the map and no no-go zone, as the planner does. Unknown floor is no
/// reason: the robot observes it when it comes near.
///
/// # Errors
/// When the goal is in a no-go zone; the error names the zone.
pub fn require_free(
    grid: &OccupancyGrid,
    annotations: &MapAnnotations,
    check: &FootprintCheck,
    goal: Pose2,
) -> Result<(), CommandRefusal> {
    let mut no_go = annotations.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    if let Some(zone) = no_go.find(|zone| check.overlap_with_zone(zone, grid.geometry(), goal) > 0.0) {
        let text = format!(
            "The robot would reach into the no-go {} at this goal: choose a place farther away.",
            zone.label()
        );
        return Err(CommandRefusal::of(text));
    }
    let depth_cm = CM_PER_M * check.overlap(grid, goal);
    if depth_cm > 0.0 {
        return Err(CommandRefusal::of(format!(
            "An obstacle reaches {depth_cm:.0} cm into the robot's outline at this goal: choose a place farther away."
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Footprint, Zone};

    #[test]
    fn a_goal_in_a_wall_or_a_zone_is_refused_and_one_beside_them_is_not() {
        let art = [&".".repeat(60)[..]; 40].join("\n") + "\n" + &"#".repeat(60);
        let grid = OccupancyGrid::from_ascii(0.05, &art).unwrap();
        let check = FootprintCheck::new(&Footprint::KOBUKI);
        let outline = vec![[2.0, 1.0], [3.0, 1.0], [3.0, 2.0], [2.0, 2.0]];
        let rug = Zone { id: 1, name: "rug".to_owned(), kind: ZoneKind::NoGo, outline };
        let annotations = MapAnnotations { zones: vec![rug], places: vec![] };
        let at = |x: f64, y: f64| require_free(&grid, &annotations, &check, Pose2::new(x, y, 0.0));
        assert!(at(1.0, 0.5).is_ok());
        assert!(at(1.0, 0.1).unwrap_err().text.contains("An obstacle reaches 13 cm"), "{:?}", at(1.0, 0.1));
        assert!(at(1.9, 1.5).unwrap_err().text.contains("no-go zone 'rug'"), "{:?}", at(1.9, 1.5));
        for far in [1e5, -1e5, f64::NAN] {
            assert!(at(1.0, far).is_ok(), "no map there");
        }
    }
}
