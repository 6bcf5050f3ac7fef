//! Exact contact of a robot's footprint with points, segments and cells.
//!
//! - [`RoundedHull`]: a footprint with a margin. Overlap and distance of a segment, signed distance of a point.
//! - [`blocked_headings`]: the headings at which a turn in place meets a segment. [`straight_contact`]: the free distance of a
//!   straight move. [`arc_contact`]: the free distance along an arc until the hull meets a point.
//! - [`HullProfile`]: a lookup table of a hull. It gives lower bounds of the free motion for boxes of points ([`OrientedBox`]), which skip
//!   most of a point cloud.
//! - [`square`] and [`convex_polygon`]: distances of points, segments and convex polygons from the cells of a grid.
//!
//! ```
//! use trundle_collision::{RoundedHull, Segment, StraightContact, arc_contact, straight_contact};
//! use trundle_core::{Footprint, Twist2, Vector2};
//!
//! let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| Vector2::new(x, y));
//! let footprint = Footprint::polygon(corners.to_vec())?;
//! let hull = RoundedHull::new(&footprint, 0.01);
//! let wall = Segment { a: Vector2::new(1.0, -1.0), b: Vector2::new(1.0, 1.0) };
//! assert!((hull.distance(&wall) - 0.69).abs() < 1e-9);
//! let Some(StraightContact::Ahead(free)) = straight_contact(&hull, &wall) else { panic!("the wall is ahead") };
//! assert!((free - 0.69).abs() < 1e-9);
//!
//! let distance = arc_contact(&RoundedHull::exact(&footprint), Twist2::new(0.3, 0.0), Vector2::new(1.0, 0.0), 0.01);
//! assert!((distance.unwrap() - 0.69).abs() < 1e-9);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod arc_contact;
pub mod convex_polygon;
mod hull_profile;
mod oriented_box;
mod rounded_hull;
mod segment;
pub mod square;
mod straight_contact;
mod turn_contact;

pub use arc_contact::arc_contact;
pub use hull_profile::{HullProfile, wrap_positive};
pub use oriented_box::OrientedBox;
pub use rounded_hull::{CONTACT_TOLERANCE_M, MIN_CORNER_RADIUS_M, RoundedHull};
pub use segment::Segment;
pub use straight_contact::{StraightContact, straight_contact};
pub use turn_contact::{HeadingArc, blocked_headings};
