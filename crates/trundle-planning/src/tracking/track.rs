use super::TrackerConfig;
use super::cluster::Cluster;
use super::seen::{SIDE, SeenCells};
use crate::movers::{HORIZON, MAY_GO_ON};
use trundle_core::Vector2;

/// Something that was seen again and again.
#[derive(Debug)]
pub(super) struct Track {
    /// Where it was hit when it was first seen.
    first: Vec<Vector2>,
    /// Where its middle was then.
    from: Vector2,
    /// Its hits now.
    pub(super) hits: Vec<Vector2>,
    /// When and where it was seen, oldest first, not longer ago than the memory.
    seen: Vec<Sighting>,
    sightings: usize,
    pub(super) velocity: Vector2,
    /// Where it may stand unseen: middle and radius.
    hidden: Option<(Vector2, f64)>,
    /// When it last walked, and how.
    walk: Option<(f64, Vector2)>,
}

/// A mover that was not seen to go is believed to stand where nothing can be seen for so long, s.
pub(super) const HIDES: f64 = 10.0;
/// So long a walker may be missed by scans that see it, s.
const BLINK: f64 = 0.2;
/// Nearer to the sensor than this nobody has room, m, and farther than this it is not blind, m.
const NEAR: (f64, f64) = (0.35, 0.8);

/// Faster than this nobody is believed to walk on, m/s: a brisk walk.
const FASTEST: f64 = 2.0;

/// Where something was, and how large it looked.
#[derive(Debug, Clone, Copy)]
struct Sighting {
    time: f64,
    at: Vector2,
    radius: f64,
}

