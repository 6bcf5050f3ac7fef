//! A solid of a world: a shape with paints.

use crate::materials::Finish;
use crate::world::shape::Shape;

/// A shape and how its faces look.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Where it is.
    pub shape: Shape,
    /// What is painted on it.
    pub finish: Finish,
}
