//! The state of one walking person along the way-points.

use super::Person;
use super::gait::Gait;
use trundle_core::{Pose2, Vector2, difference_of_angles};

/// Turn rate of people on the spot, rad/s. Source: ours.
const TURN_RATE: f64 = 2.5;

/// Tolerance of position and heading at a way-point, m and rad. Source: ours.
const ARRIVAL_TOLERANCE: f64 = 1e-6;

/// A person on the path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walker {
    /// `world_from_body`.
    pub(super) pose: Pose2,
    pub(super) gait: Gait,
    /// Index of the next way-point.
    target: usize,
    /// Whether way-points are taken backward.
    is_returning: bool,
    /// Remaining time of the pause, s.
    rest: f64,
    is_done: bool,
}

impl Walker {
    /// Standing at the first way-point, facing the second.
    pub(super) fn new(person: &Person) -> Self {
        let first = point(person, 0);
        let direction = person.waypoints.get(1).map_or(Vector2::x(), |_| point(person, 1) - first);
        Self {
            pose: Pose2::new(first.x, first.y, direction.y.atan2(direction.x)),
            gait: Gait::new(person.speed),
            target: 1,
            is_returning: false,
            rest: person.delay,
            is_done: person.waypoints.len() < 2,
        }
    }

    /// The state after `elapsed` s; `is_free`: whether the space ahead of the person is free.
    pub(super) fn after(self, person: &Person, elapsed: f64, is_free: bool) -> Self {
        if self.is_done || self.rest > 0.0 {
            return Self { rest: (self.rest - elapsed).max(0.0), ..self.stand(elapsed) };
        }
        let direction = point(person, self.target) - self.pose.position();
        let distance = direction.norm();
        if distance < ARRIVAL_TOLERANCE {
            return self.arrive(person).stand(elapsed);
        }
        let turn = difference_of_angles(direction.y.atan2(direction.x), self.pose.theta);
        if turn.abs() > ARRIVAL_TOLERANCE {
            let max = TURN_RATE * elapsed;
            let Pose2 { x, y, theta } = self.pose;
            return Self { pose: Pose2::new(x, y, theta + turn.clamp(-max, max)), ..self.stand(elapsed) };
        }
        if is_free { self.walk(person, elapsed, distance) } else { self.stand(elapsed) }
    }

    /// The place `ahead` m before the body.
    pub(super) fn before(&self, ahead: f64) -> Vector2 {
        self.pose.position() + self.pose.direction() * ahead
    }

    /// Comes to rest.
    fn stand(self, elapsed: f64) -> Self {
        Self { gait: self.gait.after(elapsed, 0.0, false), ..self }
    }

    fn walk(self, person: &Person, elapsed: f64, distance: f64) -> Self {
        let direction = (person.speed * self.gait.swing() * elapsed).min(distance);
        let place = self.before(direction);
        let gait = self.gait.after(elapsed, direction, true);
        Self { pose: Pose2::new(place.x, place.y, self.pose.theta), gait, ..self }
    }

    fn arrive(mut self, person: &Person) -> Self {
        self.rest = person.pause;
        let last = person.waypoints.len() - 1;
        if self.target == last && person.once {
            self.is_done = true;
        } else if person.around {
            self.target = (self.target + 1) % (last + 1);
        } else {
            self.is_returning = if self.is_returning { self.target != 0 } else { self.target == last };
            self.target = if self.is_returning { self.target - 1 } else { self.target + 1 };
        }
        self
    }
}

fn point(person: &Person, i: usize) -> Vector2 {
    let [x, y] = person.waypoints[i];
    Vector2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visits(person: &Person, seconds: usize) -> Vec<usize> {
        let mut walker = Walker::new(person);
        let mut seen = vec![0];
        for _ in 0..seconds * 1000 {
            walker = walker.after(person, 1e-3, true);
            let at = |i: &usize| (point(person, *i) - walker.pose.position()).norm() < 1e-3;
            if let Some(i) = (0..person.waypoints.len()).find(at)
                && seen.last() != Some(&i)
            {
                seen.push(i);
            }
        }
        seen
    }

    #[test]
    fn ways_go_back_around_or_end() {
        let there = Person { waypoints: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], ..Person::default() };
        assert_eq!(visits(&there, 14)[..6], [0, 1, 2, 1, 0, 1]);
        let around = Person { around: true, ..there.clone() };
        assert_eq!(visits(&around, 14)[..6], [0, 1, 2, 0, 1, 2]);
        let once = Person { once: true, ..there };
        assert_eq!(visits(&once, 14), [0, 1, 2]);
    }

    #[test]
    fn time_is_way_over_speed_with_turns_pauses_and_a_soft_start() {
        let person = Person {
            waypoints: vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]],
            speed: 1.0,
            pause: 2.0,
            delay: 1.0,
            once: true,
            around: false,
        };
        let mut walker = Walker::new(&person);
        let mut seconds = 0.0;
        while !walker.is_done {
            let before = walker.pose;
            walker = walker.after(&person, 1e-3, true);
            assert!(before.distance(&walker.pose) <= 1e-3 + 1e-12);
            seconds += 1e-3;
        }
        // Delay 1, legs 3 + 1, pause 2, a quarter turn, and half an ease for each start.
        let expected = 1.0 + 4.0 + 2.0 + std::f64::consts::FRAC_PI_2 / TURN_RATE + 0.35;
        assert!((seconds - expected).abs() < 0.02, "{seconds} {expected}");
    }
}
