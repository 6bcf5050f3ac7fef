//! TCP connections of trundle's servers: the live page and the server for Foxglove.
//!
//! [`ServerThread::start`] runs a server on a thread of its own, and [`Listener::serve`] accepts its connections. A connection is *silent*
//! until [`Ticket::heard`] reports its first whole request, and *heard* until it ends or [`Ticket::leave`] reports that a list of viewers
//! counts it. Both kinds are limited. Beyond a limit the oldest connection of the peer with the most connections is closed, so the peer that
//! opens many connections closes its own. A connection that stays silent is closed after [`SILENT_TIMEOUT`].
//!
//! | part | purpose |
//! |---|---|
//! | `fair_queue` | which connection is closed beyond a limit |
//! | `pools` | the silent and the heard connections |
//! | `ticket` | what a connection reports, and its end |
//! | `listener`, `accept_failures` | accepts connections, also after a lack of file descriptors |
//! | `end_notice`, `server_thread` | the end of a server: its viewers are informed, and its thread is waited for a bounded time |
//!
//! ```
//! use std::net::TcpListener;
//! use trundle_server::{EndNotice, ServerThread};
//!
//! let listener = TcpListener::bind("127.0.0.1:0")?;
//! let thread = ServerThread::start("echo", listener, async |listener| {
//!     listener.serve(&EndNotice::default(), async |stream, ticket| drop((stream, ticket))).await;
//! })?;
//! drop(thread); // ends the server
//! # Ok::<(), std::io::Error>(())
//! ```

mod accept_failures;
mod end_notice;
mod fair_queue;
mod listener;
mod pools;
mod server_thread;
mod ticket;

pub use end_notice::{EndNotice, EndReader};
pub use listener::Listener;
pub use server_thread::ServerThread;
pub use ticket::{SILENT_TIMEOUT, Ticket};
