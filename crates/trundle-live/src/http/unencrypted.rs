//! A request without encryption to an encrypted page: a browser shows the answer, which names the encrypted link.

use crate::PageCertificate;
use crate::origin::page_origin;
use tokio::io::{self, AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

/// First byte of each encrypted connection: a record of the handshake. Source: RFC 8446, 5.1.
const HANDSHAKE_RECORD: u8 = 0x16;
/// Maximum number of bytes of the request that are read after its answer \[bytes\]. A connection that closes before loses the answer.
/// Source: ours, as long as the longest head of a request.
const MAX_UNREAD_BYTES: u64 = 16 * 1024;

/// Whether the first byte of a connection begins no encryption. Waits for that byte.
pub async fn is_plain(stream: &TcpStream) -> bool {
    let mut first = [0];
    // A connection that is closed or broken shows its end to the encryption too.
    matches!(stream.peek(&mut first).await, Ok(1..)) && first[0] != HANDSHAKE_RECORD
}

/// Answers by the encrypted link, and closes the connection.
pub async fn refuse(mut stream: TcpStream, certificate: &PageCertificate) {
    if let Err(error) = answer(&mut stream, certificate).await {
        tracing::debug!("live page: a request without encryption ended before its answer: {error}");
    }
}

async fn answer(stream: &mut TcpStream, certificate: &PageCertificate) -> io::Result<()> {
    let origin = page_origin(stream.local_addr()?, Some(certificate));
    let text = format!(
        "This page is encrypted. Open the link that the program prints: it begins with {origin}/# (https, not http), and its token follows.\n"
    );
    let length = text.len();
    let head = format!(
        "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {length}\r\nX-Content-Type-Options: nosniff\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).await?;
    stream.write_all(text.as_bytes()).await?;
    stream.shutdown().await?;
    io::copy(&mut stream.take(MAX_UNREAD_BYTES), &mut io::sink()).await?;
    Ok(())
}
