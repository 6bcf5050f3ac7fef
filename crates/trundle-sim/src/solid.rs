//! A solid of a world: a shape with paints.

use crate::materials::Finish;
use crate::world::shape::Shape;

/// A shape with the paint of its faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Shape and pose.
    pub shape: Shape,
    /// The paint.
    pub finish: Finish,
}
