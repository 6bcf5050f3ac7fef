//! Laws of the rasterisation of scans.

use proptest::prelude::*;
use std::collections::BTreeSet;
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};
use trundle_grid::{GridCell, MapperConfig, ScanCells};

const RESOLUTION: f64 = 0.1;

fn config() -> MapperConfig {
    let mut config = MapperConfig::default();
    config.resolution = RESOLUTION;
    config.max_range = 5.0;
    config.blind_range = 0.0;
    config
}

fn any_beam() -> impl Strategy<Value = Beam> {
    prop_oneof![
        (0.2..6.0_f64).prop_map(|range| Beam::Hit { range }),
        (0.2..6.0_f64).prop_map(|range| Beam::Free { range }),
        Just(Beam::Unseen),
    ]
}

fn any_scan() -> impl Strategy<Value = Scan> {
    prop::collection::vec(any_beam(), 1..60)
        .prop_map(|beams| Scan::new(Stamp::default(), Vector2::new(0.1, 0.0), -0.6, 0.02, beams).unwrap())
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-3.0..3.0_f64, -3.0..3.0_f64, -3.1..3.1_f64).prop_map(|(x, y, t)| Pose2::new(x, y, t))
}

fn rasterised(config: &MapperConfig, pose: Pose2, scan: &Scan) -> ScanCells {
    let mut cells = ScanCells::default();
    cells.rasterise(config, pose, scan, |_| false);
    cells
}

proptest! {
    #[test]
    fn no_cell_is_both_hit_and_free_and_all_lie_within_the_reach(pose in any_pose(), scan in any_scan()) {
        let cells = rasterised(&config(), pose, &scan);
        let hits: BTreeSet<GridCell> = cells.hits.iter().map(|hit| hit.cell).collect();
        let free: BTreeSet<GridCell> = cells.free.iter().copied().collect();
        prop_assert!(hits.is_disjoint(&free));
        prop_assert_eq!((hits.len(), free.len()), (cells.hits.len(), cells.free.len()));
        if let Some((low, high)) = cells.reach() {
            prop_assert!(hits.union(&free).all(|c| c.x >= low.x && c.y >= low.y && c.x <= high.x && c.y <= high.y));
        }
    }

    #[test]
    fn buffers_of_another_scan_change_nothing(pose in any_pose(), scan in any_scan(), other in any_scan()) {
        let fresh = rasterised(&config(), pose, &scan);
        let mut used = rasterised(&config(), Pose2::new(1.0, 2.0, 0.5), &other);
        used.rasterise(&config(), pose, &scan, |_| false);
        prop_assert_eq!((&used.hits, &used.free), (&fresh.hits, &fresh.free));
        prop_assert_eq!((used.reach(), used.ignored_beams), (fresh.reach(), fresh.ignored_beams));
    }

    #[test]
    fn the_mean_of_the_hits_lies_in_their_cell(pose in any_pose(), scan in any_scan()) {
        for hit in rasterised(&config(), pose, &scan).hits {
            let mean = hit.mean_within();
            prop_assert!(mean.x >= -1e-9 && mean.y >= -1e-9 && mean.x <= 1.0 + 1e-9 && mean.y <= 1.0 + 1e-9, "{mean}");
        }
    }

    #[test]
    fn a_shorter_largest_range_sees_no_cell_more(pose in any_pose(), scan in any_scan(), max_range in 0.5..5.0_f64) {
        let whole: BTreeSet<_> = rasterised(&config(), pose, &scan).free.into_iter().collect();
        let far = rasterised(&config(), pose, &scan).hits.iter().map(|hit| hit.cell).collect::<BTreeSet<_>>();
        let mut config = config();
        config.surface_gap = 0.0;
        let without_surfaces = rasterised(&config, pose, &scan);
        config.max_range = max_range;
        let cut = rasterised(&config, pose, &scan);
        let open: BTreeSet<_> = without_surfaces.free.iter().copied().chain(far).collect();
        prop_assert!(cut.free.iter().all(|cell| open.contains(cell)));
        prop_assert!(cut.hits.len() <= without_surfaces.hits.len());
        // Cells between two hits of one surface are not cleared: the number of cleared cells never increases.
        prop_assert!(whole.iter().all(|cell| open.contains(cell)));
    }

    #[test]
    fn a_scan_of_unseen_beams_changes_no_cell(pose in any_pose(), count in 1_usize..50) {
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.01, vec![Beam::Unseen; count]).unwrap();
        let cells = rasterised(&config(), pose, &scan);
        prop_assert_eq!((cells.hits.len(), cells.free.len(), cells.ignored_beams, cells.reach()), (0, 0, 0, None));
    }
}

#[test]
fn an_obstacle_within_the_blind_range_hides_the_cells_behind_it() {
    let scan =
        Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.1, vec![Beam::Hit { range: 2.05 }]).unwrap();
    let free_columns = |blind_range: f64, obstacle: i32| {
        let mut cells = ScanCells::default();
        let mut config = config();
        config.blind_range = blind_range;
        cells.rasterise(&config, Pose2::new(0.05, 0.05, 0.0), &scan, |cell| cell.x == obstacle);
        cells.free.len()
    };
    let all = free_columns(0.0, 4);
    assert_eq!(free_columns(0.65, 9), all, "beyond the blind range it is seen");
    assert!(free_columns(0.65, 4) <= 5 && all >= 20, "{} of {all}", free_columns(0.65, 4));
}