impl Track {
    pub(super) fn new(time: f64, cluster: Cluster) -> Self {
        let seen = vec![Sighting { time, at: cluster.middle, radius: cluster.radius }];
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

    /// Where it is at a time, how it moves, and its radius.
    pub(super) fn mover(&self, time: f64, config: &TrackerConfig) -> (Vector2, Vector2, f64) {
        match self.hidden {
            Some((at, radius)) => (at, Vector2::zeros(), radius),
            None => (self.expected(time), self.velocity, self.radius(config)),
        }
    }

    /// Whether it is to be believed in at `time`: it was seen a moment ago, or it went, or stood, where the sensor is blind now, and was
    /// not seen to leave. Of what stands there it is enough that it came: nobody can see whether it goes on.
    pub(super) fn lasts(
        &mut self,
        time: f64,
        sensor: Vector2,
        cells: &SeenCells,
        config: &TrackerConfig,
    ) -> bool {
        let unseen = time - self.last_seen();
        if self.moves(cells, config) {
            self.walk = self.pace(config).or(self.walk);
        }
        let may_hide = (BLINK..HIDES).contains(&unseen) && self.sightings >= config.sightings;
        self.hidden = may_hide.then(|| self.hides(sensor, cells, config)).flatten();
        !self.is_lost(time, config) || self.hidden.is_some() || self.stands(time, cells)
    }

    /// Whether it walked not long ago, stopped, and has not been seen to leave: half of where it was hit has not been seen free since.
    fn stands(&self, time: f64, cells: &SeenCells) -> bool {
        let left = self.hits.iter().filter(|hit| cells.is_free_since(**hit, self.last_seen())).count();
        self.walked(time).is_some_and(|velocity| self.has_stopped(velocity)) && 2 * left <= self.hits.len()
    }

    /// How it walked, if that is not too long ago.
    fn walked(&self, time: f64) -> Option<Vector2> {
        self.walk.filter(|(last, _)| time - last < MAY_GO_ON).map(|(_, velocity)| velocity)
    }

    /// Whether it stopped, or is about to: a velocity over a second lags behind.
    fn has_stopped(&self, walk: Vector2) -> bool {
        2.0 * self.velocity.norm() < walk.norm()
    }

    /// When it was seen to walk, and how: as fast as lately, unless it stops, which the velocity follows late. Of a velocity over half a
    /// window at least: two places in a row say little.
    fn pace(&self, config: &TrackerConfig) -> Option<(f64, Vector2)> {
        let last = self.last_seen();
        let seen = last - self.recent(config.window)[0].time;
        let speed = self.velocity.norm();
        let before = self.walk.filter(|(time, _)| last - time <= 2.0 * config.window).map(|(_, v)| v);
        let slows = before.is_some_and(|before| speed < before.norm());
        if 2.0 * seen < config.window || before.is_some_and(|before| self.has_stopped(before)) {
            return None;
        }
        let walk = if slows { self.velocity / speed * before?.norm() } else { self.velocity };
        Some((last, walk * (FASTEST / walk.norm()).min(1.0)))
    }

    /// Of who walked not long ago and stopped: the way on that it may take any moment, as discs (middle, no velocity, radius) that overlap.
    /// It ends before a wall, and before the sensor, through which nobody walks.
    pub(super) fn way_on<'a>(
        &'a self,
        time: f64,
        sensor: Vector2,
        cells: &'a SeenCells,
        config: &TrackerConfig,
    ) -> impl Iterator<Item = (Vector2, Vector2, f64)> + 'a {
        let walk = self.walked(time).filter(|walk| self.is_hidden() || self.has_stopped(*walk));
        let (at, radius) = (self.last().at, self.radius(config));
        walk.into_iter().flat_map(move |velocity| {
            let way = velocity * HORIZON;
            let steps = (way.norm() / SIDE).ceil().max(1.0) as usize;
            let between = ((radius / SIDE) as usize).max(1);
            let is_open =
                move |middle: &Vector2| (middle - sensor).norm() > radius && !cells.is_wall(*middle);
            let middles = (1..=steps).map(move |k| at + way * (k as f64 / steps as f64));
            let discs = middles.take_while(is_open).skip(between - 1).step_by(between);
            discs.map(move |middle| (middle, Vector2::zeros(), radius))
        })
    }

    /// The part of its way on that is near the sensor and has not been seen free since, as a disc.
    fn hides(&self, sensor: Vector2, cells: &SeenCells, config: &TrackerConfig) -> Option<(Vector2, f64)> {
        let last = self.last();
        let radius = self.radius(config);
        let way = if self.moves(cells, config) {
            self.velocity * config.window
        } else if 2 * self.hits.iter().filter(|hit| cells.is_hit_since(**hit, last.time)).count()
            > self.hits.len()
        {
            // It is in sight, and was there before: more than an edge of it.
            return None;
        } else {
            Vector2::zeros()
        };
        let steps = (way.norm() / SIDE).ceil().min(100.0) as usize;
        let on = (0..=steps).map(|i| last.at + way * (i as f64 / steps.max(1) as f64));
        let is_unseen = |at: &Vector2| {
            let range = (at - sensor).norm();
            let has_room = range >= NEAR.0 || *at == last.at;
            has_room && range <= NEAR.1 && !cells.is_free_since(*at, last.time)
        };
        let mut unseen = on.filter(is_unseen);
        let first = unseen.next()?;
        let end = unseen.next_back().unwrap_or(first);
        Some(((first + end) * 0.5, radius + (end - first).norm() / 2.0))
    }

    /// How far from where it should be a cluster's middle is, m; of what is hidden, from the disc that it may stand in.
    pub(super) fn gap(&self, time: f64, middle: Vector2, config: &TrackerConfig) -> f64 {
        match self.hidden {
            Some((at, radius)) => ((middle - at).norm() - radius).max(0.0),
            None if self.is_lost(time, config) => (self.last().at - middle).norm(),
            None => (self.expected(time) - middle).norm(),
        }
    }

    /// Whether it lasts for where it stopped, unseen.
    pub(super) fn is_lost(&self, time: f64, config: &TrackerConfig) -> bool {
        time - self.last_seen() > config.window
    }

    /// Where its middle should be.
    pub(super) fn expected(&self, time: f64) -> Vector2 {
        let last = self.last();
        last.at + self.velocity * (time - last.time)
    }

    pub(super) fn last_seen(&self) -> f64 {
        self.last().time
    }

    fn last(&self) -> &Sighting {
        &self.seen[self.seen.len() - 1]
    }

    pub(super) fn add(&mut self, time: f64, cluster: Cluster, config: &TrackerConfig) {
        if self.is_lost(time, config) {
            // Who is seen there may be somebody else.
            (self.sightings, self.from, self.first) = (0, cluster.middle, cluster.hits.clone());
            self.seen.clear();
        }
        self.seen.push(Sighting { time, at: cluster.middle, radius: cluster.radius });
        self.seen.retain(|sighting| time - sighting.time <= config.memory);
        self.sightings += 1;
        self.hidden = None;
        self.hits = cluster.hits;
        self.velocity = velocity(self.recent(config.window));
    }

    /// The largest that it looked lately.
    pub(super) fn radius(&self, config: &TrackerConfig) -> f64 {
        self.recent(config.window).iter().map(|sighting| sighting.radius).fold(config.smallest, f64::max)
    }

    /// Discs that it has been in, within the memory.
    pub(super) fn trail(&self, config: &TrackerConfig) -> impl Iterator<Item = (Vector2, f64)> + '_ {
        let radius = self.radius(config);
        self.seen.iter().map(move |sighting| (sighting.at, radius))
    }

    /// Whether it may stand where nothing can be seen.
    pub(super) fn is_hidden(&self) -> bool {
        self.hidden.is_some()
    }

    /// Whether it moves: it has left where it was first seen. Of a thing that was put down, other sides come into view: less than
    /// its radius is no way.
    pub(super) fn moves(&self, cells: &SeenCells, config: &TrackerConfig) -> bool {
        let left = self.first.iter().filter(|hit| !cells.is_hit(**hit, self.last_seen())).count();
        self.sightings >= config.sightings
            && self.velocity.norm() >= config.least_speed
            && (self.last().at - self.from).norm() >= config.least_way.max(self.radius(config))
            && 2 * left >= self.first.len()
    }

    fn recent(&self, window: f64) -> &[Sighting] {
        let begin = self.seen.partition_point(|sighting| self.last_seen() - sighting.time > window);
        &self.seen[begin..]
    }
}

/// The slope of the straight line through places over time, by least squares.
fn velocity(seen: &[Sighting]) -> Vector2 {
    let count = seen.len() as f64;
    let mean_time = seen.iter().map(|sighting| sighting.time).sum::<f64>() / count;
    let spread: f64 = seen.iter().map(|sighting| (sighting.time - mean_time).powi(2)).sum();
    if spread <= 0.0 {
        return Vector2::zeros();
    }
    seen.iter().map(|sighting| sighting.at * (sighting.time - mean_time)).sum::<Vector2>() / spread
}
