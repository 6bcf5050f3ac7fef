//! Appearance of surfaces: procedural paints, baked once a face into mip-mapped textures.
//!
//! Every face has a separate painting, derived from (world seed, solid, face). All places therefore differ, and the result does not depend
//! on the order or the number of threads. A finish with a seed replaces the solid's number, which allows equal places. Colour is a pure
//! function of metres on the face.

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
