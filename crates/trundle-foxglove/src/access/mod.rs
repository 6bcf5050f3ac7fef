//! Who may connect: a bounded number of viewers, and no foreign page.

mod connections;
mod guard;
mod page_origin;

pub use connections::{Service, serve};
pub use guard::Guard;
pub use page_origin::PageOrigin;
