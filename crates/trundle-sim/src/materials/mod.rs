//! Appearance of surfaces: procedural paints, baked once a face into mip-mapped textures.
//!
//! Every face gets a painting of its own, drawn from (world seed, solid, face). No two places are then equal, and the
//! result does not depend on the order or the number of threads. A finish with a seed replaces the solid's, so that places
//! can be equal. Colour is a pure function of metres on the face.

mod bake;
mod color;
mod finish;
mod furnishings;
mod industry;
mod joinery;
mod kind;
mod noise;
mod paintings;
mod poster;
mod surfaces;
mod texture;

pub use finish::Finish;
pub use kind::Paint;
pub(crate) use paintings::Paintings;
pub(crate) use texture::Texture;
