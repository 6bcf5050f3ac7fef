//! All people of a scene: motion, waiting and contact with the robot.

use super::body::{Body, Part};
use super::gait::{KNEE_SHARE, THIGH_SHARE};
use super::person::Person;
use super::walker::Walker;
use crate::world::{HeightBand, Mover, Obstacles};
use std::sync::Arc;
use trundle_core::{Footprint, Hypotenuse, Invalid, Pose2};

/// Disc in which a robot makes a person wait: distance of its middle ahead of the person, and radius, m. Source: ours.
const YIELD_DISTANCE_M: f64 = 0.5;
const ELBOW_ROOM: f64 = 0.3;

/// Smallest distance of a foot from the robot, m. Source: ours.
const KEEP_OFF: f64 = 0.03;

/// Radius around a person's middle that contains the whole person, m. Source: ours.
const MAX_PERSON_EXTENT_M: f64 = 0.85;

/// Radius of the space that a walking person needs, m. Source: ours.
const SHOULDER_RADIUS_M: f64 = 0.2;

/// All persons who walk.
#[derive(Debug)]
pub(crate) struct Crowd {
    people: Vec<Person>,
    walkers: Vec<Walker>,
    bodies: Arc<[Body]>,
}

/// All persons at one moment, for use in another thread.
#[derive(Debug, Clone)]
pub(crate) struct CrowdView {
    walkers: Vec<Walker>,
    bodies: Arc<[Body]>,
}

impl CrowdView {
    /// All persons' parts at that moment.
    pub(crate) fn movers(&self) -> Vec<Mover<'_>> {
        movers(&self.walkers, &self.bodies)
    }
}

impl Crowd {
    /// People at the start of their paths; `band` is the robot's height band.
    ///
    /// # Errors
    /// When a number of a person is outside its range; the error names the person.
    pub(crate) fn new(people: &[Person], band: HeightBand) -> Result<Self, Invalid> {
        let named =
            |i: usize| move |error: Invalid| Invalid { field: format!("{} {i}", error.field), ..error };
        let check = |(i, person): (usize, &Person)| person.clone().validated().map_err(named(i));
        let people = people.iter().enumerate().map(check).collect::<Result<Vec<_>, _>>()?;
        let walkers = people.iter().map(Walker::new).collect();
        let bodies = (0..people.len()).map(|i| Body::new(i, band)).collect::<Result<_, _>>()?;
        Ok(Self { people, walkers, bodies })
    }

    /// Refuses paths through fixed obstacles, checked every 5 cm.
    ///
    /// # Errors
    /// Names the person and the leg.
    pub(crate) fn check_ways(&self, fixed: &Obstacles) -> Result<(), Invalid> {
        let shoulders = Footprint::Disc { radius: SHOULDER_RADIUS_M };
        for (i, person) in self.people.iter().enumerate() {
            for (from, to) in person.legs() {
                let (a, b) = (person.waypoints[from], person.waypoints[to]);
                let length = (b[0] - a[0]).hypotenuse(b[1] - a[1]);
                let pieces = (length / 0.05).ceil().max(1.0);
                for k in 0..=pieces as usize {
                    let t = k as f64 / pieces;
                    let place = Pose2::new(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, 0.0);
                    if fixed.clearance(&shoulders, place) <= 0.0 {
                        let value = format!("through something at ({:.2}, {:.2})", place.x, place.y);
                        let field = format!("way of person {i} from way-point {from} to {to}");
                        return Err(Invalid::new(field, value, "m", "0.2 m of room on either side"));
                    }
                }
            }
        }
        Ok(())
    }

    /// Advances by `elapsed` s with the robot at `robot`.
    ///
    /// Advances all persons. A step that would bring a leg too near to the robot is not made.
    pub(crate) fn step(&mut self, elapsed: f64, footprint: &Footprint, robot: Pose2) {
        let reach = footprint.circumscribed_radius();
        for ((person, walker), body) in self.people.iter().zip(&mut self.walkers).zip(self.bodies.iter()) {
            if walker.pose.distance(&robot) > reach + MAX_PERSON_EXTENT_M + YIELD_DISTANCE_M {
                *walker = walker.after(person, elapsed, true);
                continue;
            }
            let to_robot = (walker.before(YIELD_DISTANCE_M) - robot.position()).norm();
            let next = walker.after(person, elapsed, to_robot > reach + ELBOW_ROOM);
            let room = clearance(body, &next, footprint, robot);
            if room > KEEP_OFF || room >= clearance(body, walker, footprint, robot) {
                *walker = next;
            }
        }
    }

    /// Distance between a footprint at `pose` and the nearest person, m; infinite if all are farther than [`MAX_PERSON_EXTENT_M`].
    pub(crate) fn clearance(&self, footprint: &Footprint, pose: Pose2) -> f64 {
        let reach = footprint.circumscribed_radius() + MAX_PERSON_EXTENT_M;
        let near =
            self.walkers.iter().zip(self.bodies.iter()).filter(|(w, _)| w.pose.distance(&pose) < reach);
        near.map(|(walker, body)| clearance(body, walker, footprint, pose)).fold(f64::INFINITY, f64::min)
    }

    /// Poses of all persons, `world_from_body`.
    pub(crate) fn poses(&self) -> Vec<Pose2> {
        self.walkers.iter().map(|walker| walker.pose).collect()
    }

    /// All persons' parts at present.
    pub(crate) fn movers(&self) -> Vec<Mover<'_>> {
        movers(&self.walkers, &self.bodies)
    }

    /// All persons at present.
    pub(crate) fn view(&self) -> CrowdView {
        CrowdView { walkers: self.walkers.clone(), bodies: Arc::clone(&self.bodies) }
    }

    /// Draws the textures of all persons.
    pub(crate) fn prepare_textures(&self) {
        self.bodies.iter().for_each(Body::prepare_textures);
    }
}

fn movers<'b>(walkers: &[Walker], bodies: &'b [Body]) -> Vec<Mover<'b>> {
    let parts = walkers.iter().zip(bodies).flat_map(|(walker, body)| parts(body, walker));
    parts.map(|(part, pose)| Mover { body: &part.world, pose }).collect()
}

/// The parts of a person and their poses, `world_from_part`.
fn parts<'b>(body: &'b Body, walker: &Walker) -> [(&'b Part, Pose2); 7] {
    let legs = |part, share| walker.gait.legs(share).map(|leg| (part, walker.pose * leg));
    let [left_shin, right_shin] = legs(&body.shin, 1.0);
    let [left_knee, right_knee] = legs(&body.knee, KNEE_SHARE);
    let [left_thigh, right_thigh] = legs(&body.thigh, THIGH_SHARE);
    [left_shin, right_shin, left_knee, right_knee, left_thigh, right_thigh, (&body.trunk, walker.pose)]
}

/// Metres between a person and the robot.
fn clearance(body: &Body, walker: &Walker, footprint: &Footprint, robot: Pose2) -> f64 {
    let gap = |(part, pose): (&Part, Pose2)| part.obstacles.clearance_at(pose, footprint, robot);
    parts(body, walker).into_iter().map(gap).fold(f64::INFINITY, f64::min)
}
