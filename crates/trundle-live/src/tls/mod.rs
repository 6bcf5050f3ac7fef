//! Encryption of the live page by a given certificate, with the feature `tls`.
//!
//! rustls needs a provider of cryptography. ring is mature and needs a C compiler; the provider of RustCrypto is an alpha release; graviola
//! needs instructions that a Raspberry Pi 4 does not have. The default build has no C compiler, so TLS is a feature.

#[cfg(not(feature = "tls"))]
mod absent;
#[cfg(feature = "tls")]
mod certificate;
#[cfg(feature = "tls")]
mod identity;

#[cfg(not(feature = "tls"))]
pub use absent::TlsIdentity;
#[cfg(feature = "tls")]
pub use identity::TlsIdentity;
