//! Exact position in an image of a point that another image showed. A small patch of the other image is warped to this view and moved to
//! the best fit \[Baker04\]; brightness and contrast are free.
//!
//! Idea: the position of a detected corner has the noise of its image, half a pixel and more. The alignment of its surroundings with
//! earlier ones uses all their pixels: a tenth of a pixel and less. The alignment also verifies the identity of the corner. Cost: about 1
//! us a patch. See `docs/algorithms/alignment.md`.
//!
//! | \[Baker04\] | here | unit |
//! |---|---|---|
//! | T(x) | `Template::values`, zero mean | grey values |
//! | grad T | `Template::right`, `Template::down`, free of brightness and contrast | grey values per px |
//! | H | the inverse is `Template::inverse` | |
//! | p | position in the searched patch | px |

mod patch;
mod template;

pub use patch::ImagePatch;
pub use template::{PatchAlignment, Template};
