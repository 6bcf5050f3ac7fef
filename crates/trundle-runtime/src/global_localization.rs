//! Global localization: the pose anywhere on the map, by scans alone.

use crate::{config::RobotConfig, range_source::RangeSource};
use nalgebra::Matrix3;
use trundle_core::{Invalid, OccupancyGrid, Pose2, Scan, Stamp};
use trundle_mapping::{Localized, MapLocalizer, ParticleConfig};

/// Global localization by scans, for a robot with unknown pose whose camera recognises no place.
///
/// The odometry combines scans along the path, and [`MapLocalizer`] searches the combined scan in the whole map. A pose that is proved
/// better than every other must explain further scans before it is reported.
#[derive(Debug)]
pub(crate) struct GlobalLocalization {
    config: ParticleConfig,
    /// Number of searches; each one has its own random seed.
    searches: u64,
    search: Search,
}

/// State of the search.
#[derive(Debug)]
enum Search {
    /// No search: the pose is known.
    None,
    /// A search in this map begins with the next scan.
    Prepared(OccupancyGrid),
    UnderWay {
        localizer: Box<MapLocalizer>,
        /// Number of successive scans that the found pose explains.
        explained: usize,
    },
    /// The map cannot be searched.
    Hopeless,
}

/// A pose found by the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LocalizedPose {
    /// Stamp of the scan.
    pub(crate) stamp: Stamp,
    pub(crate) map_from_base: Pose2,
    /// Covariance as a right perturbation (m, m, rad).
    pub(crate) covariance: Matrix3<f64>,
}

/// Number of scans after the first that must fit a candidate pose, if images have too few features for recognition. The scans are 10 deg or
/// 0.3 m apart. Source: ours.
const MIN_CONFIRMING_SCANS: usize = 6;
/// Number of scans that must fit if images have enough features but are not recognised, which is evidence against every pose in the map.
/// Source: ours.
const MIN_CONFIRMING_SCANS_SEEN: usize = 18;
/// Longest time between two scans of a standing robot that still count as consecutive \[s\]. Source: ours.
const MAX_STANDING_GAP_S: f64 = 3600.0;
/// Smallest share of a scan that the map must explain. A pose with less is rejected. Source: ours.
const MIN_EXPLAINED_SHARE: f64 = 0.75;
/// Smallest standard deviation of a depth camera's range \[m\]: cells have corners. Source: ours.
const MIN_RANGE_SIGMA_M: f64 = 0.01;

impl GlobalLocalization {
    /// A localization without a search.
    pub(crate) fn new(config: &RobotConfig, blind_range: f64) -> Result<Self, Invalid> {
        let mut map = config.mapping.clone();
        map.blind_range = blind_range;
        let mut laser = ParticleConfig::default();
        laser.map = map;
        laser.wait_gate = MAX_STANDING_GAP_S;
        let config = match config.sight {
            RangeSource::Laser => laser,
            RangeSource::DepthCamera => {
                let range_noise_growth = config.scan.noise_growth;
                let range_noise = config.scan.noise_base.max(MIN_RANGE_SIGMA_M);
                let mut config = laser;
                config.range_noise = range_noise;
                config.range_noise_growth = range_noise_growth;
                config
            }
        };
        Ok(Self { config: config.validated()?, searches: 0, search: Search::None })
    }

    /// Whether a search runs.
    pub(crate) fn is_sought(&self) -> bool {
        !matches!(self.search, Search::None)
    }

    /// Begins a search in a map.
    pub(crate) fn search_pose(&mut self, grid: OccupancyGrid) {
        self.search = Search::Prepared(grid);
    }

    /// Ends the search, when the pose is known.
    pub(crate) fn end(&mut self) {
        self.search = Search::None;
    }

    /// Adds a scan; returns the pose once certain. `in_the_dark` states that images have too few features for place recognition. Cost until
    /// a pose is found: linear in the map's area, for each scan 10 deg or 0.3 m after the previous one.
    pub(crate) fn on_scan(
        &mut self,
        odom_from_base: Pose2,
        scan: &Scan,
        in_the_dark: bool,
    ) -> Option<LocalizedPose> {
        self.get_ready();
        let confirmed = if in_the_dark { MIN_CONFIRMING_SCANS } else { MIN_CONFIRMING_SCANS_SEEN };
        let Search::UnderWay { localizer, explained: times } = &mut self.search else { return None };
        match localizer.update(odom_from_base, scan) {
            Localized::Known { map_from_base, covariance, explained, degenerate } => {
                let fits = explained >= MIN_EXPLAINED_SHARE;
                // A scan of a single wall is no evidence for or against the pose.
                *times = if fits { *times + usize::from(degenerate == 0) } else { 0 };
                let place = || LocalizedPose {
                    stamp: scan.stamp(),
                    map_from_base,
                    covariance: seen_from(map_from_base, covariance),
                };
                (fits && *times > confirmed).then(place)
            }
            Localized::Lost(_) | Localized::Refused(_) => {
                *times = 0;
                None
            }
            Localized::Still => None,
        }
    }

    /// Prepares a map for the search.
    fn get_ready(&mut self) {
        let Search::Prepared(grid) = &self.search else { return };
        self.searches += 1;
        let localizer = MapLocalizer::from_grid(grid, self.config.clone(), self.searches);
        self.search = match localizer {
            Ok(localizer) => Search::UnderWay { localizer: Box::new(localizer), explained: 0 },
            Err(_) => Search::Hopeless,
        };
    }
}

