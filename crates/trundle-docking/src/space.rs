use crate::geometry::{Arc, Hull, InTheWay, Segment};
use crate::scene::{Blocker, Scene};
use std::f64::consts::TAU;
use trundle_core::{Footprint, Pose2, Vector2};

/// Motions stop this much before a contact, m or rad, so that the next one begins where nothing touches.
pub const BACK_OFF: f64 = 1e-5;
/// What sums of headings and ways may be off by; far less than what motions back off by.
const ROUNDING: f64 = 1e-9;

/// How far a robot may turn on the spot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeTurn {
    /// Counter-clockwise until the first contact, rad; infinite when nothing is ever met.
    pub left: f64,
    /// Clockwise until the first contact, rad.
    pub right: f64,
    /// What stops it counter-clockwise.
    pub left_by: Option<Blocker>,
    /// What stops it clockwise.
    pub right_by: Option<Blocker>,
}

impl FreeTurn {
    /// The turn that takes the heading by `angle` (in (-pi, pi], rad): the shorter way where it is free, or the longer.
    pub fn way(&self, angle: f64) -> Option<f64> {
        let (with, against) = if angle >= 0.0 { (self.left, self.right) } else { (self.right, self.left) };
        if angle.abs() <= with + ROUNDING {
            return Some(angle);
        }
        let longer = TAU - angle.abs();
        (longer <= against + ROUNDING).then(|| -longer.copysign(angle))
    }
}

/// How far a robot may drive straight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeDrive {
    /// Forward until the first contact, m, at most what was asked for.
    pub ahead: f64,
    /// Backward until the first contact, m.
    pub behind: f64,
    /// What stops it ahead.
    pub ahead_by: Option<Blocker>,
    /// What stops it behind.
    pub behind_by: Option<Blocker>,
}

impl FreeDrive {
    /// Whether a straight move of `way` (m, backward negative) is free.
    pub fn allows(&self, way: f64) -> bool {
        way <= self.ahead + ROUNDING && -way <= self.behind + ROUNDING
    }
}

/// A hull among obstacles: every question about contact, answered in closed form.
#[derive(Debug, Clone)]
pub struct Space<'a> {
    scene: &'a Scene,
    hull: Hull,
    angles: Vec<f64>,
    arcs: Vec<Arc>,
}

impl<'a> Space<'a> {
    /// A footprint grown by `margin` (m, at least 0.1 mm) among obstacles.
    pub fn new(footprint: &Footprint, margin: f64, scene: &'a Scene) -> Self {
        Self::of_hull(Hull::new(footprint, margin), scene)
    }

    pub(crate) fn of_hull(hull: Hull, scene: &'a Scene) -> Self {
        Self { scene, hull, angles: Vec::new(), arcs: Vec::new() }
    }

    /// The footprint with its margin.
    pub fn hull(&self) -> &Hull {
        &self.hull
    }

    /// What stands around.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// What the hull overlaps at a pose, if anything.
    pub fn contact(&self, pose: &Pose2) -> Option<Blocker> {
        self.scene.clearance_of(&self.hull, pose, 1e-12).map(|(_, blocker)| blocker)
    }

    /// How far the base may turn on the spot each way.
    pub fn turn(&mut self, pose: &Pose2) -> FreeTurn {
        let mut free = FreeTurn { left: f64::INFINITY, right: f64::INFINITY, left_by: None, right_by: None };
        let (hull, angles, arcs) = (&self.hull, &mut self.angles, &mut self.arcs);
        let center = pose.position();
        self.scene.visit(center, hull.outer_radius(), |segment, number| {
            arcs.clear();
            let relative = segment.seen_from(center, 1.0, 0.0);
            hull.blocked_headings(&relative, angles, arcs);
            for arc in arcs.iter() {
                let (left, right) = arc.room_from(pose.theta);
                let blocker = || Some(Blocker { obstacle: number as usize, at: segment.nearest(center) });
                if left < free.left {
                    (free.left, free.left_by) = (left, blocker());
                }
                if right < free.right {
                    (free.right, free.right_by) = (right, blocker());
                }
            }
        });
        free.left = (free.left - BACK_OFF).max(0.0);
        free.right = (free.right - BACK_OFF).max(0.0);
        free
    }

    /// How far the base may drive straight each way, looking `reach` (m) far.
    pub fn drive(&self, pose: &Pose2, reach: f64) -> FreeDrive {
        let mut free = FreeDrive { ahead: reach, behind: reach, ahead_by: None, behind_by: None };
        let (direction, outer) = (pose.direction(), self.hull.outer_radius());
        let center = pose.position();
        let half = Vector2::new(direction.x.abs(), direction.y.abs()) * reach + Vector2::repeat(outer);
        self.scene.visit_box(center, half, |segment, number| {
            let seen = segment.seen_from(center, direction.x, direction.y);
            if seen.a.y.min(seen.b.y) > outer || seen.a.y.max(seen.b.y) < -outer {
                return;
            }
            let blocker = || Some(Blocker { obstacle: number as usize, at: segment.nearest(center) });
            match self.hull.stop_by(&seen) {
                Some(InTheWay::Ahead(way)) if way < free.ahead => {
                    (free.ahead, free.ahead_by) = (way, blocker())
                }
                Some(InTheWay::Behind(way)) if way < free.behind => {
                    (free.behind, free.behind_by) = (way, blocker())
                }
                _ => {}
            }
        });
        free.ahead = (free.ahead - BACK_OFF).max(0.0);
        free.behind = (free.behind - BACK_OFF).max(0.0);
        free
    }

    /// Adds all headings at which a base at `position` overlaps something, sorted and joined.
    pub fn blocked_headings(&mut self, position: Vector2, blocked: &mut Vec<Arc>) {
        let (hull, angles) = (&self.hull, &mut self.angles);
        let first = blocked.len();
        self.scene.visit(position, hull.outer_radius(), |segment: &Segment, _| {
            hull.blocked_headings(&segment.seen_from(position, 1.0, 0.0), angles, blocked);
        });
        join(blocked, first);
    }
}

/// Sorts arcs from `first` on and joins those that meet; an arc may reach over 2 pi.
fn join(arcs: &mut Vec<Arc>, first: usize) {
    arcs[first..].sort_unstable_by(|a, b| a.start.total_cmp(&b.start));
    let mut kept = first;
    for i in first..arcs.len() {
        let arc = arcs[i];
        if kept > first && arc.start <= arcs[kept - 1].start + arcs[kept - 1].length {
            let last = &mut arcs[kept - 1];
            last.length = last.length.max(arc.start + arc.length - last.start);
        } else {
            arcs[kept] = arc;
            kept += 1;
        }
    }
    arcs.truncate(kept);
    // The last may reach over the first.
    while arcs.len() > first + 1 {
        let last = arcs[arcs.len() - 1];
        let over = last.start + last.length - TAU;
        if over < arcs[first].start {
            break;
        }
        let reach = (arcs[first].start + arcs[first].length).max(over);
        arcs.remove(first);
        let end = arcs.len() - 1;
        arcs[end].length = (reach + TAU - last.start).min(TAU);
    }
    if arcs[first..].iter().any(|arc| arc.length >= TAU - 1e-12) {
        arcs.truncate(first);
        arcs.push(Arc::FULL);
    }
}
