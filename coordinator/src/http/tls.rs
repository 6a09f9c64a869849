//! The certificate of a service that speaks TLS itself.

use std::path::Path;
use std::sync::Arc;

use rustls::ServerConfig;
use rustls::crypto::ring;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio_rustls::TlsAcceptor;

/// The reason why a certificate or its key cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TlsError {
    /// The file cannot be read, or is not a PEM file of its kind.
    #[error("{file}: no {what} in PEM form: {source}")]
    File {
        file: String,
        what: &'static str,
        source: rustls::pki_types::pem::Error,
    },
    /// Certificate and key do not match, or cannot be used.
    #[error("certificate {certificate} with key {key}: {source}")]
    Pair {
        certificate: String,
        key: String,
        source: rustls::Error,
    },
}

/// Makes the acceptor of TLS connections from a certificate file, which also contains the certificates of its authorities, and a private
/// key.
///
/// # Errors
/// [`TlsError`] with the file.
pub fn tls_acceptor(certificate: &Path, key: &Path) -> Result<TlsAcceptor, TlsError> {
    let failed = |path: &Path, what| {
        let file = path.display().to_string();
        move |source| TlsError::File { file, what, source }
    };
    let chain = CertificateDer::pem_file_iter(certificate)
        .and_then(Iterator::collect::<Result<Vec<_>, _>>)
        .map_err(failed(certificate, "certificate"))?;
    let private = PrivateKeyDer::from_pem_file(key).map_err(failed(key, "private key"))?;
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .and_then(|builder| builder.with_no_client_auth().with_single_cert(chain, private));
    let mut config = config.map_err(|source| TlsError::Pair {
        certificate: certificate.display().to_string(),
        key: key.display().to_string(),
        source,
    })?;
    config.alpn_protocols = vec![b"http/1.1".to_vec()];
    Ok(TlsAcceptor::from(Arc::new(config)))
}
