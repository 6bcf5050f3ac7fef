//! Construction of scenes: boxes, cylinders and seeded jitter.

use crate::materials::{Finish, Paint};
use crate::rng::hash;
use crate::world::{Cuboid, Cylinder, Shape, Solid};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Pose2, Vector3};

/// Colour of faces behind walls and under floors.
pub(super) const UNSEEN: Paint = Paint::Flat { color: [120, 118, 114] };

/// Height of rooms, m. Source: ours.
pub(super) const ROOM_HEIGHT: f64 = 2.5;

/// Thickness of walls, m. Source: ours.
pub(super) const WALL_THICKNESS_M: f64 = 0.1;

/// Sides of a box in the order of [`Finish::faces`].
#[derive(Debug, Clone, Copy)]
pub(super) enum Side {
    East = 0,
    West = 1,
    North = 2,
    South = 3,
    Top = 4,
    Bottom = 5,
}

/// Collects solids; draws jitter from one seed in the order of the calls.
#[derive(Debug)]
pub(super) struct Builder {
    pub(super) solids: Vec<Solid>,
    /// Colour of furniture in place of one drawn by chance.
    pub(super) tint: Option<[u8; 3]>,
    /// Height above the floor of the next placed object, m.
    pub(super) lift: f64,
    rng: ChaCha8Rng,
    /// Inside [`Builder::alike`]: seed of the paintings, and number of painted solids.
    look: Option<(u64, u64)>,
}

impl Builder {
    pub(super) fn new(seed: u64) -> Self {
        let rng = ChaCha8Rng::seed_from_u64(seed);
        Self { solids: Vec::new(), tint: None, lift: 0.0, rng, look: None }
    }

    /// Objects placed by `place`, drawn and painted from `seed` alone: every call gives equal objects, without effect on other objects.
    pub(super) fn alike(&mut self, seed: u64, place: impl FnOnce(&mut Self)) {
        let rng = std::mem::replace(&mut self.rng, ChaCha8Rng::seed_from_u64(seed));
        let look = self.look.replace((seed, 0));
        place(self);
        (self.rng, self.look) = (rng, look);
    }

    /// Draws an event of this probability.
    pub(super) fn happens(&mut self, probability: f64) -> bool {
        self.rng.random_bool(probability)
    }

    /// A number between `-reach` and `reach`.
    pub(super) fn jitter(&mut self, reach: f64) -> f64 {
        self.rng.random_range(-reach..=reach)
    }

    /// An element of a list, drawn at random.
    pub(super) fn choose<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.rng.random_range(0..list.len())]
    }

    /// `place` moved by up to `reach` m along x and y each and turned by up to `turn` rad.
    pub(super) fn jittered(&mut self, place: Pose2, reach: f64, turn: f64) -> Pose2 {
        let (dx, dy, dt) = (self.jitter(reach), self.jitter(reach), self.jitter(turn));
        Pose2::new(place.x + dx, place.y + dy, place.theta + dt)
    }

    /// A box with its middle at `offset` (x, y, m) from `place`, in the axes of `place`, from `bottom` up; `size` m.
    pub(super) fn block(
        &mut self,
        place: Pose2,
        offset: (f64, f64),
        bottom: f64,
        size: [f64; 3],
        finish: Finish,
    ) {
        let middle = place.transform(trundle_core::Vector2::new(offset.0, offset.1));
        let center = Vector3::new(middle.x, middle.y, self.lift + bottom + size[2] / 2.0);
        let cuboid = Cuboid { center, size: Vector3::from(size), yaw: place.theta };
        self.add(Shape::Cuboid(cuboid), finish);
    }

    /// An upright cylinder, `offset` (x, y, m) from `place`, in its axes, from `bottom` up.
    pub(super) fn pillar(
        &mut self,
        place: Pose2,
        offset: (f64, f64),
        bottom: f64,
        (radius, height): (f64, f64),
        paint: Paint,
    ) {
        let middle = place.transform(trundle_core::Vector2::new(offset.0, offset.1));
        let base = Vector3::new(middle.x, middle.y, self.lift + bottom);
        self.add(Shape::Cylinder(Cylinder { base, radius, height }), Finish::all(paint));
    }

    fn add(&mut self, shape: Shape, mut finish: Finish) {
        if let Some((seed, count)) = &mut self.look {
            finish.seed = finish.seed.or(Some(hash(*seed, *count)));
            *count += 1;
        }
        self.solids.push(Solid { shape, finish });
    }

    /// A slab between two corners (x, y, z, m), painted on its visible faces.
    pub(super) fn slab(&mut self, low: [f64; 3], high: [f64; 3], seen: &[(Side, Paint)]) {
        let mut finish = Finish::all(UNSEEN);
        for (side, paint) in seen {
            finish.faces[*side as usize] = *paint;
        }
        let size = [0, 1, 2].map(|k| high[k] - low[k]);
        let place = Pose2::new((low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, 0.0);
        self.block(place, (0.0, 0.0), low[2], size, finish);
    }

    /// Floor and ceiling over a rectangle (x0, y0, x1, y1, m).
    pub(super) fn floor_and_ceiling(&mut self, [x0, y0, x1, y1]: [f64; 4], floor: Paint) {
        self.slab([x0, y0, -0.05], [x1, y1, 0.0], &[(Side::Top, floor)]);
        self.slab([x0, y0, ROOM_HEIGHT], [x1, y1, ROOM_HEIGHT + 0.05], &[(Side::Bottom, Paint::Ceiling)]);
    }

    /// A wall over a rectangle (x0, y0, x1, y1, m), from the floor to the ceiling.
    pub(super) fn wall(&mut self, [x0, y0, x1, y1]: [f64; 4], seen: &[(Side, Paint)]) {
        self.slab([x0, y0, 0.0], [x1, y1, ROOM_HEIGHT], seen);
    }
}