/// A covariance in the map's axes, rotated into the axes of the pose.
fn seen_from(pose: Pose2, covariance: Matrix3<f64>) -> Matrix3<f64> {
    let (sin, cos) = pose.theta.sin_cos();
    let turn = Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0);
    turn * covariance * turn.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Beam, Cell, CellIndex, GridGeometry, Vector2};

    /// A room of `width` x `height` cells of 5 cm, with boxes (first and last column, first and last row); its corner at the origin.
    fn room(width: usize, height: usize, boxes: &[[usize; 4]]) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), width, height).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        for (col, row) in (0..width).flat_map(|col| (0..height).map(move |row| (col, row))) {
            let is_wall = col == 0 || row == 0 || col == width - 1 || row == height - 1;
            let is_in = |b: &[usize; 4]| (b[0]..=b[1]).contains(&col) && (b[2]..=b[3]).contains(&row);
            if is_wall || boxes.iter().any(is_in) {
                grid.set(CellIndex { col, row }, Cell::Occupied);
            }
        }
        grid
    }

    /// Scan of a depth camera in a room from a pose.
    fn scan(grid: &OccupancyGrid, at: Pose2, stamp: Stamp) -> Scan {
        let beam = |i: i32| {
            let bearing = at.theta + f64::from(i).to_radians();
            let along = |steps: u32| f64::from(steps) * 0.01;
            let is_there = |range: f64| {
                grid.at(at.position() + Vector2::new(bearing.cos(), bearing.sin()) * range) == Cell::Occupied
            };
            let range = (0..500).map(along).find(|range| is_there(*range));
            range.map_or(Beam::Free { range: 5.0 }, |range| Beam::Hit { range })
        };
        let (first, step) = ((-35_f64).to_radians(), 1_f64.to_radians());
        Scan::new(stamp, Vector2::zeros(), first, step, (-35..=35).map(beam).collect()).unwrap()
    }

    /// The pose in `map` found by the scans of `truth`, for a robot that turns three times at `at`, and the number of scans.
    fn found(
        map: &OccupancyGrid,
        truth: &OccupancyGrid,
        (at, in_the_dark): (Pose2, bool),
    ) -> Option<(Pose2, usize)> {
        let mut global_localization = GlobalLocalization::new(&RobotConfig::default(), 0.5).unwrap();
        assert!(
            global_localization.on_scan(at, &scan(truth, at, Stamp::default()), true).is_none(),
            "nothing is looked for"
        );
        global_localization.search_pose(map.clone());
        (0..108).find_map(|i: u32| {
            let turned = Pose2::new(0.0, 0.0, 0.175 * f64::from(i));
            let seen = scan(truth, at * turned, Stamp::from_nanos(i64::from(i) * 300_000_000));
            let place = global_localization.on_scan(turned, &seen, in_the_dark)?;
            assert!(place.covariance.symmetric_eigenvalues().min() > 0.0);
            Some((place.map_from_base * turned.inverse(), i as usize))
        })
    }

    #[test]
    fn a_robot_that_turns_on_the_spot_finds_its_place() {
        let map = room(90, 60, &[[60, 75, 1, 20], [1, 12, 40, 58]]);
        for at in [Pose2::new(1.5, 1.0, 0.3), Pose2::new(2.5, 2.2, -2.0), Pose2::new(3.9, 1.8, 1.5)] {
            let (place, scans) = found(&map, &map, (at, true)).unwrap();
            let (_, in_the_light) = found(&map, &map, (at, false)).unwrap();
            assert!(
                scans >= MIN_CONFIRMING_SCANS
                    && in_the_light >= scans + MIN_CONFIRMING_SCANS_SEEN - MIN_CONFIRMING_SCANS,
                "{scans}"
            );
            let off = at.inverse() * place;
            assert!(off.position().norm() < 0.05 && off.theta.abs() < 0.02, "{place:?} for {at:?}");
        }
    }

    #[test]
    fn of_two_look_alike_places_neither_is_accepted() {
        let square = room(60, 60, &[]);
        assert_eq!(found(&square, &square, (Pose2::new(1.2, 0.9, 0.4), true)), None);
    }

    #[test]
    fn in_a_room_that_is_not_on_the_map_it_is_nowhere() {
        let (map, other) =
            (room(90, 60, &[[60, 75, 1, 20], [1, 12, 40, 58]]), room(50, 110, &[[1, 20, 50, 55]]));
        assert_eq!(found(&map, &other, (Pose2::new(1.2, 1.5, 0.4), true)), None);
        let unknown = OccupancyGrid::filled(*map.geometry(), Cell::Unknown);
        assert_eq!(found(&unknown, &map, (Pose2::new(1.5, 1.0, 0.3), true)), None);
    }

    #[test]
    fn a_robot_that_stands_is_not_surer_for_it() {
        let map = room(90, 60, &[[60, 75, 1, 20], [1, 12, 40, 58]]);
        let at = Pose2::new(1.5, 1.0, 0.3);
        let mut global_localization = GlobalLocalization::new(&RobotConfig::default(), 0.5).unwrap();
        global_localization.search_pose(map.clone());
        for i in 0..40 {
            let seen = scan(&map, at, Stamp::from_nanos(i * 3_000_000_000));
            assert_eq!(global_localization.on_scan(Pose2::IDENTITY, &seen, true), None);
        }
    }

    #[test]
    fn a_covariance_is_turned_into_the_robots_directions() {
        let along_y = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 4.0, 0.1));
        let facing = Pose2::new(3.0, 1.0, std::f64::consts::FRAC_PI_6);
        let own = seen_from(facing, along_y);
        // The largest variance of the pose is lateral, with a positive correlation.
        assert!((own[(0, 0)] - 1.75).abs() < 1e-12 && (own[(1, 1)] - 3.25).abs() < 1e-12);
        assert!((own[(0, 1)] - 3.0 * 0.75_f64.sqrt() / 2.0).abs() < 1e-12 && own[(2, 2)] == 0.1);
    }
}
