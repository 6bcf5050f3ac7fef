//! Who may connect: a bounded number of connections, and no foreign page.

mod connections;
mod guard;
mod page_origin;

pub use connections::serve;
pub use guard::Guard;
pub use page_origin::PageOrigin;
