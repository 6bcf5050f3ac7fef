//! Track of one object.

use crate::moving_obstacles::cell_history::{CELL_SIDE_M, CellHistory};
use crate::moving_obstacles::cluster::Cluster;
use crate::moving_obstacles::config::ObstacleTrackerConfig;
use crate::moving_obstacles::forecast::{FORECAST_HORIZON_S, MAX_PAUSE_S};
use trundle_core::Vector2;

/// An object observed in successive scans.
#[derive(Debug)]
pub(super) struct Track {
    /// Hits of the first observation.
    first: Vec<Vector2>,
    /// Middle at the first observation.
    from: Vector2,
    /// Hits of the last observation.
    pub(super) hits: Vec<Vector2>,
    /// Observations, oldest first, within the memory time.
    seen: Vec<Observation>,
    sightings: usize,
    pub(super) velocity: Vector2,
    /// Middle and radius of the hidden region that may contain the object.
    hidden: Option<(Vector2, f64)>,
    /// Time and velocity of the last walk.
    walk: Option<(f64, Vector2)>,
}

/// Time for which an object in the blind zone counts as present unless observed to leave, s. Source: ours.
pub(super) const MAX_HIDDEN_S: f64 = 10.0;
/// Time for which scans may miss a visible person, s. Source: ours.
const MAX_MISSED_S: f64 = 0.2;
/// Distance from the sensor below which a person does not fit, m. Source: ours.
const MIN_HIDDEN_RANGE_M: f64 = 0.35;
/// Distance from the sensor above which no blind zone is assumed, m. Source: ours.
const MAX_HIDDEN_RANGE_M: f64 = 0.8;
/// Largest speed at which a person is assumed to walk on, m/s: a brisk walk. Source: ours.
const MAX_WALKING_SPEED_M_S: f64 = 2.0;

/// Position and size of one observation.
#[derive(Debug, Clone, Copy)]
struct Observation {
    time: f64,
    at: Vector2,
    radius: f64,
}

impl Track {
    pub(super) fn new(time: f64, cluster: Cluster) -> Self {
        let seen = vec![Observation { time, at: cluster.middle, radius: cluster.radius }];
        let first = cluster.hits.clone();
        Self {
            first,
            from: cluster.middle,
            hits: cluster.hits,
            seen,
            sightings: 1,
            velocity: Vector2::zeros(),
            hidden: None,
            walk: None,
        }
    }

    /// Position, velocity and radius at a time.
    pub(super) fn state_at(&self, time: f64, config: &ObstacleTrackerConfig) -> (Vector2, Vector2, f64) {
        match self.hidden {
            Some((at, radius)) => (at, Vector2::zeros(), radius),
            None => (self.expected(time), self.velocity, self.radius(config)),
        }
    }

    /// Whether the track continues at `time`. A track continues if it was just observed, or if it moved or stopped in the present blind
    /// range without a sighting outside. A track that arrived in the blind range continues as well: its motion there is not observable.
    pub(super) fn is_kept(
        &mut self,
        time: f64,
        sensor: Vector2,
        cells: &CellHistory,
        config: &ObstacleTrackerConfig,
    ) -> bool {
        let unseen = time - self.last_seen();
        if self.moves(cells, config) {
            self.walk = self.walking_velocity(config).or(self.walk);
        }
        let may_hide = (MAX_MISSED_S..MAX_HIDDEN_S).contains(&unseen) && self.sightings >= config.sightings;
        self.hidden = may_hide.then(|| self.hidden_region(sensor, cells, config)).flatten();
        !self.is_lost(time, config) || self.hidden.is_some() || self.is_waiting(time, cells)
    }

    /// Whether the object walked recently, stopped, and was not observed to leave: half of its hits were not observed free since then.
    fn is_waiting(&self, time: f64, cells: &CellHistory) -> bool {
        let left = self.hits.iter().filter(|hit| cells.is_free_since(**hit, self.last_seen())).count();
        self.walked(time).is_some_and(|velocity| self.has_stopped(velocity)) && 2 * left <= self.hits.len()
    }

