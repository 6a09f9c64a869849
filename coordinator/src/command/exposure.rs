//! The exposure of a service: whether it may listen at an address, and whether it requires tokens.

use std::net::SocketAddr;

use anyhow::bail;

use crate::config::ExposureArguments;
use crate::http::{Exposure, TokenRule, tls_acceptor};
use store::{Reader, name_of};

/// Decides how a service is reached at an address. Refuses an address that other machines reach where no token is required.
pub(super) async fn exposure(
    listening: SocketAddr,
    config: &ExposureArguments,
    reader: &Reader,
    store: &str,
) -> anyhow::Result<Exposure> {
    let tls = match (&config.tls_certificate, &config.tls_key) {
        (Some(certificate), Some(key)) => Some(tls_acceptor(certificate, key)?),
        _ => None,
    };
    let tokens = reader.tokens().await?;
    let token_rule = if config.insecure {
        tracing::warn!(
            "--insecure: nobody is asked for a token; whoever reaches {listening} may read every measurement and result, \
             submit, pause and cancel calibrations, and answer as a worker"
        );
        TokenRule::Never
    } else if listening.ip().is_loopback() {
        TokenRule::OnceThereIsOne
    } else if tokens.iter().any(|token| !token.is_revoked) {
        TokenRule::Always
    } else {
        bail!(
            "--listen {listening} is reached by other machines, and {store} has no token: add one with \
             \"coordinator token add NAME --role submit --store {store}\", and one with --role work for the workers; \
             or start with --insecure to let everybody in",
            store = name_of(store)
        );
    };
    Ok(Exposure {
        listening,
        names: config.host.clone(),
        token_rule,
        tokens,
        tls,
    })
}
