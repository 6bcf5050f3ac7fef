//! A room of walls in the plane, seen by a perfect laser: for maps and matches whose truth is known.

use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};

/// Straight walls, world frame, m.
#[derive(Debug, Clone)]
pub struct FlatRoom {
    walls: Vec<(Vector2, Vector2)>,
}

impl FlatRoom {
    /// Closed outlines, each a list of corners.
    pub fn new(outlines: &[&[(f64, f64)]]) -> Self {
        let corner = |&(x, y): &(f64, f64)| Vector2::new(x, y);
        let walls = outlines.iter().flat_map(|outline| {
            let next = outline.iter().cycle().skip(1);
            outline.iter().zip(next).map(|(a, b)| (corner(a), corner(b))).collect::<Vec<_>>()
        });
        Self { walls: walls.collect() }
    }

    /// 6 x 4 m with a pillar and a box.
    pub fn furnished() -> Self {
        Self::new(&[
            &[(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)],
            &[(1.0, 0.6), (1.4, 0.6), (1.4, 1.0), (1.0, 1.0)],
            &[(-2.0, -0.6), (-1.2, -0.6), (-1.2, -0.2), (-2.0, -0.2)],
        ])
    }

    /// Two parallel walls 1.5 m apart, 40 m long, without other objects.
    pub fn corridor() -> Self {
        Self {
            walls: vec![
                (Vector2::new(-20.0, 0.75), Vector2::new(20.0, 0.75)),
                (Vector2::new(-20.0, -0.75), Vector2::new(20.0, -0.75)),
            ],
        }
    }

    /// Distance to the nearest wall from `from` along `angle`, m.
    pub fn cast(&self, from: Vector2, angle: f64) -> Option<f64> {
        let direction = Vector2::new(angle.cos(), angle.sin());
        let hit = |&(a, b): &(Vector2, Vector2)| {
            let (along, to) = (b - a, a - from);
            let determinant = direction.perp(&along);
            let (range, fraction) = (to.perp(&along) / determinant, to.perp(&direction) / determinant);
            (range > 0.0 && (0.0..=1.0).contains(&fraction)).then_some(range)
        };
        self.walls.iter().filter_map(hit).min_by(f64::total_cmp)
    }

    /// A scan of `beams` beams over `field_of_view` rad about the heading, each range off by `noise(beam)` m.
    pub fn scan(
        &self,
        world_from_base: Pose2,
        field_of_view: f64,
        beams: usize,
        max_range: f64,
        noise: impl Fn(usize) -> f64,
    ) -> Scan {
        let (min, step) = (-field_of_view / 2.0, field_of_view / beams as f64);
        let beam = |i: usize| match self
            .cast(world_from_base.position(), world_from_base.theta + min + i as f64 * step)
        {
            Some(range) if range <= max_range => Beam::Hit { range: (range + noise(i)).max(0.0) },
            _ => Beam::Free { range: max_range },
        };
        Scan::new(Stamp::default(), Vector2::zeros(), min, step, (0..beams).map(beam).collect()).unwrap()
    }
}