    /// Velocity of the last walk, if recent.
    fn walked(&self, time: f64) -> Option<Vector2> {
        self.walk.filter(|(last, _)| time - last < MAX_PAUSE_S).map(|(_, velocity)| velocity)
    }

    /// Whether the object has stopped or is stopping: a velocity over one second lags behind.
    fn has_stopped(&self, walk: Vector2) -> bool {
        2.0 * self.velocity.norm() < walk.norm()
    }

    /// Time and velocity of the walk: the recent speed, unless it slows down, which the velocity follows late. The velocity must
    /// cover half a window at least: two successive positions measure it poorly.
    fn walking_velocity(&self, config: &ObstacleTrackerConfig) -> Option<(f64, Vector2)> {
        let last = self.last_seen();
        let seen = last - self.recent(config.window)[0].time;
        let speed = self.velocity.norm();
        let before = self.walk.filter(|(time, _)| last - time <= 2.0 * config.window).map(|(_, v)| v);
        let slows = before.is_some_and(|before| speed < before.norm());
        if 2.0 * seen < config.window || before.is_some_and(|before| self.has_stopped(before)) {
            return None;
        }
        let walk = if slows { self.velocity / speed * before?.norm() } else { self.velocity };
        Some((last, walk * (MAX_WALKING_SPEED_M_S / walk.norm()).min(1.0)))
    }

