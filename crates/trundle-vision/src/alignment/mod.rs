//! Exact position in an image of a point that another image showed. A small patch of the other image is warped to this view and
//! moved until it fits \[Baker04\]; brightness and contrast are free.
//!
//! The idea: a corner is located with the noise of its image, half a pixel and more. Its surroundings, aligned with the earlier ones, are
//! located by all of their pixels, a tenth of a pixel and less. The alignment also shows whether it is the same corner.
//! Cost: about 1 us a patch. See `docs/algorithms/alignment.md`.
//!
//! | \[Baker04\] | here | unit |
//! |---|---|---|
//! | T(x) | `Template::values`, zero mean | grey values |
//! | grad T | `Template::right`, `Template::down`, free of brightness and contrast | grey values per px |
//! | H | the inverse is `Template::inverse` | |
//! | p | where the sought patch shows it | px |

mod patch;
mod template;

pub use patch::ImagePatch;
pub use template::{PatchAlignment, Template};
