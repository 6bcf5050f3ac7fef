//! Scheme, name and port of the links to the page.

use crate::PageCertificate;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};

/// The origin of a page at `address`: that address, or a name of the certificate if the certificate does not hold for the address.
pub fn page_origin(mut address: SocketAddr, certificate: Option<&PageCertificate>) -> String {
    if address.ip().is_unspecified() {
        address.set_ip(own_address().unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)));
    }
    address.set_ip(address.ip().to_canonical());
    let Some(certificate) = certificate else { return format!("http://{address}") };
    let is_known = certificate.covers(&address.ip().to_string());
    match certificate.first_name().filter(|_| !is_known) {
        Some(name) => format!("https://{name}:{}", address.port()),
        None => format!("https://{address}"),
    }
}

/// The address by which other machines reach this one. The socket sends no data: it only queries the system's route.
fn own_address() -> Option<IpAddr> {
    /// An address of documentation. Source: RFC 5737.
    const FAR_AWAY: (Ipv4Addr, u16) = (Ipv4Addr::new(192, 0, 2, 1), 9);
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect(FAR_AWAY).ok()?;
    Some(socket.local_addr().ok()?.ip())
}