    /// The possible path of a person who walked recently and stopped: overlapping discs (middle, zero velocity, radius). The path ends at a
    /// wall and at the sensor.
    pub(super) fn possible_path<'a>(
        &'a self,
        time: f64,
        sensor: Vector2,
        cells: &'a CellHistory,
        config: &ObstacleTrackerConfig,
    ) -> impl Iterator<Item = (Vector2, Vector2, f64)> + 'a {
        let walk = self.walked(time).filter(|walk| self.is_hidden() || self.has_stopped(*walk));
        let (at, radius) = (self.last().at, self.radius(config));
        walk.into_iter().flat_map(move |velocity| {
            let offset = velocity * FORECAST_HORIZON_S;
            let steps = (offset.norm() / CELL_SIDE_M).ceil().max(1.0) as usize;
            let between = ((radius / CELL_SIDE_M) as usize).max(1);
            let is_open =
                move |middle: &Vector2| (middle - sensor).norm() > radius && !cells.is_wall(*middle);
            let middles = (1..=steps).map(move |k| at + offset * (k as f64 / steps as f64));
            let discs = middles.take_while(is_open).skip(between - 1).step_by(between);
            discs.map(move |middle| (middle, Vector2::zeros(), radius))
        })
    }

    /// The part of the expected path near the sensor that was not observed free since then, as a disc.
    fn hidden_region(
        &self,
        sensor: Vector2,
        cells: &CellHistory,
        config: &ObstacleTrackerConfig,
    ) -> Option<(Vector2, f64)> {
        let last = self.last();
        let radius = self.radius(config);
        let offset = if self.moves(cells, config) {
            self.velocity * config.window
        } else if 2 * self.hits.iter().filter(|hit| cells.is_hit_since(**hit, last.time)).count()
            > self.hits.len()
        {
            // The object is visible and was present before: more than its edge is hit.
            return None;
        } else {
            Vector2::zeros()
        };
        let steps = (offset.norm() / CELL_SIDE_M).ceil().min(100.0) as usize;
        let on = (0..=steps).map(|i| last.at + offset * (i as f64 / steps.max(1) as f64));
        let is_unseen = |at: &Vector2| {
            let range = (at - sensor).norm();
            let has_room = range >= MIN_HIDDEN_RANGE_M || *at == last.at;
            has_room && range <= MAX_HIDDEN_RANGE_M && !cells.is_free_since(*at, last.time)
        };
        let mut unseen = on.filter(is_unseen);
        let first = unseen.next()?;
        let end = unseen.next_back().unwrap_or(first);
        Some(((first + end) * 0.5, radius + (end - first).norm() / 2.0))
    }

    /// Distance of a cluster's middle from the expected position, m; for a hidden track, from its disc.
    pub(super) fn gap(&self, time: f64, middle: Vector2, config: &ObstacleTrackerConfig) -> f64 {
        match self.hidden {
            Some((at, radius)) => ((middle - at).norm() - radius).max(0.0),
            None if self.is_lost(time, config) => (self.last().at - middle).norm(),
            None => (self.expected(time) - middle).norm(),
        }
    }

    /// Whether the track had no observation for a window.
    pub(super) fn is_lost(&self, time: f64, config: &ObstacleTrackerConfig) -> bool {
        time - self.last_seen() > config.window
    }

    /// Expected position of the object's middle.
    pub(super) fn expected(&self, time: f64) -> Vector2 {
        let last = self.last();
        last.at + self.velocity * (time - last.time)
    }

    pub(super) fn last_seen(&self) -> f64 {
        self.last().time
    }

    fn last(&self) -> &Observation {
        &self.seen[self.seen.len() - 1]
    }

    pub(super) fn add(&mut self, time: f64, cluster: Cluster, config: &ObstacleTrackerConfig) {
        if self.is_lost(time, config) {
            // A new observation in the hidden region may be another object.
            (self.sightings, self.from, self.first) = (0, cluster.middle, cluster.hits.clone());
            self.seen.clear();
        }
        self.seen.push(Observation { time, at: cluster.middle, radius: cluster.radius });
        self.seen.retain(|sighting| time - sighting.time <= config.memory);
        self.sightings += 1;
        self.hidden = None;
        self.hits = cluster.hits;
        self.velocity = velocity(self.recent(config.window));
    }

    /// Largest recent radius.
    pub(super) fn radius(&self, config: &ObstacleTrackerConfig) -> f64 {
        self.recent(config.window).iter().map(|sighting| sighting.radius).fold(config.smallest, f64::max)
    }

    /// Discs that the object occupied within the memory time.
    pub(super) fn trail(&self, config: &ObstacleTrackerConfig) -> impl Iterator<Item = (Vector2, f64)> + '_ {
        let radius = self.radius(config);
        self.seen.iter().map(move |sighting| (sighting.at, radius))
    }

    /// Whether the object may be in the blind zone.
    pub(super) fn is_hidden(&self) -> bool {
        self.hidden.is_some()
    }

    /// Whether the object moves: its distance from the position of its first observation exceeds its radius. A static object shifts by less
    /// when further sides of the object come into view.
    pub(super) fn moves(&self, cells: &CellHistory, config: &ObstacleTrackerConfig) -> bool {
        let left = self.first.iter().filter(|hit| !cells.is_hit(**hit, self.last_seen())).count();
        self.sightings >= config.sightings
            && self.velocity.norm() >= config.min_speed
            && (self.last().at - self.from).norm() >= config.min_distance.max(self.radius(config))
            && 2 * left >= self.first.len()
    }

    fn recent(&self, window: f64) -> &[Observation] {
        let begin = self.seen.partition_point(|sighting| self.last_seen() - sighting.time > window);
        &self.seen[begin..]
    }
}

/// Slope of the line through positions over time, by least squares.
fn velocity(seen: &[Observation]) -> Vector2 {
    let count = seen.len() as f64;
    let mean_time = seen.iter().map(|sighting| sighting.time).sum::<f64>() / count;
    let spread: f64 = seen.iter().map(|sighting| (sighting.time - mean_time).powi(2)).sum();
    if spread <= 0.0 {
        return Vector2::zeros();
    }
    seen.iter().map(|sighting| sighting.at * (sighting.time - mean_time)).sum::<Vector2>() / spread
}
