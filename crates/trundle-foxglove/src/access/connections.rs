//! Connections of viewers: the checks of the request, then the views.

use super::guard::{Admitted, Guard};
use crate::viewer::{self, ShownRun};
use std::sync::Arc;
use tokio::net::TcpStream;
use trundle_server::{EndNotice, Listener, Ticket};

/// What all connections share.
pub struct Service {
    /// The checks of a request.
    pub guard: Guard,
    /// The run.
    pub run: ShownRun,
    /// Informs the viewers of the end of the run.
    pub end: EndNotice,
}

/// Serves until the end of the server.
pub async fn serve(listener: Listener, service: Arc<Service>) {
    let open = |stream, ticket| open_connection(stream, ticket, Arc::clone(&service));
    listener.serve(&service.end, open).await;
}

async fn open_connection(stream: TcpStream, ticket: Ticket, service: Arc<Service>) {
    let Some(Admitted { socket, slot }) = service.guard.admit(stream).await else { return };
    // The slots count the viewer.
    ticket.leave();
    viewer::serve(socket, &service.run, service.end.reader()).await;
    drop(slot);
}
