//! How things look: procedural paints, baked once a face into mip-mapped textures.
//!
//! Every face gets a painting of its own, drawn from (world seed, solid, face), so that no two places look alike and the
//! result does not depend on the order or the number of threads; where a finish brings a seed, from that, so that places
//! can look alike. Colour is a pure function of metres on the face.

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
