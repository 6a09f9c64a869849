//! `coordinator serve`: runs the service.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::ops::RangeInclusive;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, bail};
use tokio::net::TcpListener;

use super::exposure::exposure;
use super::output::note;
use super::shutdown::{Shutdown, stop_signal};
use crate::config::ServeArguments;
use crate::embedded::{LocalModels, LocalWorkers};
use crate::service::{FarmSettings, Service, ServiceError};
use farm::Voting;
use farm::calibration::VerificationRule;
use store::{StoreError, name_of};

/// The allowed durations of a lease `[ms]`: from the delays of a network to a day.
const LEASE_MS: RangeInclusive<u64> = 100..=86_400_000;
/// Interval between two attempts of a standby to open the store.
const STANDBY: Duration = Duration::from_secs(1);

pub(super) async fn serve(config: ServeArguments) -> anyhow::Result<()> {
    let settings = farm_settings(&config)?;
    let models = LocalModels::new(&config.models.allow_model).map_err(anyhow::Error::msg)?;
    // One signal for the whole program: it also stops a standby that takes over.
    let mut signal = pin!(stop_signal()?);
    let (listener, service) = tokio::select! {
        opened = open(&config, settings) => opened?,
        _ = &mut signal => return Ok(()),
    };
    let store = &config.store.store;
    let service = service.with_webhook_hosts(config.webhook_host.clone());
    let address = listener.local_addr()?;
    let exposure = exposure(address, &config.exposure, &service.store().reader(), store).await?;
    let tls = exposure.tls.is_some();
    tracing::info!(%address, store = name_of(store), tls, read_only = config.read_only, "serving");
    note(&opening(
        address,
        tls,
        config.exposure.host.first().map(String::as_str),
    ));

    let stop = Shutdown::new();
    let workers = (config.local_workers > 0 && !config.read_only).then(|| {
        LocalWorkers::start(
            service.dispatcher().clone(),
            config.local_workers,
            &models,
            stop.wait(),
        )
    });
    let server = tokio::spawn(crate::http::serve(
        listener,
        service.clone(),
        exposure,
        stop.wait(),
    ));
    let overviews = service.clone();
    let overviews = tokio::spawn(async move { overviews.keep_overviews().await });
    let is_written = !config.read_only;
    tokio::select! {
        () = service.keep_growing(), if is_written => {}
        () = service.announce(), if is_written => {}
        () = service.keep_tidy(config.keep_days), if is_written => {}
        _ = &mut signal => tracing::info!("stopping; workers will reconnect"),
        () = service.store().writer().stopped(), if is_written => {
            bail!("the store can no longer be written; see the log")
        }
    }
    overviews.abort();
    stop.now();
    if let Some(workers) = workers {
        workers.join().await;
    }
    // Long polls end with the farm, so the server waits for no client.
    service.close().await;
    server.abort();
    Ok(())
}

/// Makes the settings of the farm from the arguments, within their bounds.
fn farm_settings(config: &ServeArguments) -> anyhow::Result<FarmSettings> {
    if !LEASE_MS.contains(&config.lease_ms) {
        let (least, most) = (LEASE_MS.start(), LEASE_MS.end());
        bail!(
            "--lease-ms {} ms must lie in [{least}, {most}] ms",
            config.lease_ms
        );
    }
    if !(0.0..=100.0).contains(&config.verify_percent) {
        bail!(
            "--verify-percent {} must lie in [0, 100] %",
            config.verify_percent
        );
    }
    if config.exposure.insecure && (config.one_vote_per_token || !config.trust.is_empty()) {
        bail!("--one-vote-per-token and --trust need tokens: they do not go with --insecure");
    }
    let voting = Voting {
        is_by_token: config.one_vote_per_token,
        trusted: config.trust.iter().cloned().collect(),
    };
    if config.verify_percent >= 50.0 {
        tracing::info!(
            verify_percent = config.verify_percent,
            "this share of the evaluations is computed twice, which takes as much more of the workers' time"
        );
    }
    Ok(FarmSettings {
        lease_ms: config.lease_ms,
        rule: VerificationRule {
            share: config.verify_percent / 100.0,
            voting: Arc::new(voting),
        },
    })
}

/// Binds the address, then opens the store, so that a port in use has no consequences. A standby binds its address only when it has the
/// store, because a load balancer must send requests to the active coordinator.
async fn open(config: &ServeArguments, settings: FarmSettings) -> anyhow::Result<(TcpListener, Service)> {
    let store = &config.store.store;
    let bind = async || {
        let bound = TcpListener::bind(config.listen).await;
        bound.with_context(|| format!("--listen {}", config.listen))
    };
    if config.read_only {
        let listener = bind().await?;
        let service = Service::open_read_only(store).await?;
        service.store().warn_of_damage().await?;
        return Ok((listener, service));
    }
    if config.standby {
        let service = standby(store, settings).await?;
        return Ok((bind().await?, service));
    }
    Ok((bind().await?, Service::open(store, settings).await?))
}

/// Returns the URL of the page for a browser: on this machine if the service listens to all addresses, and with TLS by the name of the
/// certificate.
fn opening(listening: SocketAddr, tls: bool, name: Option<&str>) -> String {
    let scheme = if tls { "https" } else { "http" };
    let port = listening.port();
    let here = match listening.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => IpAddr::V4(Ipv4Addr::LOCALHOST),
        IpAddr::V6(ip) if ip.is_unspecified() => IpAddr::V6(Ipv6Addr::LOCALHOST),
        ip => ip,
    };
    let here = SocketAddr::new(here, port);
    match name.filter(|_| tls) {
        None => format!("open {scheme}://{here}"),
        Some(name) => format!("open {scheme}://{name}:{port}"),
    }
}

/// Opens a store as soon as no other coordinator holds it.
async fn standby(store: &str, settings: FarmSettings) -> anyhow::Result<Service> {
    tracing::info!(store = name_of(store), "standing by");
    let mut has_reached_it = false;
    loop {
        match Service::open(store, settings.clone()).await {
            Ok(service) => return Ok(service),
            Err(ServiceError::Store(StoreError::InUse(_))) => has_reached_it = true,
            // A database server may be down for a while during a restart. If it was never there, this is an error.
            Err(ServiceError::Store(error @ StoreError::Database { .. })) if has_reached_it => {
                tracing::warn!(%error, "standing by");
            }
            Err(error) => return Err(error.into()),
        }
        tokio::time::sleep(STANDBY).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_opened_at_an_address_that_a_browser_reaches() {
        for (listening, tls, name, address) in [
            ("127.0.0.1:7070", false, None, "http://127.0.0.1:7070"),
            ("0.0.0.0:8080", false, None, "http://127.0.0.1:8080"),
            ("[::]:7070", true, None, "https://[::1]:7070"),
            ("192.0.2.7:80", false, None, "http://192.0.2.7:80"),
            (
                "127.0.0.1:7070",
                false,
                Some("proxy.example"),
                "http://127.0.0.1:7070",
            ),
            (
                "0.0.0.0:7070",
                true,
                Some("farm.example"),
                "https://farm.example:7070",
            ),
        ] {
            let listening = listening.parse().expect("an address");
            assert_eq!(opening(listening, tls, name), format!("open {address}"));
        }
    }
}
