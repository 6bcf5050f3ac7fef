//! Files of certificates and keys, and whether a certificate is valid.

use crate::LiveError;
use std::path::Path;
use tokio_rustls::rustls::pki_types::pem::{self, PemObject};
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer, UnixTime};
use webpki::{EndEntityCert, KeyUsage};

/// Seconds of a day.
const DAY_S: u64 = 86_400;

/// The certificates of a PEM file, that of the page first.
///
/// # Errors
/// When the file cannot be read or holds no certificate.
pub fn read_certificates(file: &Path) -> Result<Vec<CertificateDer<'static>>, LiveError> {
    let chain = CertificateDer::pem_file_iter(file).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let chain = chain.map_err(|error| broken(file, problem_of(&error, "CERTIFICATE")))?;
    if chain.is_empty() {
        return Err(broken(file, problem_of(&pem::Error::NoItemsFound, "CERTIFICATE")));
    }
    Ok(chain)
}

/// The private key of a PEM file.
///
/// # Errors
/// When the file cannot be read or holds no key.
pub fn read_key(file: &Path) -> Result<PrivateKeyDer<'static>, LiveError> {
    PrivateKeyDer::from_pem_file(file).map_err(|error| broken(file, problem_of(&error, "PRIVATE KEY")))
}

/// Checks that the first certificate of a chain may be used now. Whether a browser trusts it, the browser decides.
///
/// # Errors
/// When it is no certificate, has expired, or is not valid yet.
pub fn require_valid_now(file: &Path, chain: &[CertificateDer<'_>]) -> Result<(), LiveError> {
    let Some(first) = chain.first() else { return Ok(()) };
    let certificate = EndEntityCert::try_from(first)
        .map_err(|error| broken(file, format!("no certificate of X.509: {error}")))?;
    let now = UnixTime::now();
    // Without trust anchors every valid certificate ends with an unknown issuer; the times are checked before that.
    let checked = certificate.verify_for_usage(&[], &[], &[], now, KeyUsage::server_auth(), None, None);
    let days = |from: UnixTime, to: UnixTime| to.as_secs().saturating_sub(from.as_secs()) / DAY_S;
    match checked.err() {
        Some(webpki::Error::CertExpired { not_after, .. }) => {
            let ago = days(not_after, now);
            Err(broken(
                file,
                format!("the certificate expired {ago} days ago: renew it, or check this machine's clock"),
            ))
        }
        Some(webpki::Error::CertNotValidYet { not_before, .. }) => {
            let ahead = days(now, not_before);
            Err(broken(file, format!("the certificate is valid in {ahead} days: check this machine's clock")))
        }
        _ => Ok(()),
    }
}

fn problem_of(error: &pem::Error, kind: &str) -> String {
    match error {
        pem::Error::Io(error) => error.to_string(),
        pem::Error::NoItemsFound => format!("no PEM item; expected -----BEGIN {kind}-----"),
        error => format!("{error:?}; expected PEM with -----BEGIN {kind}-----"),
    }
}

fn broken(file: &Path, problem: String) -> LiveError {
    LiveError::Certificate { file: file.to_owned(), problem }
}
