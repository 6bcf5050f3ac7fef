//! Where exactly in an image something is that another image showed: a small patch of the one, warped as the other should show
//! it, is moved until it fits \[Baker04\], brightness and contrast left free.
//!
//! The idea: a corner is placed by the noise of the image it was found in, half a pixel and more; what is around it, laid on what was
//! around it before, is placed by all of its pixels, a tenth of a pixel and less. And it tells whether it is the same thing at all.
//! Cost: about 1 us a patch. See `docs/algorithms/alignment.md`.
//!
//! | \[Baker04\] | here | unit |
//! |---|---|---|
//! | T(x) | `Template::values`, zero mean | grey values |
//! | grad T | `Template::right`, `Template::down`, free of brightness and contrast | grey values a px |
//! | H | the inverse is `Template::inverse` | |
//! | p | where the sought patch shows it | px |

mod patch;
mod template;

pub use patch::ImagePatch;
pub use template::{PatchAlignment, Template};
